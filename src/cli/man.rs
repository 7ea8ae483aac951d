//! `sprung man`: the manual pages.

use super::terminal::print;
use clap_mangen::Man;
use sprung::internals::files::{Inputs, Output, Target};
use sprung::{Error, Result};
use std::io::Write;
use std::path::{Path, PathBuf};

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung man | man -l -
  sprung man ~/.local/share/man/man1";

#[derive(clap::Args)]
pub(super) struct Args {
    /// Write a page for the command and each subcommand into this directory, made if missing, instead of stdout
    directory: Option<PathBuf>,
    /// Overwrite existing pages
    #[arg(long, requires = "directory")]
    force: bool,
}

/// Prints or writes the pages of `command`, which is the whole of `sprung`.
pub(super) fn run(args: &Args, command: clap::Command) -> Result<()> {
    match &args.directory {
        Some(directory) => write_pages(command, directory, args.force),
        None => print(&String::from_utf8_lossy(&rendered(&Man::new(command))?)),
    }
}

/// Writes all pages to temporary files before the first is renamed: if one cannot be written, the old pages stay.
fn write_pages(command: clap::Command, directory: &Path, force: bool) -> Result<()> {
    std::fs::create_dir_all(directory).map_err(|error| Error::io(directory.display().to_string(), error))?;
    let mut command = command.disable_help_subcommand(true);
    command.build();
    let mut written = Vec::new();
    for page in pages(&command) {
        // Manual pages have no input files.
        let target = Target::Path(directory.join(page.get_filename()));
        let mut output = Output::create(&target, force, &Inputs::default())?;
        output.stream().write_all(&rendered(&page)?).map_err(|error| Error::io(output.name(), error))?;
        written.push(output);
    }
    written.into_iter().try_for_each(Output::commit)
}

/// A page for a command and for each subcommand below it.
fn pages(command: &clap::Command) -> Vec<Man> {
    let below = command.get_subcommands().filter(|command| !command.is_hide_set()).flat_map(pages);
    std::iter::once(Man::new(command.clone())).chain(below).collect()
}

fn rendered(page: &Man) -> Result<Vec<u8>> {
    let mut text = Vec::new();
    page.render(&mut text).map_err(|error| Error::io("the manual page", error))?;
    Ok(text)
}
