//! Recordings that commands are given, and figures that they write.

use super::interrupt;
use super::terminal::complain;
use sprung::io::sound_file::{self, Recording};
use sprung::io::{Inputs, Output, Target};
use sprung::{Error, Result};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Reads a sound file, or standard input for `-`, and warns of what is wrong with it. Gives what errors call it, too.
pub(super) fn read(path: &Path, inputs: &mut Inputs) -> Result<(Recording, String)> {
    let (file, name) = if path == Path::new("-") {
        let failed = |source| Error::io("stdin", source);
        // A sound file is not read from front to back.
        let mut file = tempfile::tempfile().map_err(failed)?;
        std::io::copy(&mut inputs.stdin()?.lock(), &mut file).map_err(failed)?;
        file.seek(SeekFrom::Start(0)).map_err(failed)?;
        (file, "stdin".to_owned())
    } else {
        (inputs.open(path)?, path.display().to_string())
    };
    let recording = sound_file::read(file, &name)?;
    recording.warnings.iter().for_each(|warning| complain("warning", format_args!("{name}: {warning}")));
    Ok((recording, name))
}

/// The ending of a path in lower case, if it is one of those that are possible; `option` names it in the error.
pub(super) fn ending(option: &str, path: &Path, possible: &[&str]) -> Result<String> {
    let ending = path.extension().and_then(|extension| extension.to_str()).unwrap_or("").to_ascii_lowercase();
    if possible.contains(&ending.as_str()) {
        return Ok(ending);
    }
    let expected: Vec<String> = possible.iter().map(|ending| format!(".{ending}")).collect();
    let message = format!("{}: expected a name that ends in {}", path.display(), expected.join(" or "));
    Err(Error::value(option, message))
}

/// Where a figure is to go.
#[derive(clap::Args)]
pub(super) struct FigureArgs {
    /// Draw a figure, as PNG or SVG
    #[arg(long, value_name = "FILE.png|FILE.svg")]
    figure: Option<PathBuf>,
    /// Overwrite an existing figure
    #[arg(long)]
    force: bool,
}

/// A figure's file, open before the work begins.
pub(super) struct FigureFile {
    output: Output,
    format: String,
}

impl FigureArgs {
    /// Opens the figure's file, if one is wanted.
    pub(super) fn open(&self, inputs: &Inputs) -> Result<Option<FigureFile>> {
        open_figure(self.figure.as_deref(), self.force, inputs)
    }
}

/// Opens a figure's file, if one is wanted.
pub(super) fn open_figure(path: Option<&Path>, force: bool, inputs: &Inputs) -> Result<Option<FigureFile>> {
    let Some(path) = path else { return Ok(None) };
    let format = ending("--figure", path, &["png", "svg"])?;
    let output = Output::create(&Target::Path(path.to_owned()), force, inputs)?;
    interrupt::remove(&output);
    Ok(Some(FigureFile { output, format }))
}

impl FigureFile {
    /// Writes what `draw` makes in the format that it is given.
    pub(super) fn write(mut self, draw: impl FnOnce(&str) -> Result<Vec<u8>>) -> Result<()> {
        let bytes = draw(&self.format)?;
        self.output.stream().write_all(&bytes).map_err(|source| Error::io(self.output.name(), source))?;
        self.output.commit()
    }
}
