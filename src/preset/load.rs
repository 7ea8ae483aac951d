//! Presets from texts and files, and back.

use super::{Preset, file};
use crate::error::{Error, Result};
use std::io::Read;
use std::path::Path;

/// Largest preset file that is read, in bytes.
pub const MAX_FILE_SIZE: u64 = 1 << 20;

impl Preset {
    /// Reads a preset. `origin` names the text in errors: a path, or where else it came from.
    ///
    /// # Errors
    /// [`Error::Format`] for anything but a preset of a format up to [`FORMAT_VERSION`](super::FORMAT_VERSION) whose every key is known and every value
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
        Self::parse(&text(reader, origin)?, origin)
    }
}

/// The text of a preset or kit file, which errors call `origin`.
pub(super) fn text(reader: impl Read, origin: &str) -> Result<String> {
    let mut bytes = Vec::new();
    reader.take(MAX_FILE_SIZE + 1).read_to_end(&mut bytes).map_err(|source| Error::io(origin, source))?;
    if bytes.len() as u64 > MAX_FILE_SIZE {
        return Err(Error::format(origin, "too large for a preset: expected at most 1 MiB of TOML"));
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Error::format(origin, format!("not a preset: expected UTF-8 text, but byte {at} is not"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

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
