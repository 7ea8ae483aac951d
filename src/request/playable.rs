//! Loads presets and kits by name or path.

use crate::error::{Error, Result};
use crate::io::Inputs;
use crate::preset::library::{Entry, Library};
use crate::preset::{Playable, is_file_name};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Loads the preset or kit with this name: a file if it looks like a file name, otherwise a factory sound, otherwise
/// one of the user's own, whose file then counts as an input.
///
/// # Errors
/// As [`Playable::read`], and [`Error::Value`](crate::Error::Value) for a name that no sound has.
pub fn playable(name: &OsStr, inputs: &mut Inputs) -> Result<Playable> {
    let path = Path::new(name);
    let mut read = |path: &Path| Playable::read(path, &mut |path| inputs.open(path));
    let is_other_file = path.extension().is_some_and(|ending| !ending.eq_ignore_ascii_case("toml"));
    let other_file = || {
        let message = format!("‘{}’ is no preset file: expected a name that ends in .toml", path.display());
        Error::value("preset", message)
    };
    if is_file_name(path) {
        return read(path).map_err(|error| match error {
            Error::Format { .. } if is_other_file => other_file(),
            error => error,
        });
    }
    let name = name.to_string_lossy();
    Playable::find(&name).or_else(|unknown| match own(name.trim()) {
        Some(path) => read(&path),
        None if is_other_file && path.is_file() => Err(other_file()),
        None => Err(unknown),
    })
}

/// The file of the user's own sound of this name; case does not matter.
fn own(name: &str) -> Option<PathBuf> {
    let mut entries = Library::of_user()?.entries().into_iter();
    let is_it = |entry: &Entry| entry.playable.as_ref().is_ok_and(|own| own.name().eq_ignore_ascii_case(name));
    entries.find_map(|entry| is_it(&entry).then_some(entry.path))
}
