//! Reading of recordings, and writing of figures.

use super::interrupt;
use super::terminal::warn;
use sprung::internals::files::{Inputs, Output, Target};
use sprung::io::sound_file::Recording;
use sprung::{Error, Result};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Reads a sound file, or standard input for `-`, and prints warnings about it. Also returns its name for error
/// messages.
pub(super) fn read(path: &Path, inputs: &mut Inputs) -> Result<(Recording, String)> {
    sprung::internals::request::recording(path, inputs, &mut warn)
}

/// The extension of a path in lower case, if it is one of `possible`; `option` names the option in the error.
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
    /// Writes the picture that `draw` makes in the requested format.
    pub(super) fn write(mut self, draw: impl FnOnce(&str) -> Result<Vec<u8>>) -> Result<()> {
        let bytes = draw(&self.format)?;
        self.output.stream().write_all(&bytes).map_err(|source| Error::io(self.output.name(), source))?;
        self.output.commit()
    }
}
