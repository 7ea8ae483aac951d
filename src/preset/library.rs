//! The user's own presets and kits, as files in a folder of the user's data, and the lists of favourites and of recent sounds.

use super::about::with_ending;
use super::{Playable, Preset, is_file_name};
use crate::error::{Error, Result};
use crate::params::Param;
use crate::params::learned::{Controllers, bind, check_controller};
use crate::text::file_stem;
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// How many of the sounds that were chosen last are kept.
const RECENT: usize = 16;

/// A folder with the user's sounds: `presets/` has their files, `bin/` the discarded files, `favourites.txt` the names
/// of favourites, one per line, `recent.txt` those of the sounds that were chosen last, `controllers.toml` the controllers that move
/// parameters.
#[derive(Clone, Debug)]
pub struct Library {
    folder: PathBuf,
}

/// A file of the library.
#[derive(Debug)]
pub struct Entry {
    /// Path of the file.
    pub path: PathBuf,
    /// The sound in it, or the reason why it could not be read.
    pub playable: Result<Playable>,
}

impl Library {
    /// The library of this user: `sprung` in `$XDG_DATA_HOME` or `~/.local/share`; on macOS `Sprung` in
    /// `~/Library/Application Support`; on Windows `Sprung` in `%APPDATA%`. `None` if the system does not say where
    /// that is. Does not create the folder.
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

    /// The files in the library, in the order of their names. A file that cannot be read is listed with its error.
    /// Empty if there is no folder.
    pub fn entries(&self) -> Vec<Entry> {
        self.paths().into_iter().map(|path| Entry { playable: read(&path), path }).collect()
    }

    /// The sounds of this name, each read from its file when it is asked for.
    pub fn called(&self, name: &str) -> impl Iterator<Item = Playable> {
        let sounds = self.paths().into_iter().filter_map(|path| read(&path).ok());
        sounds.filter(move |sound| sound.name().eq_ignore_ascii_case(name))
    }

    fn paths(&self) -> Vec<PathBuf> {
        let Ok(files) = fs::read_dir(self.presets_folder()) else { return Vec::new() };
        let paths = files.filter_map(|file| Some(file.ok()?.path()));
        let mut paths: Vec<PathBuf> =
            paths.filter(|path| path.extension().is_some_and(|end| end == "toml") && path.is_file()).collect();
        paths.sort();
        paths
    }

    /// Saves a preset, or a kit with its presets in it. A file that has a sound of this name is replaced, if told so; a new one is
    /// named after the sound, with a number if a sound of another name has that file. The file is written under a temporary name and
    /// renamed, so that it is never half-written. Returns its path.
    ///
    /// # Errors
    /// [`Error::Value`] for the name of a factory sound or of a file, by which it would not be found again, [`Error::Exists`] if a
    /// sound of this name exists and is not to be replaced, [`Error::Format`] if the sound could not be read
    /// again, [`Error::Io`] if it cannot be written.
    pub fn save(&self, sound: &Playable, replace: bool) -> Result<PathBuf> {
        let text = text_of(sound)?;
        let stem = file_stem(sound.name());
        let folder = self.presets_folder();
        let place = |number: u32| match number {
            1 => folder.join(format!("{stem}.toml")),
            number => folder.join(format!("{stem}-{number}.toml")),
        };
        let paths = self.paths();
        let numbers = 1..=paths.len() as u32 + 1;
        // A file of any name may have it. If there are copies, the usual name comes first.
        let named = named(sound.name(), paths);
        let usual = numbers.clone().map(place).find(|path| named.contains(path));
        if let Some(path) = usual.or_else(|| named.into_iter().next()) {
            write_whole(&path, text.as_bytes(), replace)?;
            return Ok(path);
        }
        let path = free(numbers.map(place), &folder)?;
        write_whole(&path, text.as_bytes(), false)?;
        Ok(path)
    }

    /// Renames a sound of the library, and its file accordingly. Returns the file's new path.
    ///
    /// # Errors
    /// As [`Playable::read`] and [`Library::save`]; [`Error::Value`] if the file is not in the library.
    pub fn rename(&self, path: &Path, name: &str) -> Result<PathBuf> {
        self.check_own(path)?;
        let mut renamed = read(path)?;
        let is_same = renamed.name().eq_ignore_ascii_case(name);
        renamed.rename(name);
        if is_same {
            // Keep its file: another file may have a preset of the same name, which must not be replaced.
            write_whole(path, text_of(&renamed)?.as_bytes(), true)?;
            return Ok(path.to_owned());
        }
        let saved = self.save(&renamed, false)?;
        fs::remove_file(path).map_err(|source| Error::io(path.display().to_string(), source))?;
        Ok(saved)
    }

