//! The presets and kits built into the library.

use super::factory_files::{KITS, PRESETS};
use super::{KitPreset, Playable, Preset};
use crate::error::{Error, Result, nearest};
use crate::text::slug;
use std::sync::OnceLock;

/// The presets read so far, in the order of [`PRESETS`]. Each is read on its first use, since reading all takes a third
/// of a second.
static FOUND: [OnceLock<Preset>; PRESETS.len()] = [const { OnceLock::new() }; PRESETS.len()];

/// The preset at this index of [`PRESETS`]. It is read on its first use.
fn preset(place: usize) -> &'static Preset {
    let (name, text) = PRESETS[place];
    FOUND[place].get_or_init(|| Preset::parse(text, name).expect("the embedded presets are checked by a test"))
}

/// Reads an embedded kit.
fn kit((origin, text): &(&str, &str)) -> Result<KitPreset> {
    match Playable::parse(text, origin, &mut |name| Preset::find(name).cloned())? {
        Playable::Kit(kit) => Ok(kit),
        Playable::Preset(_) => Err(Error::format(*origin, "this is a preset: expected a kit")),
    }
}

/// Whether a file may have this comment: it has all of it but for what TOML can escape.
fn may_have(text: &str, comment: &str) -> bool {
    comment.split(['"', '\\']).all(|part| text.contains(part))
}

/// Indices of the files that are named like the preset or kit `name`. No other file can contain it, so no other is read.
fn called<'a>(name: &str, files: &'a [(&str, &str)]) -> impl Iterator<Item = usize> + 'a {
    let slug = slug(name);
    let is_called = move |(file, _): &(&str, &str)| file.rsplit('/').next() == Some(slug.as_str());
    files.iter().enumerate().filter(move |(_, file)| is_called(file)).map(|(place, _)| place)
}

impl Preset {
    /// The presets built into the library, by family, after `init`. Reads all of them when it is first called.
    pub fn factory() -> &'static [Preset] {
        static FACTORY: OnceLock<Vec<Preset>> = OnceLock::new();
        FACTORY.get_or_init(|| (0..PRESETS.len()).map(|place| preset(place).clone()).collect())
    }

    /// The preset at a place of [`Preset::factory`]; none beyond the last. Reads only this preset, on its first use.
    pub fn factory_at(place: usize) -> Option<&'static Preset> {
        (place < PRESETS.len()).then(|| preset(place))
    }

    /// The first factory preset with this comment, unless that is empty. Reads only files that may have it.
    pub(super) fn described(comment: &str) -> Option<&'static Preset> {
        let mut files =
            PRESETS.iter().enumerate().filter(|(_, (_, text))| !comment.is_empty() && may_have(text, comment));
        files.find_map(|(place, _)| Some(preset(place)).filter(|preset| preset.comment == comment))
    }

    /// The factory preset of this name; case does not matter.
    ///
    /// # Errors
    /// [`Error::Value`] naming the nearest name if there is none.
    pub fn find(name: &str) -> Result<&'static Preset> {
        called(name, PRESETS)
            .map(preset)
            .find(|preset| is_named(name, &preset.name))
            .ok_or_else(|| unknown("factory preset", name, Self::factory().iter().map(|preset| preset.name.as_str())))
    }
}

impl KitPreset {
    /// The kits built into the library. Reads all of them when it is first called.
    pub fn factory() -> &'static [KitPreset] {
        static FACTORY: OnceLock<Vec<KitPreset>> = OnceLock::new();
        FACTORY.get_or_init(|| {
            KITS.iter().map(kit).collect::<Result<_>>().expect("the embedded kits are checked by a test")
        })
    }
}

impl Playable {
    /// The factory preset or kit of this name; case does not matter.
    ///
    /// # Errors
    /// [`Error::Value`] naming the nearest name if there is none.
    pub fn find(name: &str) -> Result<Self> {
        for place in called(name, KITS) {
            let kit = kit(&KITS[place])?;
            if is_named(name, &kit.name) {
                return Ok(Self::Kit(kit));
            }
        }
        let mut presets = called(name, PRESETS).map(preset);
        let preset = presets.find(|preset| is_named(name, &preset.name)).cloned().map(Self::Preset);
        preset.ok_or_else(|| {
            let presets = Preset::factory().iter().map(|preset| preset.name.as_str());
            unknown(
                "factory preset or kit",
                name,
                presets.chain(KitPreset::factory().iter().map(|kit| kit.name.as_str())),
            )
        })
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
        for (place, preset) in Preset::factory().iter().enumerate() {
            assert_eq!(Preset::factory_at(place), Some(preset));
            assert_eq!(Preset::described(&preset.comment).is_some(), !preset.comment.is_empty(), "{}", preset.name);
        }
        assert_eq!(Preset::factory_at(Preset::factory().len()), None);
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
                .map(|path| path.strip_prefix(&root).unwrap().with_extension("").to_str().unwrap().replace('\\', "/"))
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
}
