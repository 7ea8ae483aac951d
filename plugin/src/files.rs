//! Files that users name: only whole paths to regular files are opened.

use sprung::preset::Playable;
use std::fs::File;
use std::path::Path;

/// Reads the preset or kit file at a path.
///
/// # Errors
/// If it is no whole path to a file with the extension `toml`, or as [`Playable::read`].
pub(crate) fn read(path: impl AsRef<Path>) -> sprung::Result<Playable> {
    let mut open = |path: &Path| open(path, &path.display().to_string(), "a preset, kit, scale or mapping");
    check(path.as_ref())?;
    Playable::read(path.as_ref(), &mut open)
}

/// Opens a file, and nothing else: opening a pipe would block the window.
pub(crate) fn open(path: &Path, name: &str, expected: &str) -> sprung::Result<File> {
    let failed = |source| sprung::Error::io(name, source);
    if !std::fs::metadata(path).map_err(failed)?.is_file() {
        return Err(sprung::Error::format(name, format!("this is not a file: expected {expected}")));
    }
    File::open(path).map_err(failed)
}

/// The system's number of an error; 0 if the system is not to blame.
pub(crate) fn number(error: &sprung::Error) -> i32 {
    match error {
        sprung::Error::Io { source, .. } => source.raw_os_error().unwrap_or(0),
        _ => 0,
    }
}

/// Only full paths are accepted, since users do not know a host's working folder.
fn check(path: &Path) -> sprung::Result<()> {
    if path.is_absolute() && path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        return Ok(());
    }
    let example = if cfg!(windows) { "C:\\Sounds\\bell.toml" } else { "/home/me/bell.toml" };
    Err(sprung::Error::value(path.display().to_string(), format!("expected a whole path, such as {example}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_whole() {
        for path in ["", "bell.toml", "/tmp/bell", "-"] {
            let error = read(path).unwrap_err();
            assert!(error.to_string().contains("expected a whole path, such as "), "{error}");
            assert_eq!(number(&error), 0);
        }
    }

    #[test]
    fn kits_are_read_and_what_is_missing_has_the_system_s_number() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/kits/acoustic-kit.toml");
        let path = std::fs::canonicalize(path).unwrap().display().to_string();
        assert!(matches!(read(&path), Ok(Playable::Kit(_))));
        // ENOENT and ERROR_FILE_NOT_FOUND are both 2.
        assert_eq!(number(&read(path.replace(".toml", "-2.toml")).unwrap_err()), 2);
    }
}
