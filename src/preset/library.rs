//! The user's own presets and kits, as files in a folder of the user's data, and which sounds are favourites.

use super::{Playable, Preset, Replaced};
use crate::error::{Error, Result};
use crate::text::slug;
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A folder with the user's sounds: `presets/` has their files, `bin/` those that were thrown away, `favourites.txt` the
/// names of favourites, one a line.
#[derive(Clone, Debug)]
pub struct Library {
    folder: PathBuf,
}

/// A file of the library.
#[derive(Debug)]
pub struct Entry {
    /// Where it is.
    pub path: PathBuf,
    /// What is in it, or why it could not be read.
    pub playable: Result<Playable>,
}

impl Library {
    /// The library of this user: `sprung` in `$XDG_DATA_HOME` or `~/.local/share`; on macOS `Sprung` in
    /// `~/Library/Application Support`; on Windows `Sprung` in `%APPDATA%`. `None` if the system does not say where that is.
    /// Makes no folder.
    pub fn of_user() -> Option<Self> {
        data_folder(&|name| std::env::var_os(name)).map(Self::at)
    }

    /// The library in a folder, which need not exist.
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// The folder with the sounds' files.
    pub fn presets_folder(&self) -> PathBuf {
        self.folder.join("presets")
    }

    /// The files in the library, in the order of their names. Those that cannot be read say why. Empty if there is no
    /// folder.
    pub fn entries(&self) -> Vec<Entry> {
        self.paths().into_iter().map(|path| Entry { playable: read(&path), path }).collect()
    }

    fn paths(&self) -> Vec<PathBuf> {
        let Ok(files) = fs::read_dir(self.presets_folder()) else { return Vec::new() };
        let paths = files.filter_map(|file| Some(file.ok()?.path()));
        let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
        paths.sort();
        paths
    }

    /// Saves a preset under its name, in a file that is named after it; with a number if the file of a sound with another
    /// name is there. Appears whole or not at all. Returns where it is.
    ///
    /// # Errors
    /// [`Error::Exists`] if a preset of this name exists and is not to be replaced, [`Error::Format`] if the preset could not be read
    /// again, [`Error::Io`] if it cannot be written.
    pub fn save(&self, preset: &Preset, replace: bool) -> Result<PathBuf> {
        let text = preset.to_toml();
        Preset::parse(&text, &preset.name)?;
        let slug = slug(&preset.name);
        let slug = if slug.is_empty() { "sound" } else { &slug };
        let folder = self.presets_folder();
        let place = |number: u32| match number {
            1 => folder.join(format!("{slug}.toml")),
            number => folder.join(format!("{slug}-{number}.toml")),
        };
        let is_it = |path: &PathBuf| matches!(read(path), Ok(Playable::Preset(found)) if found.name == preset.name);
        // A number may be free before that of the preset, if another one was thrown away.
        let numbers = 1..=self.paths().len() as u32 + 1;
        if let Some(path) = numbers.clone().map(place).find(is_it) {
            write_whole(&path, text.as_bytes(), replace)?;
            return Ok(path);
        }
        let path = free(numbers.map(place), &folder)?;
        write_whole(&path, text.as_bytes(), false)?;
        Ok(path)
    }

    /// Moves a file of the library to its bin. Returns where it is now.
    ///
    /// # Errors
    /// [`Error::Value`] if the file is not in the library, [`Error::Io`] if it cannot be moved.
    pub fn discard(&self, path: &Path) -> Result<PathBuf> {
        let name = path.file_name().filter(|_| path.parent() == Some(&self.presets_folder()));
        let name = name.ok_or_else(|| Error::value(path.display().to_string(), "expected a file of the library"))?;
        let bin = self.folder.join("bin");
        make_folder(&bin)?;
        // Nothing in the bin is replaced.
        let place = |number: u32| match number {
            0 => bin.join(name),
            number => bin.join(format!("{number}-{}", name.to_string_lossy())),
        };
        let free = free((0..=u32::MAX).map(place), &bin)?;
        fs::rename(path, &free).map_err(|source| Error::io(path.display().to_string(), source))?;
        Ok(free)
    }

