//! The sounds that one can choose from: those of the factory and the user's own, by family, words and favourites.

use sprung::preset::library::Library;
use sprung::preset::{Family, KitPreset, Playable, Preset};
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Which sounds are listed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Shelf {
    #[default]
    All,
    Favourites,
    Own,
    Kits,
    Family(Family),
}

impl Shelf {
    /// All shelves in their order.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        let families = Family::ALL.iter().map(|family| Self::Family(*family));
        [Self::All, Self::Favourites, Self::Own, Self::Kits].into_iter().chain(families)
    }

    /// The name for people.
    pub(super) fn name(self) -> String {
        match self {
            Self::All => "All".to_owned(),
            Self::Favourites => "Favourites".to_owned(),
            Self::Own => "Your own".to_owned(),
            Self::Kits => "Kits".to_owned(),
            Self::Family(family) => {
                let name = family.name().replace('_', " ");
                name[..1].to_uppercase() + &name[1..]
            }
        }
    }
}

/// A sound of the list.
#[derive(Clone, Debug)]
pub(super) struct Sound {
    pub(super) playable: Playable,
    /// The file, of the user's own.
    pub(super) path: Option<PathBuf>,
    /// What words are looked for in, in lower case.
    text: String,
}

impl Sound {
    fn new(playable: Playable, path: Option<PathBuf>) -> Self {
        let (name, tags, comment) = match &playable {
            Playable::Preset(preset) => (&preset.name, &preset.tags, &preset.comment),
            Playable::Kit(kit) => (&kit.name, &kit.tags, &kit.comment),
        };
        let mut text = format!("{name} {} {comment} ", tags.join(" ")).to_lowercase();
        text += &family(&playable).map_or(String::new(), |family| family.name().replace('_', " "));
        Self { playable, path, text }
    }

    pub(super) fn name(&self) -> &str {
        self.playable.name()
    }

    pub(super) fn tags(&self) -> &[String] {
        match &self.playable {
            Playable::Preset(preset) => &preset.tags,
            Playable::Kit(kit) => &kit.tags,
        }
    }

    pub(super) fn author(&self) -> &str {
        match &self.playable {
            Playable::Preset(preset) => &preset.author,
            Playable::Kit(kit) => &kit.author,
        }
    }

    pub(super) fn comment(&self) -> &str {
        match &self.playable {
            Playable::Preset(preset) => &preset.comment,
            Playable::Kit(kit) => &kit.comment,
        }
    }
}

fn family(playable: &Playable) -> Option<Family> {
    match playable {
        Playable::Preset(preset) => preset.guide.family,
        Playable::Kit(_) => None,
    }
}

/// All sounds.
pub(super) struct Sounds {
    pub(super) library: Option<Library>,
    sounds: Vec<Sound>,
    favourites: BTreeSet<String>,
    /// Files of the user that could not be read, and why.
    pub(super) broken: Vec<String>,
}

impl Sounds {
    /// Reads the factory's sounds and the user's.
    pub(super) fn read(library: Option<Library>) -> Self {
        let presets = Preset::factory().iter().cloned().map(Playable::Preset);
        let kits = KitPreset::factory().iter().cloned().map(Playable::Kit);
        let mut sounds: Vec<Sound> = presets.chain(kits).map(|playable| Sound::new(playable, None)).collect();
        let mut broken = Vec::new();
        for entry in library.iter().flat_map(Library::entries) {
            match entry.playable {
                Ok(playable) => sounds.push(Sound::new(playable, Some(entry.path))),
                Err(error) => broken.push(error.to_string()),
            }
        }
        let favourites = library.as_ref().map(Library::favourites).transpose().unwrap_or_else(|error| {
            broken.push(error.to_string());
            None
        });
        let favourites = favourites.unwrap_or_default();
        Self { library, sounds, favourites, broken }
    }

    pub(super) fn is_favourite(&self, sound: &Sound) -> bool {
        self.favourites.contains(sound.name())
    }

    /// The sounds of a shelf that have all words: first those that have them in their names.
    pub(super) fn find<'a>(&'a self, shelf: Shelf, words: &str) -> Vec<&'a Sound> {
        let words: Vec<String> = words.split_whitespace().map(str::to_lowercase).collect();
        let is_on = |sound: &Sound| match shelf {
            Shelf::All => true,
            Shelf::Favourites => self.is_favourite(sound),
            Shelf::Own => sound.path.is_some(),
            Shelf::Kits => matches!(sound.playable, Playable::Kit(_)),
            Shelf::Family(wanted) => family(&sound.playable) == Some(wanted),
        };
        let has_words = |sound: &Sound| words.iter().all(|word| sound.text.contains(word.as_str()));
        let mut found: Vec<&Sound> = self.sounds.iter().filter(|sound| is_on(sound) && has_words(sound)).collect();
        found.sort_by_cached_key(|sound| {
            let name = sound.name().to_lowercase();
            !words.iter().all(|word| name.contains(word.as_str()))
        });
        found
    }

    /// Makes a sound a favourite, or not. Returns a message if that cannot be kept.
    pub(super) fn set_favourite(&mut self, name: &str, is_favourite: bool) -> Option<String> {
        if is_favourite {
            self.favourites.insert(name.to_owned());
        } else {
            self.favourites.remove(name);
        }
        self.library.as_ref()?.set_favourite(name, is_favourite).err().map(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sounds_are_found_by_shelf_words_and_favourites() {
        let folder = tempfile::tempdir().unwrap();
        let library = Library::at(folder.path());
        let own = Preset { name: "My Glass".to_owned(), ..Preset::find("Marimba").unwrap().clone() };
        library.save(&own, false).unwrap();
        std::fs::write(library.presets_folder().join("broken.toml"), "x").unwrap();
        let mut sounds = Sounds::read(Some(library.clone()));
        let names = |sounds: &Sounds, shelf, words: &str| -> Vec<String> {
            sounds.find(shelf, words).iter().map(|sound| sound.name().to_owned()).collect()
        };
        assert_eq!(names(&sounds, Shelf::Own, ""), ["My Glass"]);
        assert_eq!(names(&sounds, Shelf::All, "MY glass"), ["My Glass"]);
        assert!(names(&sounds, Shelf::Family(Family::Mallet), "").contains(&"Marimba".to_owned()));
        assert!(names(&sounds, Shelf::Family(Family::Kick), "marimba").is_empty());
        assert!(names(&sounds, Shelf::Kits, "").contains(&"Acoustic Kit".to_owned()));
        assert!(names(&sounds, Shelf::Favourites, "").is_empty());
        assert_eq!(sounds.set_favourite("Marimba", true), None);
        assert_eq!(names(&sounds, Shelf::Favourites, ""), ["Marimba"]);
        assert_eq!(names(&Sounds::read(Some(library)), Shelf::Favourites, ""), ["Marimba"]);
        assert_eq!(sounds.broken.len(), 1);
    }
}
