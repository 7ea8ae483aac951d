//! Loads presets and kits by the names that people give.

use crate::error::Result;
use crate::io::Inputs;
use crate::preset::{Playable, is_file_name};
use std::ffi::OsStr;
use std::path::Path;

/// Loads the preset or kit with this name: a file if it looks like a file name, else a factory preset. `warn` is called
/// with each retired parameter that was replaced.
///
/// # Errors
/// As [`Playable::read`], and [`Error::Value`](crate::Error::Value) for a name that no factory preset has.
pub fn playable(name: &OsStr, inputs: &mut Inputs, warn: &mut dyn FnMut(&str)) -> Result<Playable> {
    let path = Path::new(name);
    if is_file_name(path) {
        let mut replaced = |origin: &str, replaced| warn(&format!("{origin}: {replaced}"));
        Playable::read(path, &mut |path| inputs.open(path), &mut replaced)
    } else {
        Playable::find(&name.to_string_lossy())
    }
}
