//! The presets and kits built into the library.

use super::factory_files::{KITS, PRESETS};
use super::{KitPreset, Playable, Preset};
use crate::error::{Error, Result, nearest};
use std::sync::OnceLock;

impl Preset {
    /// The presets built into the library, by family, after `init`.
    pub fn factory() -> &'static [Preset] {
        static FACTORY: OnceLock<Vec<Preset>> = OnceLock::new();
        FACTORY.get_or_init(|| {
            let parsed = PRESETS.iter().map(|(name, text)| Self::parse(text, name));
            parsed.collect::<Result<_>>().expect("the embedded presets are checked by a test")
        })
    }

    /// The factory preset of this name; case does not matter.
    ///
    /// # Errors
    /// [`Error::Value`] naming the nearest name if there is none.
    pub fn find(name: &str) -> Result<&'static Preset> {
        let presets = Self::factory();
        presets
            .iter()
            .find(|preset| is_named(name, &preset.name))
            .ok_or_else(|| unknown("factory preset", name, presets.iter().map(|preset| preset.name.as_str())))
    }
}

impl KitPreset {
    /// The kits built into the library.
    pub fn factory() -> &'static [KitPreset] {
        static FACTORY: OnceLock<Vec<KitPreset>> = OnceLock::new();
        let parsed = |(origin, text): &(&str, &str)| match Playable::parse(text, origin, &mut |name| {
            Preset::find(name).cloned()
        })? {
            Playable::Kit(kit) => Ok(kit),
            Playable::Preset(_) => Err(Error::format(*origin, "this is a preset: expected a kit")),
        };
        FACTORY.get_or_init(|| {
            KITS.iter().map(parsed).collect::<Result<_>>().expect("the embedded kits are checked by a test")
        })
    }
}

impl Playable {
    /// The factory preset or kit of this name; case does not matter.
    ///
    /// # Errors
    /// [`Error::Value`] naming the nearest name if there is none.
    pub fn find(name: &str) -> Result<Self> {
        let kits = KitPreset::factory();
        if let Some(kit) = kits.iter().find(|kit| is_named(name, &kit.name)) {
            return Ok(Self::Kit(kit.clone()));
        }
        let presets = Preset::factory();
        let preset = presets.iter().find(|preset| is_named(name, &preset.name)).cloned().map(Self::Preset);
        let names = presets.iter().map(|preset| preset.name.as_str()).chain(kits.iter().map(|kit| kit.name.as_str()));
        preset.ok_or_else(|| unknown("factory preset or kit", name, names))
    }
}

fn is_named(wanted: &str, name: &str) -> bool {
    name.eq_ignore_ascii_case(wanted.trim())
}

fn unknown<'a>(kind: &str, name: &str, names: impl Iterator<Item = &'a str>) -> Error {
    let hint = match nearest(name, names) {
        Some(near) => format!("; the nearest is {near}"),
        None => "; ‘sprung presets list’ shows them all".to_owned(),
    };
    Error::value("preset", format!("there is no {kind} ‘{name}’{hint}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Patch;
    use std::path::Path;

    #[test]
    fn factory_presets_and_kits_are_found_by_name() {
        assert_eq!(Preset::find("INIT").unwrap().patch, Patch::default());
        assert_eq!(Preset::find("kick").unwrap().name, "Kick");
        let error = Preset::find("kcik").unwrap_err().to_string();
        assert_eq!(error, "preset: there is no factory preset ‘kcik’; the nearest is ‘Kick’");
        assert!(Preset::find("").is_err());
        for kit in KitPreset::factory() {
            assert_eq!(Playable::find(&kit.name.to_uppercase()).unwrap(), Playable::Kit(kit.clone()));
        }
        assert!(matches!(Playable::find("kick"), Ok(Playable::Preset(_))));
        let error = Playable::find("Acoustic Kitt").unwrap_err().to_string();
        assert!(error.ends_with("the nearest is ‘Acoustic Kit’"), "{error}");
    }

    #[test]
    fn every_factory_sound_is_complete_and_named_once() {
        let mut names = Vec::new();
        for (file, text) in PRESETS {
            let preset = Preset::parse(text, file).unwrap_or_else(|error| panic!("{error}"));
            for (field, is_there) in [
                ("author", !preset.author.is_empty()),
                ("comment", !preset.comment.is_empty()),
                ("tags", !preset.tags.is_empty()),
                ("family", preset.guide.family.is_some()),
                ("macros", !preset.guide.macros.is_empty()),
                ("phrase", preset.guide.phrase.is_some()),
            ] {
                assert!(is_there || preset.name == "init", "{file} has no {field}");
            }
            let family = preset.guide.family.map_or(String::new(), |family| format!("{family}/"));
            assert_eq!(*file, format!("{family}{}", slug(&preset.name)), "a file is named like its preset");
            names.push(preset.name.to_lowercase());
        }
        assert_eq!(names[0], "init");
        for (file, kit) in KITS.iter().zip(KitPreset::factory()) {
            assert!(!kit.author.is_empty() && !kit.comment.is_empty() && !kit.tags.is_empty(), "{}", kit.name);
            assert_eq!(file.0, slug(&kit.name));
            names.push(kit.name.to_lowercase());
        }
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count, "two sounds have one name");
    }

    #[test]
    fn every_file_is_embedded() {
        let assets = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/assets"));
        for (folder, embedded) in [("presets", PRESETS), ("kits", KITS)] {
            let root = assets.join(folder);
            let mut files: Vec<String> = walkdir(&root)
                .into_iter()
                .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
                .map(|path| path.strip_prefix(&root).unwrap().with_extension("").to_str().unwrap().to_owned())
                .collect();
            let mut listed: Vec<&str> = embedded.iter().map(|(name, _)| *name).collect();
            files.sort();
            listed.sort();
            assert_eq!(files, listed);
        }
    }

    fn walkdir(folder: &Path) -> Vec<std::path::PathBuf> {
        let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        entries.flat_map(|path| if path.is_dir() { walkdir(&path) } else { vec![path] }).collect()
    }

    /// Lower case, with dashes in place of anything but letters and digits.
    fn slug(name: &str) -> String {
        let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
        words.collect::<Vec<_>>().join("-").to_ascii_lowercase()
    }
}
