//! Installs the plugin hosts driven from Python, and the modules for the Python package's tests, in a virtual environment.

use crate::shell::{root, succeeds};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The system's Python.
pub(crate) const PROGRAM: &str = if cfg!(windows) { "python" } else { "python3" };

/// A program of a virtual environment.
pub(crate) fn of(environment: &Path, program: &str) -> PathBuf {
    match cfg!(windows) {
        true => environment.join("Scripts").join(format!("{program}.exe")),
        false => environment.join("bin").join(program),
    }
}

/// The files with the pinned versions.
const REQUIREMENTS: [&str; 2] = ["plugin/tests/hosts/requirements.txt", "src/python/tests/requirements.txt"];

/// Creates `target/python` with the packages of [`REQUIREMENTS`], unless it already contains exactly these.
pub(crate) fn install() -> Result<(), String> {
    let folder = root().join("target/python");
    let installed = folder.join("requirements.txt");
    let mut text = String::new();
    for file in REQUIREMENTS.map(|file| root().join(file)) {
        text += &std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
    }
    if std::fs::read_to_string(&installed).is_ok_and(|found| found == text) {
        return Ok(());
    }
    println!("installing into {}: {}", folder.display(), text.lines().collect::<Vec<_>>().join(", "));
    if !succeeds(PROGRAM, &["-m", "venv", "--clear", &folder.to_string_lossy()]) {
        return Err("there is no Python that makes virtual environments (python3-venv)".to_owned());
    }
    pip(&folder)?;
    std::fs::write(&installed, text).map_err(|error| format!("{}: {error}", installed.display()))
}

fn pip(folder: &Path) -> Result<(), String> {
    let status = Command::new(of(folder, "python"))
        .args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary=:all:"])
        .args(REQUIREMENTS.iter().flat_map(|file| ["--requirement".into(), root().join(file)]))
        .status();
    match status {
        Ok(status) if status.success() => Ok(()),
        _ => Err(format!("pip could not install {}", REQUIREMENTS.join(" and "))),
    }
}
