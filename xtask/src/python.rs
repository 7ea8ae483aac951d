//! Installs the plugin hosts that are driven from Python, in a virtual environment under the target directory.

use crate::shell::{root, succeeds};
use std::path::Path;
use std::process::Command;

/// The file with the pinned versions.
const REQUIREMENTS: &str = "plugin/tests/hosts/requirements.txt";

/// Creates `target/python` with the packages in [`REQUIREMENTS`], unless it already contains exactly these.
pub(crate) fn install() -> Result<(), String> {
    let wanted = root().join(REQUIREMENTS);
    let folder = root().join("target/python");
    let installed = folder.join("requirements.txt");
    let text = std::fs::read_to_string(&wanted).map_err(|error| format!("{}: {error}", wanted.display()))?;
    if std::fs::read_to_string(&installed).is_ok_and(|found| found == text) {
        return Ok(());
    }
    println!("installing into {}: {}", folder.display(), text.lines().collect::<Vec<_>>().join(", "));
    if !succeeds("python3", &["-m", "venv", "--clear", &folder.to_string_lossy()]) {
        return Err("there is no Python that makes virtual environments (python3-venv)".to_owned());
    }
    pip(&folder, &wanted)?;
    std::fs::write(&installed, text).map_err(|error| format!("{}: {error}", installed.display()))
}

fn pip(folder: &Path, requirements: &Path) -> Result<(), String> {
    let status = Command::new(folder.join("bin/python"))
        .args([
            "-m",
            "pip",
            "install",
            "--quiet",
            "--disable-pip-version-check",
            "--only-binary=:all:",
            "--requirement",
        ])
        .arg(requirements)
        .status();
    match status {
        Ok(status) if status.success() => Ok(()),
        _ => Err(format!("pip could not install {REQUIREMENTS}")),
    }
}