    /// The names of favourites. Empty if there is no list.
    ///
    /// # Errors
    /// [`Error::Io`] if the list cannot be read.
    pub fn favourites(&self) -> Result<BTreeSet<String>> {
        let file = self.favourites_file();
        let text = match fs::read_to_string(&file) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(Error::io(file.display().to_string(), error)),
        };
        Ok(text.lines().map(str::trim).filter(|name| !name.is_empty()).map(str::to_owned).collect())
    }

    /// Makes a sound a favourite, or not.
    ///
    /// # Errors
    /// [`Error::Io`] if the list cannot be read or written.
    pub fn set_favourite(&self, name: &str, is_favourite: bool) -> Result<()> {
        let mut names = self.favourites()?;
        if is_favourite {
            names.insert(name.to_owned());
        } else {
            names.remove(name);
        }
        let text: String = names.into_iter().map(|name| name + "\n").collect();
        write_whole(&self.favourites_file(), text.as_bytes(), true)
    }

    fn favourites_file(&self) -> PathBuf {
        self.folder.join("favourites.txt")
    }
}

/// The folder for this program's data of the user.
fn data_folder(variable: &dyn Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let folder = |name: &str| variable(name).map(PathBuf::from).filter(|path| path.is_absolute());
    if cfg!(windows) {
        return Some(folder("APPDATA")?.join("Sprung"));
    }
    if cfg!(target_os = "macos") {
        return Some(folder("HOME")?.join("Library/Application Support/Sprung"));
    }
    // XDG Base Directory Specification 0.8: a relative path is to be ignored.
    let data = folder("XDG_DATA_HOME").or_else(|| Some(folder("HOME")?.join(".local/share")))?;
    Some(data.join("sprung"))
}

/// Reads a preset or kit file.
fn read(path: &Path) -> Result<Playable> {
    let mut open = |path: &Path| File::open(path).map_err(|source| Error::io(path.display().to_string(), source));
    Playable::read(path, &mut open, &mut |_: &str, _: Replaced| {})
}

/// The first of these places in a folder where nothing is.
fn free(mut places: impl Iterator<Item = PathBuf>, folder: &Path) -> Result<PathBuf> {
    let free = places.find(|place| !place.exists());
    free.ok_or_else(|| Error::value(folder.display().to_string(), "expected a folder with room for another file"))
}

fn make_folder(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder).map_err(|source| Error::io(folder.display().to_string(), source))
}

