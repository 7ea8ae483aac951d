//! The tuning in a preset file: the texts of Scala's files in the table `[tuning]`, with the keys `scale` and `keymap`.

use super::about::toml_string;
use super::complaints::Complaints;
use super::value::{check_keys, unexpected};
use crate::error::Result;
use crate::sound::Tuning;
use crate::sound::tuning::{Keymap, Scale};
use toml::{Table, Value};

const KEYS: [&str; 2] = ["scale", "keymap"];

/// The tuning of a preset, which replaces the instrument's, and the texts from which it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnTuning {
    scale: String,
    keymap: Option<String>,
    tuning: Tuning,
}

impl OwnTuning {
    /// Reads the text of a scale (`.scl`) and of a keyboard mapping (`.kbm`). Without a mapping, degree 0 is on key 60,
    /// and each key plays the next degree. Allocates.
    ///
    /// # Errors
    /// As [`Scale::parse`] and [`Keymap::parse`], with the origins `tuning.scale` and `tuning.keymap`.
    pub fn from_scala(scale: String, keymap: Option<String>) -> Result<Self> {
        let steps = Scale::parse(&scale, "tuning.scale")?;
        let keys = keymap.as_deref().map_or(Ok(Keymap::LINEAR), |keymap| Keymap::parse(keymap, "tuning.keymap"))?;
        Ok(Self { tuning: Tuning::new(&steps, &keys), scale, keymap })
    }

    /// The text of the scale.
    pub fn scale(&self) -> &str {
        &self.scale
    }

    /// The text of the mapping, if there is one.
    pub fn keymap(&self) -> Option<&str> {
        self.keymap.as_deref()
    }

    /// The pitches of the keys.
    pub fn tuning(&self) -> &Tuning {
        &self.tuning
    }
}

/// Reads the tuning of a file, if it has one.
pub(super) fn read(file: &Table, complaints: &mut Complaints) -> Option<OwnTuning> {
    let table = match file.get("tuning")? {
        Value::Table(table) => table,
        other => {
            complaints.add(unexpected("tuning", "a table [tuning]", other));
            return None;
        }
    };
    check_keys(table, "tuning.", &KEYS, complaints);
    let [scale, keymap] = KEYS.map(|key| match table.get(key) {
        None => Ok(None),
        Some(Value::String(text)) => Ok(Some(text.clone())),
        Some(other) => Err(unexpected(&format!("tuning.{key}"), "the text of a Scala file", other)),
    });
    let (scale, keymap) = (complaints.take("", scale)?, complaints.take("", keymap)?);
    let Some(scale) = scale else {
        complaints.add("there is no ‘tuning.scale’: expected the text of a Scala scale (.scl)");
        return None;
    };
    complaints.take("", OwnTuning::from_scala(scale, keymap).map_err(|error| error.to_string()))
}

/// The table `[tuning]` as TOML; empty without a tuning.
pub(super) fn to_toml(tuning: Option<&OwnTuning>) -> String {
    tuning.map_or(String::new(), |OwnTuning { scale, keymap, .. }| {
        let keymap = keymap.as_ref().map_or(String::new(), |keymap| format!("keymap = {}\n", toml_string(keymap)));
        format!("\n[tuning]\nscale = {}\n{keymap}", toml_string(scale))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset::Preset;
    use crate::sound::tuning::Pitch;

    const SCALE: &str = "! five.scl\n!\nfive equal steps, \"slendro\"\n5\n240.\n480.\n720.\n960.\n2/1\n";
    const KEYMAP: &str = "0\n0\n127\n60\n69\n432.\n0\n";

    fn preset(tuning: &str) -> Result<Preset> {
        Preset::parse(&format!("format = 1\nname = \"a\"\n{tuning}"), "x")
    }

    #[test]
    fn a_preset_brings_its_tuning_along() {
        let own = OwnTuning::from_scala(SCALE.to_owned(), Some(KEYMAP.to_owned())).unwrap();
        let read = preset(&format!("[tuning]\nscale = '''{SCALE}'''\nkeymap = '''{KEYMAP}'''\n")).unwrap();
        assert_eq!(read.tuning, Some(own));
        assert_eq!(Preset::parse(&read.to_toml(), "y").unwrap(), read);
        let kit = read.kit();
        let pitch = |key| kit.sounds()[0].tuning().unwrap().pitch(key);
        assert_eq!(pitch(69), Some(Pitch::Hertz(432.0)));
        assert_eq!(pitch(74), Some(Pitch::Hertz(864.0)), "five steps are an octave");
        assert_eq!(preset("").unwrap().kit().sounds()[0].tuning(), None);
    }

    #[test]
    fn every_error_says_what_would_be_right() {
        for (tuning, expected) in [
            ("tuning = 432", "x: tuning: expected a table [tuning]"),
            ("[tuning]", "x: there is no ‘tuning.scale’: expected the text of a Scala scale (.scl)"),
            ("[tuning]\nscale = 19", "x: tuning.scale: expected the text of a Scala file"),
            ("[tuning]\nscala = \"\"", "x: unknown key ‘tuning.scala’; the nearest is ‘scale’"),
            ("[tuning]\nscale = \"a\\n1\\nx\"", "x: tuning.scale:3: "),
            ("[tuning]\nscale = \"a\\n1\\n2/1\"\nkeymap = \"x\"", "x: tuning.keymap:1: "),
        ] {
            let error = preset(tuning).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
