//! `sprung completions` and `sprung man`: what a package installs beside the command.

use clap::CommandFactory;
use clap_complete::Shell;
use sprung::{Error, Result};
use std::path::PathBuf;

pub(super) const COMPLETION_EXAMPLES: &str = "\
Examples:
  sprung completions bash > ~/.local/share/bash-completion/completions/sprung
  sprung completions fish > ~/.config/fish/completions/sprung.fish";

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung man | man -l -
  sprung man ~/.local/share/man/man1";

#[derive(clap::Args)]
pub(super) struct CompletionArgs {
    /// The shell to complete for
    shell: Shell,
}

#[derive(clap::Args)]
pub(super) struct Args {
    /// Write a page for the command and each subcommand into this directory, made if missing, instead of stdout
    directory: Option<PathBuf>,
}

pub(super) fn completions(args: &CompletionArgs) -> Result<()> {
    // clap_complete panics when its writer fails; a buffer does not.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut super::Cli::command(), "sprung", &mut script);
    super::print(&String::from_utf8_lossy(&script))
}

pub(super) fn run(args: &Args) -> Result<()> {
    let command = super::Cli::command();
    match &args.directory {
        Some(directory) => std::fs::create_dir_all(directory)
            .and_then(|()| clap_mangen::generate_to(command, directory))
            .map_err(|error| Error::io(directory.display().to_string(), error)),
        None => {
            let mut page = Vec::new();
            clap_mangen::Man::new(command).render(&mut page).map_err(|error| Error::io("stdout", error))?;
            super::print(&String::from_utf8_lossy(&page))
        }
    }
}
