//! The presets built into the library.

use super::Preset;
use crate::error::{Error, Result, nearest};
use std::sync::OnceLock;

macro_rules! embed {
    ($($name:literal)*) => {
        &[$(($name, include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/presets/", $name, ".toml"))),)*]
    };
}

/// File names (without `.toml`) and texts. The index is the MIDI program number, so only append to the list.
const FILES: &[(&str, &str)] = embed! {
    "00-init"
    "01-kick"
    "02-deep-kick"
    "03-click-kick"
    "04-long-kick"
    "05-low-tom"
    "06-high-tom"
    "07-snare"
    "08-tight-snare"
    "09-closed-hat"
    "10-open-hat"
    "11-clap"
    "12-rim"
    "13-cowbell"
    "14-woodblock"
    "15-clave"
    "16-shaker"
    "17-triangle"
    "18-blip"
    "19-zap"
    "20-laser"
    "21-droplet"
    "22-sine-lead"
    "23-sub-bass"
    "24-pluck-bass"
    "25-plucked-string"
    "26-swell"
    "27-marimba"
    "28-vibraphone"
    "29-xylophone"
    "30-glockenspiel"
    "31-kalimba"
    "32-music-box"
    "33-chimes"
    "34-timpani"
    "35-membrane"
    "36-free-bar"
    "37-church-bell"
    "38-gong"
    "39-wine-glass"
    "40-tam-tam"
    "41-opera-gong"
    "42-floor-tom"
    "43-slack-string"
    "44-resonator-marimba"
    "45-guitar"
    "46-shell-tom"
};

impl Preset {
    /// The presets built into the library, in the order of their MIDI program numbers from 0.
    pub fn factory() -> &'static [Preset] {
        static PRESETS: OnceLock<Vec<Preset>> = OnceLock::new();
        PRESETS.get_or_init(|| {
            let parsed = FILES.iter().map(|(name, text)| Self::parse(text, name));
            parsed.collect::<Result<_>>().expect("the embedded presets are checked by a test")
        })
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
    use crate::patch::Patch;

    #[test]
    fn factory_presets_are_found_by_name() {
        assert_eq!(Preset::find("INIT").unwrap().patch, Patch::default());
        assert_eq!(Preset::find("kick").unwrap().name, "Kick");
        let error = Preset::find("kcik").unwrap_err().to_string();
        assert_eq!(error, "preset: there is no factory preset ‘kcik’; the nearest is ‘Kick’");
        assert!(Preset::find("").is_err());
    }

    #[test]
    fn every_factory_preset_is_complete_and_named_once() {
        let mut names = Vec::new();
        for (index, (file, text)) in FILES.iter().enumerate() {
            let preset = Preset::parse(text, file).unwrap_or_else(|error| panic!("{error}"));
            assert!(file.starts_with(&format!("{index:02}-")), "{file} is not program {index}");
            for (field, value) in [("author", &preset.author), ("comment", &preset.comment)] {
                assert!(!value.is_empty(), "{file} has no {field}");
            }
            assert!(!preset.tags.is_empty(), "{file} has no tags");
            names.push(preset.name.to_lowercase());
        }
        assert_eq!(names[0], "init");
        names.sort();
        names.dedup();
        assert_eq!(names.len(), FILES.len(), "two presets have one name");
        assert_eq!(Preset::factory().len(), FILES.len());
    }

    #[test]
    fn every_preset_file_is_embedded() {
        let directory = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/presets");
        let mut files: Vec<String> = std::fs::read_dir(directory)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter_map(|name| name.strip_suffix(".toml").map(str::to_owned))
            .collect();
        files.sort();
        assert_eq!(files, FILES.iter().map(|(name, _)| *name).collect::<Vec<_>>());
    }
}
