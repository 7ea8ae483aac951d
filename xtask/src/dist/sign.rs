//! Signs what users download, with commands that the environment names.

use crate::shell::run_to_end;
use std::path::Path;
use std::process::Command;

/// Environment variable: the command that signs programs, libraries and bundles, such as `codesign --options runtime --timestamp
/// --sign ID` or `signtool sign /fd SHA256 …`. It is split at spaces, and paths are appended.
pub(super) const CODE: &str = "SPRUNG_SIGN";

/// Likewise for macOS: `xcrun notarytool submit --wait --keychain-profile NAME`.
pub(super) const NOTARISE: &str = "SPRUNG_NOTARISE";

/// Runs the command of an environment variable with paths. Returns whether there is one; if not, it says what is not done.
pub(super) fn run(variable: &str, paths: &[&Path]) -> Result<bool, String> {
    let command = std::env::var(variable).unwrap_or_default();
    let mut words = command.split_whitespace();
    let Some(program) = words.next() else {
        let names: Vec<_> = paths.iter().map(|path| path.file_name().unwrap_or_default().to_string_lossy()).collect();
        println!("without {variable}, not signed or notarised: {}", names.join(", "));
        return Ok(false);
    };
    run_to_end(Command::new(program).args(words).args(paths), variable).map(|()| true)
}
