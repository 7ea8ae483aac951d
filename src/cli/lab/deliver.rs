//! Writes the outputs of the lab's commands: a figure, a table of numbers as CSV, and a table as text.

use super::super::interrupt;
use super::super::terminal::{complain_lines, is_closed, print};
use sprung::figure::{self, Picture};
use sprung::internals::files::{Inputs, Output, Target};
use sprung::{Error, Result};
use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::{Path, PathBuf};

/// The options of every command's output.
#[derive(clap::Args)]
pub(super) struct Files {
    /// Write the numbers as CSV; - is stdout
    #[arg(long, value_name = "FILE.csv|-")]
    csv: Option<PathBuf>,
    /// Write the figure, in the format that the name ends in
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Overwrite existing files
    #[arg(long)]
    force: bool,
}

/// Outputs that are open but not written yet, so that problems are found before the work begins.
pub(super) struct Deliveries {
    csv: Option<Output>,
    figure: Option<(Output, String)>,
    /// Outputs that are written. They are renamed when all are complete.
    written: Vec<Output>,
    to_stdout: bool,
    force: bool,
}

impl Files {
    /// Opens the outputs. Returns an error if the figure's name does not end in one of `formats`, or if an output
    /// cannot be written.
    pub(super) fn open(&self, formats: &[&str]) -> Result<Deliveries> {
        if self.csv.is_some() && self.csv == self.output {
            return Err(Error::value("--csv", "is the same file as --output: expected two"));
        }
        let to_stdout = self.csv.as_deref() == Some(Path::new("-"));
        if to_stdout && std::io::stdout().is_terminal() {
            return Err(Error::value("--csv", "stdout is a terminal: expected a file, or stdout sent to one"));
        }
        let format = self.output.as_deref().map(|path| format_of(path, formats)).transpose()?;
        interrupt::end_at_once()?;
        let open = |path: &PathBuf| create(&Target::new(path), self.force);
        let csv = self.csv.as_ref().map(open).transpose()?;
        let figure = self.output.as_ref().map(open).transpose()?.zip(format);
        Ok(Deliveries { csv, figure, written: Vec::new(), to_stdout, force: self.force })
    }
}

fn create(target: &Target, force: bool) -> Result<Output> {
    // The lab has no input files.
    let output = Output::create(target, force, &Inputs::default())?;
    interrupt::remove(&output);
    Ok(output)
}

/// The extension of a file's name, if it is one of `formats`.
fn format_of(path: &Path, formats: &[&str]) -> Result<String> {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("").to_ascii_lowercase();
    if formats.contains(&extension.as_str()) {
        return Ok(extension);
    }
    let names: Vec<String> = formats.iter().map(|format| format!(".{format}")).collect();
    Err(Error::value("--output", format!("{}: expected a name that ends in {}", path.display(), names.join(" or "))))
}

impl Deliveries {
    /// Format of the requested figure.
    pub(super) fn format(&self) -> Option<&str> {
        self.figure.as_ref().map(|(_, format)| format.as_str())
    }

    /// Whether CSV was requested.
    pub(super) fn wants_csv(&self) -> bool {
        self.csv.is_some()
    }

    /// Opens and writes an additional file. It is renamed with the others in [`Deliveries::finish`].
    pub(super) fn add(&mut self, path: PathBuf, write: impl FnOnce(&mut Output) -> Result<()>) -> Result<()> {
        let mut output = create(&Target::Path(path), self.force)?;
        write(&mut output)?;
        self.written.push(output);
        Ok(())
    }

    /// Writes the figure and the CSV if they were requested, and prints `text`: to stdout, or to stderr if the CSV goes
    /// to stdout.
    pub(super) fn finish(
        self,
        figure: impl FnOnce(&str) -> Result<Vec<u8>>,
        csv: impl FnOnce(&mut dyn Write) -> io::Result<()>,
        text: &str,
    ) -> Result<()> {
        let mut whole = self.written;
        if let Some((mut output, format)) = self.figure {
            let bytes = figure(&format)?;
            write(&mut output, |out| out.write_all(&bytes))?;
            whole.push(output);
        }
        if let Some(mut output) = self.csv {
            match write(&mut output, csv) {
                // A reader such as `head` may close the pipe when it has enough. That is no error.
                Err(Error::Io { source, .. }) if self.to_stdout && is_closed(&source) => (),
                written => written?,
            }
            whole.push(output);
        }
        for output in whole {
            output.commit()?;
        }
        if self.to_stdout {
            complain_lines(text);
            return Ok(());
        }
        print(text)
    }
}

fn write(output: &mut Output, contents: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    let mut stream = BufWriter::new(output.stream());
    let written = contents(&mut stream).and_then(|()| stream.flush());
    drop(stream);
    written.map_err(|error| Error::io(output.name(), error))
}

/// Draws a picture in the format with this name.
pub(super) fn drawn(picture: &impl Picture, format: &str) -> Result<Vec<u8>> {
    if format == "png" { figure::png(picture) } else { figure::svg(picture).map(String::into_bytes) }
}
