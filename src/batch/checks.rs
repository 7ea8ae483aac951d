//! Checks that a job fits its batch: its files and its sample format.

use super::Batch;
use super::manifest::{self, is_number};
use super::template::Fault;
use crate::request::Request;
use std::path::{Path, PathBuf};

impl Batch {
    /// Returns an error for a job that the format of the files does not support.
    pub(super) fn check_format(&self, request: &Request) -> Result<(), Fault> {
        self.format.check(request.bits, request.rate).map_err(|(key, message)| (key.to_owned(), message))
    }

    /// Returns a message if `input` is a file that a batch in this folder writes, now or later. Only the path matters:
    /// files are written under another name and renamed, so a hard link to an old file keeps its contents.
    pub(super) fn own(&self, input: &Path) -> Option<String> {
        let (folder, path) = (resolved(&self.folder), resolved(input));
        let inside = path.strip_prefix(folder).ok()?;
        let parts: Vec<&str> = inside.iter().map(|part| part.to_str()).collect::<Option<_>>()?;
        let is_own = match parts[..] {
            [name] => manifest::is_name(name),
            [folder, file] => is_number(folder) && stem(file, self.format.ending()).is_some_and(is_number),
            _ => false,
        };
        let message =
            || format!("‘{}’ is a file that this batch writes: expected another file or folder", input.display());
        is_own.then(message)
    }
}

/// The name of a file without the dot and this extension.
fn stem<'a>(file: &'a str, ending: &str) -> Option<&'a str> {
    file.strip_suffix(ending)?.strip_suffix('.')
}

/// A path without symbolic links and dots, as far as it exists.
fn resolved(path: &Path) -> PathBuf {
    if let Ok(whole) = path.canonicalize() {
        return whole;
    }
    match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) if parent.as_os_str().is_empty() => resolved(Path::new(".")).join(name),
        (Some(parent), Some(name)) => resolved(parent).join(name),
        _ => path.to_owned(),
    }
}
