//! Reads sound files by path.

use crate::error::{Error, Result};
use crate::io::Inputs;
use crate::io::sound_file::{self, Recording};
use std::io::{Seek, SeekFrom};
use std::path::Path;

/// Reads a sound file, or standard input for `-`. Also returns its name for error messages. `warn` is called for each
/// problem in the file.
///
/// # Errors
/// As [`sound_file::read`], and [`Error::Io`].
pub fn recording(path: &Path, inputs: &mut Inputs, warn: &mut dyn FnMut(&str)) -> Result<(Recording, String)> {
    let (file, name) = if path == Path::new("-") {
        let failed = |source| Error::io("stdin", source);
        // Reading a sound file needs seeking, which stdin does not support.
        let mut file = tempfile::tempfile().map_err(failed)?;
        std::io::copy(&mut inputs.stdin()?.lock(), &mut file).map_err(failed)?;
        file.seek(SeekFrom::Start(0)).map_err(failed)?;
        (file, "stdin".to_owned())
    } else {
        (inputs.open(path)?, path.display().to_string())
    };
    let recording = sound_file::read(file, &name)?;
    recording.warnings.iter().for_each(|warning| warn(&format!("{name}: {warning}")));
    Ok((recording, name))
}