    /// Adds a preset to the library, or a kit with its presets. If its name is taken, a number is added to the name. Returns the
    /// sound as saved, and the path of its file.
    ///
    /// # Errors
    /// As [`Library::save`].
    pub fn import(&self, mut sound: Playable) -> Result<(Playable, PathBuf)> {
        let own = sound.name().to_owned();
        let names: Vec<String> =
            self.paths().iter().filter_map(|path| read(path).ok()).map(|found| found.name().to_owned()).collect();
        // Both factory sounds and sounds of the library may have this name.
        let is_taken =
            |name: &str| Playable::find(name).is_ok() || names.iter().any(|other| other.eq_ignore_ascii_case(name));
        let mut number = 2;
        while is_taken(sound.name()) {
            sound.rename(with_ending(&own, &format!(" {number}")));
            number += 1;
        }
        let place = self.save(&sound, false)?;
        Ok((sound, place))
    }

    /// Whether a path is one of the folder with the sounds' files, whether or not there is a file.
    pub fn has(&self, path: &Path) -> bool {
        // Both may be reached by symbolic links.
        let folder = path.parent().and_then(|folder| folder.canonicalize().ok());
        folder.is_some() && folder == self.presets_folder().canonicalize().ok()
    }

    /// Checks that a file is one of the library's.
    fn check_own(&self, path: &Path) -> Result<()> {
        if path.parent() == Some(&self.presets_folder()) {
            return Ok(());
        }
        Err(Error::value(path.display().to_string(), "expected a file of the library"))
    }

    /// Moves a file of the library to its bin. Returns the file's new path.
    ///
    /// # Errors
    /// [`Error::Value`] if the file is not in the library, [`Error::Io`] if it cannot be moved.
    pub fn discard(&self, path: &Path) -> Result<PathBuf> {
        self.check_own(path)?;
        let name = path.file_name().unwrap_or_default();
        let bin = self.folder.join("bin");
        make_folder(&bin)?;
        // No file in the bin is replaced.
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
        Ok(names_in(&self.favourites_file())?.into_iter().collect())
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
        write_names(&self.favourites_file(), names)
    }

    fn favourites_file(&self) -> PathBuf {
        self.folder.join("favourites.txt")
    }

    /// The names of the sixteen sounds that were chosen last, the newest first. Empty if there is no list.
    ///
    /// # Errors
    /// [`Error::Io`] if the list cannot be read.
    pub fn recent(&self) -> Result<Vec<String>> {
        names_in(&self.recent_file())
    }

    /// Notes that a sound was chosen.
    ///
    /// # Errors
    /// [`Error::Io`] if the list cannot be read or written.
    pub fn note_recent(&self, name: &str) -> Result<()> {
        let others = self.recent()?.into_iter().filter(|other| other != name);
        write_names(&self.recent_file(), std::iter::once(name.to_owned()).chain(others).take(RECENT))
    }

    fn recent_file(&self) -> PathBuf {
        self.folder.join("recent.txt")
    }

    /// The controllers that move parameters. None if there is no file of them.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read, [`Error::Format`] if not all of it is understood.
    pub fn controllers(&self) -> Result<Controllers> {
        let file = self.controllers_file();
        let wrong = |message: String| Error::format(file.display().to_string(), message);
        let table: toml::Table =
            read_if_there(&file)?.parse().map_err(|error: toml::de::Error| wrong(error.message().to_owned()))?;
        let mut controllers = Controllers::new();
        for (id, number) in table {
            let expected =
                || wrong(format!("{id} = {number}: expected a parameter's id and a controller, as in decay = 21"));
            let param = Param::from_id(&id).ok_or_else(expected)?;
            let controller = number.as_integer().and_then(|number| u8::try_from(number).ok()).ok_or_else(expected)?;
            check_controller(controller).map_err(|message| wrong(format!("{id}: {message}")))?;
            if let Some(other) = controllers.insert(controller, param) {
                return Err(wrong(format!(
                    "controller {controller} moves both {} and {id}: expected one",
                    other.info().id
                )));
            }
        }
        Ok(controllers)
    }

