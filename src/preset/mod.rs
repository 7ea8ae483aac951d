//! Preset files: a patch with its name, author, tags and comment, in TOML.

mod factory;
mod file;
mod routes;
mod value;

use crate::error::{Error, Result, nearest};
use crate::patch::Patch;
use std::io::Read;
use std::path::Path;

/// The preset format that this version writes. It reads those before as well: 1 had no routes.
pub const FORMAT_VERSION: i64 = 2;

/// Largest preset file that is read, in bytes.
pub const MAX_FILE_SIZE: u64 = 1 << 20;

/// A patch and what a person calls it.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    /// What it is called and found by; never empty.
    pub name: String,
    /// Who made it.
    pub author: String,
    /// Words to search by.
    pub tags: Vec<String>,
    /// What it is and how to play it.
    pub comment: String,
    /// The sound.
    pub patch: Patch,
}

impl Preset {
    /// Reads a preset. `origin` names the text in errors: a path, or where else it came from.
    ///
    /// # Errors
    /// [`Error::Format`] for anything but a preset of a format up to [`FORMAT_VERSION`] whose every key is known and every value
    /// in range; it names the key and what would be right.
    pub fn parse(text: &str, origin: &str) -> Result<Self> {
        file::parse(text, origin)
    }

    /// Writes the preset so that [`Preset::parse`] gives it back exactly. Parameters at their defaults are left out.
    pub fn to_toml(&self) -> String {
        file::to_toml(self)
    }

    /// Reads the preset file at `path`.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read, [`Error::Format`] if it is larger than [`MAX_FILE_SIZE`], not UTF-8, or
    /// as [`Preset::parse`] says.
    pub fn load(path: &Path) -> Result<Self> {
        let origin = path.display().to_string();
        Self::read(std::fs::File::open(path).map_err(|source| Error::io(&origin, source))?, &origin)
    }

    /// Reads a preset file from `reader`, which errors call `origin`.
    ///
    /// # Errors
    /// As [`Preset::load`].
    pub fn read(reader: impl Read, origin: &str) -> Result<Self> {
        let mut bytes = Vec::new();
        reader.take(MAX_FILE_SIZE + 1).read_to_end(&mut bytes).map_err(|source| Error::io(origin, source))?;
        if bytes.len() as u64 > MAX_FILE_SIZE {
            return Err(Error::format(origin, "too large for a preset: expected at most 1 MiB of TOML"));
        }
        let text = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            Error::format(origin, format!("not a preset: expected UTF-8 text, but byte {at} is not"))
        })?;
        Self::parse(&text, origin)
    }

    /// The presets built into the library, in the order of their MIDI program numbers from 0.
    pub fn factory() -> &'static [Preset] {
        factory::presets()
    }

    /// The factory preset of this name; case does not matter.
    ///
    /// # Errors
    /// [`Error::Value`] naming the nearest name if there is none.
    pub fn find(name: &str) -> Result<&'static Preset> {
        let presets = Self::factory();
        presets.iter().find(|preset| preset.name.eq_ignore_ascii_case(name.trim())).ok_or_else(|| {
            let hint = match nearest(name, presets.iter().map(|preset| preset.name.as_str())) {
                Some(near) => format!("; the nearest is {near}"),
                None => "; ‘sprung presets list’ shows them all".to_owned(),
            };
            Error::value("preset", format!("there is no factory preset ‘{name}’{hint}"))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factory_presets_are_found_by_name() {
        assert_eq!(Preset::find("INIT").unwrap().patch, Patch::default());
        assert_eq!(Preset::find("kick").unwrap().name, "Kick");
        let error = Preset::find("kcik").unwrap_err().to_string();
        assert_eq!(error, "preset: there is no factory preset ‘kcik’; the nearest is ‘Kick’");
        assert!(Preset::find("").is_err());
    }

    #[test]
    fn files_that_cannot_be_presets_are_refused() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.toml");
        for (bytes, expected) in [
            (b"name = \"\xff\"".to_vec(), "expected UTF-8 text, but byte 8 is not"),
            (vec![b'#'; MAX_FILE_SIZE as usize + 1], "expected at most 1 MiB"),
            (b"".to_vec(), "no ‘format’"),
        ] {
            std::fs::write(&path, bytes).unwrap();
            let error = Preset::load(&path).unwrap_err().to_string();
            assert!(error.contains(expected) && error.contains("a.toml"), "{error}");
        }
        assert!(matches!(Preset::load(&directory.path().join("none.toml")), Err(Error::Io { .. })));
        assert!(matches!(Preset::load(directory.path()), Err(Error::Io { .. })));
    }
}
