//! Runs other programs.

use std::io::{BufRead as _, BufReader, Write as _, pipe};
use std::path::Path;
use std::process::{Command, Stdio};

/// The repository's root.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("xtask lies in the repository")
}

/// A command of the cargo that runs this program, in the repository's root; the arguments are split at spaces.
pub(crate) fn cargo(arguments: &str) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments.split_whitespace()).current_dir(root());
    // Environment variables that cargo has set for this program must not affect the builds that it starts.
    for (name, _) in std::env::vars_os() {
        let inherited =
            name.to_str().is_some_and(|name| name.starts_with("CARGO_PKG_") || name == "CARGO_MANIFEST_DIR");
        if inherited {
            command.env_remove(name);
        }
    }
    command
}

/// Whether a program runs and succeeds. Its output is not shown.
pub(crate) fn succeeds(program: &str, arguments: &[&str]) -> bool {
    let status = Command::new(program).args(arguments).stdout(Stdio::null()).stderr(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}

/// Runs a command and shows its output as it appears. Returns whether it succeeded, and the lines of stdout and stderr.
pub(crate) fn run_and_read(mut command: Command) -> Result<(bool, Vec<String>), String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let failed = |error: std::io::Error| format!("{program}: {error}");
    let (reader, writer) = pipe().map_err(failed)?;
    let mut child = command.stdout(writer.try_clone().map_err(failed)?).stderr(writer).spawn().map_err(failed)?;
    // It holds the pipe's other end, which must close for the lines to end.
    drop(command);
    let mut lines = Vec::new();
    for line in BufReader::new(reader).split(b'\n') {
        let line = String::from_utf8_lossy(&line.map_err(failed)?).into_owned();
        // If the reader of stdout has gone, the suite continues.
        let _ = writeln!(std::io::stdout(), "{line}");
        lines.push(line);
    }
    Ok((child.wait().map_err(failed)?.success(), lines))
}

/// Runs a command; `what` names it if it fails.
pub(crate) fn run_to_end(command: &mut Command, what: &str) -> Result<(), String> {
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{what}: {status}")),
        Err(error) => Err(format!("{what}: {error}")),
    }
}

/// Whether a compiler has the standard library of a target.
pub(crate) fn has_standard_library(triple: &str, rustc: Option<&Path>) -> bool {
    let output = Command::new(rustc.unwrap_or(Path::new("rustc")))
        .args(["--print", "target-libdir", "--target", triple])
        .output();
    let Some(output) = output.ok().filter(|output| output.status.success()) else { return false };
    let Ok(folder) = std::fs::read_dir(String::from_utf8_lossy(&output.stdout).trim()) else { return false };
    folder.flatten().any(|file| file.file_name().to_string_lossy().starts_with("libstd-"))
}
