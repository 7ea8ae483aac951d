//! `cargo xtask standalone`: builds the plugin's window as a program, and runs it.

use crate::patch;
use crate::shell::{cargo, run_to_end};

/// Runs the program with arguments of its own, until its window is closed.
pub(crate) fn run(arguments: &[String]) -> Result<(), String> {
    patch::run()?;
    let mut command = cargo("run --release --manifest-path plugin/Cargo.toml --features standalone --");
    run_to_end(command.args(arguments), "sprung-standalone")
}
