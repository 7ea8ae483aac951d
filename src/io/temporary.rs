//! Temporary files of outputs. They are locked while in use, so that files of dead processes can be recognised.
//!
//! An output is locked until it has its final name. A file that a killed process has left is not locked, and the next
//! output in the same folder removes it.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::Path;
use tempfile::TempPath;

const PREFIX: &str = ".sprung-";
const SUFFIX: &str = ".part";

/// Creates a locked file in `folder`, with the permissions that any new file would get. Removes temporary files in the
/// folder that no running process has locked.
pub(super) fn create_in(folder: &Path) -> io::Result<(File, TempPath)> {
    remove_stale(folder);
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    loop {
        let (file, path) = builder.tempfile_in(folder)?.into_parts();
        // If the file system has no locks, other processes cannot lock the file either, so they will not remove it.
        let _ = file.lock();
        // Another process may have found and removed the file before it was locked.
        if fs::exists(&path)? {
            return Ok((file, path));
        }
    }
}

/// Removes the files of processes that were killed. Ignores errors.
fn remove_stale(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let is_temporary = name.to_str().is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX));
        if !is_temporary || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        let file = OpenOptions::new().read(true).write(true).open(entry.path());
        // The lock is held during the removal: a process that has just created the file waits, and then finds it
        // removed.
        if let Ok(file) = file
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_nobody_holds_are_removed() {
        let directory = tempfile::tempdir().unwrap();
        let path = |name: &str| directory.path().join(name);
        for name in [".sprung-stale.part", ".sprung-kept", "kept.part", ".other-kept.part"] {
            fs::write(path(name), "").unwrap();
        }
        fs::create_dir(path(".sprung-folder.part")).unwrap();
        let (first, first_path) = create_in(directory.path()).unwrap();
        let (_second, second_path) = create_in(directory.path()).unwrap();
        assert!(first_path.exists() && second_path.exists(), "one that is being written stays");
        assert!(!path(".sprung-stale.part").exists());
        assert!(
            [".sprung-kept", "kept.part", ".other-kept.part", ".sprung-folder.part"]
                .iter()
                .all(|name| path(name).exists())
        );
        drop(first);
        create_in(directory.path()).unwrap();
        assert!(!first_path.exists() && second_path.exists());
    }

    #[test]
    fn a_file_is_never_taken_from_a_process_that_has_just_made_it() {
        let directory = tempfile::tempdir().unwrap();
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..200 {
                        let (_file, path) = create_in(directory.path()).unwrap();
                        assert!(path.exists());
                        std::thread::yield_now();
                        assert!(path.exists());
                    }
                });
            }
        });
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0);
    }
}