    /// Binds a controller to a parameter, in place of what either was bound to; without a controller, the parameter has none.
    /// Returns all that are bound.
    ///
    /// # Errors
    /// As [`Library::controllers`]: what is not understood is not written over. [`Error::Value`] for a controller that cannot
    /// be bound, [`Error::Io`] if the file cannot be written.
    pub fn set_controller(&self, param: Param, controller: Option<u8>) -> Result<Controllers> {
        controller.map_or(Ok(()), check_controller).map_err(|message| Error::value(param.info().id, message))?;
        let mut controllers = self.controllers()?;
        bind(&mut controllers, param, controller);
        let line = |(controller, param): (&u8, &Param)| format!("{} = {controller}\n", param.info().id);
        let text: String = controllers.iter().map(line).collect();
        write_whole(&self.controllers_file(), text.as_bytes(), true)?;
        Ok(controllers)
    }

    fn controllers_file(&self) -> PathBuf {
        self.folder.join("controllers.toml")
    }
}

/// The folder for the user's data of this program.
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

/// Writes the file of a sound to a path of any folder, whole or not at all; one that is there is replaced only if told so. In the
/// library's own folder, the file that has a sound of this name takes the place of the path. Returns the file's path.
///
/// # Errors
/// As [`Library::save`].
pub fn export(sound: &Playable, path: &Path, library: Option<&Library>, replace: bool) -> Result<PathBuf> {
    let text = text_of(sound)?;
    let own = library.filter(|library| library.has(path)).map(Library::paths).unwrap_or_default();
    let same = named(sound.name(), own);
    let path = same.first().filter(|_| !same.iter().any(|same| same == path)).map_or(path, PathBuf::as_path);
    write_whole(path, text.as_bytes(), replace)?;
    Ok(path.to_owned())
}

/// Checks that a sound can be saved.
///
/// # Errors
/// [`Error::Value`] and [`Error::Format`] as [`Library::save`].
pub fn check(sound: &Playable) -> Result<()> {
    text_of(sound).map(drop)
}

/// The files among these that have a sound of this name.
fn named(name: &str, paths: Vec<PathBuf>) -> Vec<PathBuf> {
    let is_it = |path: &PathBuf| read(path).is_ok_and(|found| found.name().eq_ignore_ascii_case(name));
    paths.into_iter().filter(is_it).collect()
}

/// Reads a preset or kit file.
fn read(path: &Path) -> Result<Playable> {
    let mut open = |path: &Path| File::open(path).map_err(|source| Error::io(path.display().to_string(), source));
    Playable::read(path, &mut open)
}

/// The text of a sound's file. The sound's name must be neither that of a factory sound nor a file name.
fn text_of(sound: &Playable) -> Result<String> {
    let name = sound.name();
    if Playable::find(name).is_ok() {
        return Err(Error::value("name", format!("‘{name}’ is a sound of the factory: expected another name")));
    }
    if is_file_name(Path::new(name)) {
        let message = format!("‘{name}’ would be taken for a file: expected a name without / and .toml");
        return Err(Error::value("name", message));
    }
    let text = sound.to_toml();
    Playable::parse(&text, name, &mut |name| Preset::find(name).cloned())?;
    Ok(text)
}

/// The first of these paths at which nothing exists. `folder` is their folder, for the error.
fn free(mut places: impl Iterator<Item = PathBuf>, folder: &Path) -> Result<PathBuf> {
    let free = places.find(|place| !place.exists());
    free.ok_or_else(|| Error::value(folder.display().to_string(), "expected a folder with room for another file"))
}

/// The names in a list, one per line. None if there is no list.
fn names_in(file: &Path) -> Result<Vec<String>> {
    let text = read_if_there(file)?;
    Ok(text.lines().map(str::trim).filter(|name| !name.is_empty()).map(str::to_owned).collect())
}

fn write_names(file: &Path, names: impl IntoIterator<Item = String>) -> Result<()> {
    let text: String = names.into_iter().map(|name| name + "\n").collect();
    write_whole(file, text.as_bytes(), true)
}

/// The text of a file; of one that is not there, none.
fn read_if_there(path: &Path) -> Result<String> {
    match fs::read_to_string(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(String::new()),
        text => text.map_err(|error| Error::io(path.display().to_string(), error)),
    }
}

fn make_folder(folder: &Path) -> Result<()> {
    fs::create_dir_all(folder).map_err(|source| Error::io(folder.display().to_string(), source))
}

/// Writes a temporary file beside `path` and renames it, so that `path` is never half-written. Makes its folder.
fn write_whole(path: &Path, bytes: &[u8], replace: bool) -> Result<()> {
    let failed = |source: io::Error| Error::io(path.display().to_string(), source);
    let folder = path.parent().unwrap_or(Path::new("."));
    make_folder(folder)?;
    #[cfg_attr(not(unix), expect(unused_mut, reason = "only Unix has permissions to set"))]
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // The permissions of an ordinary new file, from which the umask is subtracted.
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
mod tests;
