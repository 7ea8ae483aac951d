//! Reads presets from texts and files, and writes them.

use super::complaints::Complaints;
use super::{Preset, file};
use crate::error::{Error, Result};
use std::io::Read;
use std::path::Path;

/// Maximum size of a preset or kit file in bytes: a kit may have 128 presets in it.
pub(crate) const MAX_FILE_SIZE: u64 = 16 << 20;

impl Preset {
    /// Reads a preset. `origin` names the text in errors: a path, or another source.
    ///
    /// # Errors
    /// [`Error::Format`] if it is not a preset of the format `FORMAT_VERSION`, a key is
    /// unknown, or a value is out of range. The error names the key and what would be right.
    pub fn parse(text: &str, origin: &str) -> Result<Self> {
        let mut complaints = Complaints::default();
        let preset = file::parse(text, origin, &mut complaints)?;
        complaints.into_first(origin).map(|()| preset)
    }

    /// As [`Preset::parse`], but reads as much as possible. Unreadable parts get their default values; each is
    /// described in one line of the returned list.
    ///
    /// # Errors
    /// [`Error::Format`] for a text that is not TOML or not a preset.
    pub fn parse_lenient(text: &str, origin: &str) -> Result<(Self, Vec<String>)> {
        let mut complaints = Complaints::default();
        let preset = file::parse(text, origin, &mut complaints)?;
        Ok((preset, complaints.into_lines()))
    }

    /// Writes the preset as TOML. [`Preset::parse`] gives exactly the same preset. Parameters at their defaults are
    /// left out.
    pub fn to_toml(&self) -> String {
        file::to_toml(self)
    }

    /// Reads the preset file at `path`.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be read, [`Error::Format`] if it is larger than 16 MiB, not UTF-8, or
    /// as [`Preset::parse`] says.
    pub fn load(path: &Path) -> Result<Self> {
        let origin = path.display().to_string();
        Self::read(std::fs::File::open(path).map_err(|source| Error::io(&origin, source))?, &origin)
    }

    /// Reads a preset file from `reader`. `origin` names the file in errors.
    ///
    /// # Errors
    /// As [`Preset::load`].
    pub(crate) fn read(reader: impl Read, origin: &str) -> Result<Self> {
        Self::parse(&text(reader, origin)?, origin)
    }
}

/// Reads the text of a preset or kit file. `origin` names the file in errors.
pub(super) fn text(reader: impl Read, origin: &str) -> Result<String> {
    let mut bytes = Vec::new();
    reader.take(MAX_FILE_SIZE + 1).read_to_end(&mut bytes).map_err(|source| Error::io(origin, source))?;
    if bytes.len() as u64 > MAX_FILE_SIZE {
        return Err(Error::format(origin, "too large for a preset: expected at most 16 MiB of TOML"));
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Error::format(origin, format!("not a preset: expected UTF-8 text, but byte {at} is not"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Param;
    use crate::patch::routes::{Routes, Source};
    use crate::patch::{Mode, ModeTable, Patch};

    #[test]
    fn files_that_cannot_be_presets_are_refused() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("a.toml");
        for (bytes, expected) in [
            (b"name = \"\xff\"".to_vec(), "expected UTF-8 text, but byte 8 is not"),
            (vec![b'#'; MAX_FILE_SIZE as usize + 1], "expected at most 16 MiB"),
            (b"".to_vec(), "no ‘format’"),
        ] {
            std::fs::write(&path, bytes).unwrap();
            let error = Preset::load(&path).unwrap_err().to_string();
            assert!(error.contains(expected) && error.contains("a.toml"), "{error}");
        }
        assert!(matches!(Preset::load(&directory.path().join("none.toml")), Err(Error::Io { .. })));
        assert!(matches!(Preset::load(directory.path()), Err(Error::Io { .. })));
    }

    #[test]
    fn a_lenient_reader_takes_what_can_be_read_and_tells_the_rest() {
        let text = "format = 9\nname = \"a\"\nwarp = 1\ntags = [\"x\", 2]\n\
            modes = [{ ratio = 2, level = 9, pan = 0.5 }, { level = 1 }, { ratio = -1 }, 3]\n\
            routes = [{ source = \"lfo9\", to = \"tune\" }, { source = \"lfo1\", to = \"tune\", amount = 5 }]\n\
            [params]\ndecay = 2\ngain = 99\nxylophone = 1\n";
        let (preset, complaints) = Preset::parse_lenient(text, "x").unwrap();
        let mut patch = Patch::default().with(Param::Decay, 2.0);
        patch.modes = ModeTable::new(&[Mode { ratio: 2.0, pan: 0.5, ..Mode::UNIT }]);
        patch.routes = Routes::NONE;
        let patch = patch.with_route(1, Source::Lfo1, Param::Tune, 5.0);
        assert_eq!(preset.patch, patch);
        assert_eq!((preset.name.as_str(), preset.tags), ("a", vec!["x".to_owned()]));
        let starts = [
            "format 9 is of a newer version",
            "unknown key ‘warp’",
            "tags[1]: expected a text",
            "unknown key ‘params.xylophone’",
            "params.gain: 99 is out of range",
            "modes[0].level: 9 is out of range",
            "modes[1]: there is no ‘ratio’",
            "modes[2].ratio: -1 is out of range",
            "modes[3]: expected a mode",
            "routes[0].source: ‘lfo9’ is none",
        ];
        assert_eq!(complaints.len(), starts.len(), "{complaints:?}");
        assert!(complaints.iter().zip(starts).all(|(line, start)| line.starts_with(start)), "{complaints:?}");
        let strict = Preset::parse(text, "x").unwrap_err().to_string();
        assert_eq!(strict, format!("x: {}", complaints[0]), "a strict one tells the first");
        for none in ["= =", "", "format = \"1\"", "kit = 1"] {
            assert!(Preset::parse_lenient(none, "x").is_err(), "{none}");
        }
    }
}