/// Writes a file beside its place and renames it, so that it appears whole or not at all. Makes its folder.
fn write_whole(path: &Path, bytes: &[u8], replace: bool) -> Result<()> {
    let failed = |source: io::Error| Error::io(path.display().to_string(), source);
    let folder = path.parent().unwrap_or(Path::new("."));
    make_folder(folder)?;
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As any other file of the user: what the umask leaves.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    file.write_all(bytes).and_then(|()| file.as_file().sync_all()).map_err(failed)?;
    let renamed = if replace { file.persist(path) } else { file.persist_noclobber(path) };
    match renamed {
        Ok(_) => Ok(()),
        Err(error) if error.error.kind() == io::ErrorKind::AlreadyExists => {
            Err(Error::Exists { path: path.display().to_string() })
        }
        Err(error) => Err(failed(error.error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn library() -> (tempfile::TempDir, Library) {
        let folder = tempfile::tempdir().unwrap();
        let library = Library::at(folder.path().join("sprung"));
        (folder, library)
    }

    fn named(name: &str) -> Preset {
        Preset { name: name.to_owned(), ..Preset::find("Church Bell").unwrap().clone() }
    }

    #[test]
    fn presets_are_saved_under_their_names_and_replaced_only_when_told() {
        let (_folder, library) = library();
        assert!(library.entries().is_empty());
        let path = library.save(&named("My Bell"), false).unwrap();
        assert_eq!(path.file_name().unwrap(), "my-bell.toml");
        assert_eq!(library.save(&named("Ω"), false).unwrap().file_name().unwrap(), "sound.toml");
        assert!(matches!(library.save(&named("My Bell"), false), Err(Error::Exists { .. })));
        let names = |library: &Library| -> Vec<String> {
            library.entries().iter().map(|entry| entry.playable.as_ref().unwrap().name().to_owned()).collect()
        };
        assert_eq!(names(&library), ["My Bell", "Ω"]);
        assert_eq!(library.save(&named("My Bell"), true).unwrap(), path);
        assert_eq!(names(&library), ["My Bell", "Ω"]);
        let error = library.save(&named(&"n".repeat(101)), false).unwrap_err().to_string();
        assert!(error.contains("at most 100 characters"), "{error}");
        assert_eq!(fs::read_dir(library.presets_folder()).unwrap().count(), 2, "nothing else is left");
    }

    #[test]
    fn sounds_of_other_names_are_not_replaced() {
        let (_folder, library) = library();
        let save = |name: &str, replace| {
            let path = library.save(&named(name), replace).unwrap();
            path.file_name().unwrap().to_string_lossy().into_owned()
        };
        assert_eq!(
            ["My Bell", "my-bell!", "Ω", "β"].map(|name| save(name, true)),
            ["my-bell.toml", "my-bell-2.toml", "sound.toml", "sound-2.toml"]
        );
        library.discard(&library.presets_folder().join("my-bell.toml")).unwrap();
        assert!(matches!(library.save(&named("my-bell!"), false), Err(Error::Exists { .. })));
        assert_eq!(save("my-bell!", true), "my-bell-2.toml", "where it was");
        fs::write(library.presets_folder().join("sound-3.toml"), "broken").unwrap();
        assert_eq!(save("λ", true), "sound-4.toml");
        assert_eq!(library.entries().len(), 5);
    }

    #[test]
    fn what_is_no_preset_says_why() {
        let (_folder, library) = library();
        library.save(&named("Good"), false).unwrap();
        fs::write(library.presets_folder().join("bad.toml"), "format = \"x\"").unwrap();
        fs::write(library.presets_folder().join("notes.txt"), "not a sound").unwrap();
        let entries = library.entries();
        assert_eq!(entries.len(), 2);
        assert!(entries[0].playable.is_err() && entries[1].playable.is_ok());
    }

    #[test]
    fn files_go_to_the_bin_and_nothing_there_is_replaced() {
        let (folder, library) = library();
        let bins: Vec<PathBuf> =
            (0..3).map(|_| library.discard(&library.save(&named("Bell"), false).unwrap()).unwrap()).collect();
        assert!(bins.iter().all(|path| path.is_file()) && library.entries().is_empty());
        let stranger = folder.path().join("stranger.toml");
        fs::write(&stranger, "").unwrap();
        assert!(library.discard(&stranger).is_err() && stranger.exists());
    }

    #[test]
    fn favourites_are_kept() {
        let (_folder, library) = library();
        for name in ["Kick", "Church Bell", "Kick"] {
            library.set_favourite(name, true).unwrap();
        }
        let favourites = || library.favourites().unwrap().into_iter().collect::<Vec<_>>();
        assert_eq!(favourites(), ["Church Bell", "Kick"]);
        library.set_favourite("Kick", false).unwrap();
        assert_eq!(favourites(), ["Church Bell"]);
        // No UTF-8.
        fs::write(library.favourites_file(), b"Kick\n\xff\n").unwrap();
        assert!(library.favourites().is_err() && library.set_favourite("Church Bell", true).is_err());
        assert_eq!(fs::read(library.favourites_file()).unwrap(), b"Kick\n\xff\n", "not written over");
    }

    #[cfg(all(unix, not(target_os = "macos")))]
    #[test]
    fn the_folder_is_where_the_system_keeps_data() {
        let find = |variables: &[(&str, &str)]| {
            data_folder(&|name| variables.iter().find(|(known, _)| *known == name).map(|(_, value)| value.into()))
        };
        assert_eq!(find(&[("XDG_DATA_HOME", "/d"), ("HOME", "/h")]), Some("/d/sprung".into()));
        assert_eq!(find(&[("XDG_DATA_HOME", "d"), ("HOME", "/h")]), Some("/h/.local/share/sprung".into()));
        assert_eq!(find(&[]), None);
    }
}
