//! `cargo xtask batch-table`: sounds per second of `sprung batch`, beside plugin hosts that render the same notes.

use crate::shell::{cargo, root, run_to_end};
use crate::system::{Profile, System};
use crate::{bundle, python};
use std::process::Command;

/// Builds command and plugin for release, and prints the table that `benches/batch.py` makes with them.
pub(crate) fn run(sounds: u32) -> Result<(), String> {
    python::install()?;
    run_to_end(&mut cargo("build --release --package sprung-cli"), "cargo build")?;
    let plugin = bundle::run(&System::own(), Profile::Release)?.join(bundle::Format::Vst3.file_name());
    let target = root().join("target");
    let mut table = Command::new(target.join("python/bin/python"));
    table.arg(root().join("benches/batch.py")).arg(target.join("release/sprung")).arg(plugin);
    run_to_end(table.args(["--sounds", &sounds.to_string()]), "benches/batch.py")
}
