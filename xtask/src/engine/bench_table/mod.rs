//! `cargo xtask bench-table`: runs the benches and the peers, and writes the results into `benches/README.md`.

mod measured;
mod peers;
mod songs;
mod tables;

use crate::shell::{cargo, root};
use measured::Measured;
use peers::Peer;
use std::fs;
use std::path::Path;
use std::process::Command;

const DOCUMENT: &str = "benches/README.md";
const BEGIN: &str = "<!-- measured: begin -->";
const END: &str = "<!-- measured: end -->";

/// Compiler flags for the peers that are compiled here: the level AVX2.
const FLAGS: &str = "-C target-cpu=x86-64-v3";

/// Runs everything and writes the tables. With `again`, runs nothing and uses the results of the last run.
pub(crate) fn run(again: bool) -> Result<(), String> {
    let criterion = root().join("target/criterion-table");
    let [peers_table, songs_table] = ["target/peers/peers.tsv", "target/peers/songs.tsv"].map(|path| root().join(path));
    if !again {
        // Old results may be of benches that no longer exist.
        let _ = fs::remove_dir_all(&criterion);
        let folder = peers_table.parent().expect("the path has a folder");
        fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let bench = |arguments: &str| {
            let mut command = cargo(arguments);
            command.env("CRITERION_HOME", &criterion);
            command
        };
        succeed(bench("bench --package sprung --bench probe --bench mode_bank --bench synth --bench render"))?;
        let mut beside = bench("bench --package sprung --bench peers --target-dir target/x86-64-v3");
        if cfg!(target_arch = "x86_64") {
            beside.env("RUSTFLAGS", FLAGS);
        }
        succeed(beside)?;
        run_script("benches/peers/run.sh", &peers_table)?;
        succeed(cargo("build --release --package sprung-cli"))?;
        run_script("benches/songs.sh", &songs_table)?;
    }
    let measured = Measured::read(&criterion)?;
    let read = |path: &Path| fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()));
    let (peers, songs) = (Peer::parse(&read(&peers_table)?)?, songs::parse(&read(&songs_table)?)?);
    let tables = tables::all(&measured, &peers, &songs, &cpu());

    let path = root().join(DOCUMENT);
    let document = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let document = replace(&document, &tables).ok_or_else(|| format!("{DOCUMENT} has no {BEGIN} before {END}"))?;
    fs::write(&path, document).map_err(|error| format!("{}: {error}", path.display()))?;
    println!("{tables}\nwritten to {DOCUMENT}");
    Ok(())
}

/// Runs a script, and writes what it prints to a file.
fn run_script(script: &str, to: &Path) -> Result<(), String> {
    let script = root().join(script);
    let output = Command::new(&script).stderr(std::process::Stdio::inherit()).output();
    let output = output.map_err(|error| format!("{}: {error}", script.display()))?;
    if !output.status.success() {
        return Err(format!("{} failed", script.display()));
    }
    fs::write(to, output.stdout).map_err(|error| format!("{}: {error}", to.display()))
}

fn succeed(mut command: Command) -> Result<(), String> {
    let status = command.status().map_err(|error| format!("cargo: {error}"))?;
    if status.success() { Ok(()) } else { Err("the benches failed".to_owned()) }
}

/// The document with new text between the marks; `None` if the marks are missing.
fn replace(document: &str, tables: &str) -> Option<String> {
    let (before, rest) = document.split_once(BEGIN)?;
    let (_, after) = rest.split_once(END)?;
    Some(format!("{before}{BEGIN}\n{tables}{END}{after}"))
}

/// The CPU's name, if the system provides it.
fn cpu() -> String {
    let told = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = told.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    name.map_or_else(|| format!("a CPU of kind {}", std::env::consts::ARCH), |(_, name)| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_between_the_marks_is_replaced() {
        let document = format!("before\n{BEGIN}\nold\n{END}\nafter");
        assert_eq!(replace(&document, "new\n").unwrap(), format!("before\n{BEGIN}\nnew\n{END}\nafter"));
        assert_eq!(replace("no marks", "new"), None);
    }

    #[test]
    fn the_document_has_the_marks() {
        assert!(replace(&fs::read_to_string(root().join(DOCUMENT)).unwrap(), "").is_some());
    }
}
