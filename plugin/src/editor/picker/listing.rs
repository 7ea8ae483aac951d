//! The folders and files in a folder, read on a thread of their own: a folder on a network may take long.

use crate::editor::background::{Background, Progress};
use crate::editor::drops::has_ending;
use sprung::internals::text::printable;
use sprung::{Error, Result};
use std::fs;
use std::path::PathBuf;

/// Folders of the user's that are offered, if they are there.
const OF_USER: [&str; 4] = ["Desktop", "Documents", "Downloads", "Music"];

/// A folder or file with its name as shown to the user.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) path: PathBuf,
    pub(super) is_folder: bool,
}

/// What is in a folder.
#[derive(Default)]
pub(super) struct Listing {
    pub(super) folder: PathBuf,
    pub(super) entries: Vec<Entry>,
    /// The file, if the path was not that of a folder.
    pub(super) file: Option<PathBuf>,
}

/// Begins to read the folder at a path, or that of the file there: its folders, and its files with one of these endings.
///
/// # Errors
/// A message, if the system has no thread for it.
pub(super) fn start(path: PathBuf, endings: Vec<&'static str>) -> std::result::Result<Background<Listing>, String> {
    let name = printable(&path.display().to_string()).into_owned();
    Background::start(name, move |progress| list(path, &endings, progress))
}

/// Begins to look for folders to go to from anywhere, on a thread of its own: one of them may be on a network that does not answer.
///
/// # Errors
/// As [`start`].
pub(super) fn find_places(own: Option<PathBuf>) -> std::result::Result<Background<Vec<Entry>>, String> {
    Background::start("places".to_owned(), move |_| Ok(places(own)))
}

fn list(path: PathBuf, endings: &[&str], progress: &Progress) -> Result<Listing> {
    let failed = |source| Error::io(path.display().to_string(), source);
    let is_file = fs::metadata(&path).map_err(failed)?.is_file();
    let folder = if is_file { path.parent().unwrap_or(&path).to_owned() } else { path.clone() };
    let mut entries = Vec::new();
    for entry in fs::read_dir(&folder).map_err(failed)? {
        if progress.is_cancelled() {
            return Err(Error::Interrupted);
        }
        let Ok(entry) = entry else { continue };
        let (name, path) = (entry.file_name(), entry.path());
        let is_hidden = name.to_string_lossy().starts_with('.');
        let is_folder = path.is_dir();
        if !is_hidden && (is_folder || has_ending(&path, endings)) {
            entries.push(entry_of(&name.to_string_lossy(), path, is_folder));
        }
    }
    entries.sort_by_cached_key(|entry| (!entry.is_folder, entry.name.to_lowercase()));
    Ok(Listing { folder, entries, file: is_file.then_some(path) })
}

fn entry_of(name: &str, path: PathBuf, is_folder: bool) -> Entry {
    Entry { name: printable(name).into_owned(), path, is_folder }
}

/// The user's folders, that of the user's sounds, and the roots of the system.
fn places(own: Option<PathBuf>) -> Vec<Entry> {
    let home = std::env::home_dir();
    let of_user = home.iter().flat_map(|home| OF_USER.map(|name| (name.to_owned(), home.join(name))));
    let home = home.iter().map(|home| ("Home".to_owned(), home.clone()));
    let own = own.into_iter().map(|own| ("Your sounds".to_owned(), own));
    let roots =
        if cfg!(windows) { ('A'..='Z').map(|letter| format!("{letter}:\\")).collect() } else { vec!["/".to_owned()] };
    let roots = roots.into_iter().map(|root| (root.clone(), PathBuf::from(root)));
    let all = home.chain(of_user).chain(own).chain(roots);
    all.filter(|(_, path)| path.is_dir()).map(|(name, path)| entry_of(&name, path, true)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_come_first_and_other_files_are_left_out() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b.SCL", "a.kbm", ".hidden.scl", "song.mid"] {
            fs::write(folder.path().join(name), "x").unwrap();
        }
        fs::create_dir(folder.path().join("scales")).unwrap();
        let listed = |path: PathBuf| list(path, &["scl", "kbm"], &Progress::default());
        let listing = listed(folder.path().to_owned()).unwrap();
        let names: Vec<_> = listing.entries.iter().map(|entry| entry.name.as_str()).collect();
        assert_eq!((names, listing.file), (vec!["scales", "a.kbm", "b.SCL"], None));
        let listing = listed(folder.path().join("a.kbm")).unwrap();
        assert_eq!((listing.folder.as_path(), listing.file), (folder.path(), Some(folder.path().join("a.kbm"))));
        assert!(listed(folder.path().join("missing")).is_err());
    }
}
