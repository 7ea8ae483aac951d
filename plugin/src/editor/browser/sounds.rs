//! The sounds to choose from: the factory's and the user's own, by family, words and favourites.

use sprung::preset::catalogue::{Catalogue, Listed};
use sprung::preset::library::Library;
use sprung::preset::{Family, Playable};
use sprung_picture::{Figure, small_figure};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;

/// A category of sounds in the browser.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::editor) enum Category {
    #[default]
    All,
    Favourites,
    Own,
    Kits,
    /// Those that were found to be like one.
    Like,
    Family(Family),
}

impl Category {
    /// All categories in their order.
    pub(in crate::editor) fn all() -> impl Iterator<Item = Self> {
        let families = Family::ALL.iter().map(|family| Self::Family(*family));
        [Self::All, Self::Favourites, Self::Own, Self::Kits].into_iter().chain(families)
    }

    /// The name as shown to the user.
    pub(in crate::editor) fn name(self) -> String {
        match self {
            Self::All => "All".to_owned(),
            Self::Favourites => "Favourites".to_owned(),
            Self::Own => "Your own".to_owned(),
            Self::Kits => "Kits".to_owned(),
            Self::Like => "Like another".to_owned(),
            Self::Family(family) => {
                let name = family.name().replace('_', " ");
                name[..1].to_uppercase() + &name[1..]
            }
        }
    }
}

/// What tells a preset of the catalogue from others: its name, and the file of one of the user's.
pub(in crate::editor) type Place = (String, Option<PathBuf>);

/// The place of a preset; none for a kit.
pub(in crate::editor) fn place(sound: &Listed) -> Option<Place> {
    matches!(sound.playable, Playable::Preset(_)).then(|| (sound.name().to_owned(), sound.path.clone()))
}

/// All sounds.
pub(in crate::editor) struct Sounds {
    pub(in crate::editor) library: Option<Library>,
    catalogue: Catalogue,
    favourites: BTreeSet<String>,
    /// The bodies of presets, by their places in memory.
    figures: BTreeMap<usize, Figure>,
    /// Files of the user that could not be read, and why.
    pub(in crate::editor) broken: Vec<String>,
}

impl Sounds {
    /// Reads the factory's sounds and the user's.
    pub(in crate::editor) fn read(library: Option<Library>) -> Self {
        let catalogue = Catalogue::read(library.as_ref());
        let mut broken: Vec<String> = catalogue.broken.iter().map(ToString::to_string).collect();
        let favourites = library.as_ref().map(Library::favourites).transpose().unwrap_or_else(|error| {
            broken.push(error.to_string());
            None
        });
        let favourites = favourites.unwrap_or_default();
        let figure = |sound: &Arc<Listed>| match &sound.playable {
            Playable::Preset(preset) => {
                Some((Arc::as_ptr(sound).addr(), small_figure(&preset.patch.modes, preset.guide.family)))
            }
            Playable::Kit(_) => None,
        };
        let figures = catalogue.sounds.iter().filter_map(figure).collect();
        Self { library, catalogue, favourites, figures, broken }
    }

    /// The picture of a preset's body; none for a kit.
    pub(in crate::editor) fn figure(&self, sound: &Arc<Listed>) -> Option<&Figure> {
        self.figures.get(&Arc::as_ptr(sound).addr())
    }

    pub(in crate::editor) fn is_favourite(&self, sound: &Listed) -> bool {
        self.favourites.contains(sound.name())
    }

    /// All sounds.
    pub(in crate::editor) fn all(&self) -> impl Iterator<Item = &Arc<Listed>> {
        self.catalogue.sounds.iter()
    }

    /// The sounds of a category that contain all words; those with the words in their names come first, and those in `like` in the
    /// order of these.
    pub(in crate::editor) fn find(&self, category: Category, words: &str, like: &[Place]) -> Vec<Arc<Listed>> {
        let rank = |sound: &Listed| {
            let own = place(sound)?;
            like.iter().position(|place| *place == own)
        };
        let is_on = |sound: &Listed| match category {
            Category::All => true,
            Category::Favourites => self.is_favourite(sound),
            Category::Own => sound.path.is_some(),
            Category::Kits => matches!(sound.playable, Playable::Kit(_)),
            Category::Like => rank(sound).is_some(),
            Category::Family(wanted) => sound.family() == Some(wanted),
        };
        let mut found = self.catalogue.find(words);
        found.retain(|sound| is_on(sound));
        if category == Category::Like {
            found.sort_by_key(|sound| rank(sound));
        }
        found
    }

    /// Adds a sound to the favourites or removes it. Returns a message if this cannot be stored.
    pub(in crate::editor) fn set_favourite(&mut self, name: &str, is_favourite: bool) -> Option<String> {
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
    use sprung::preset::Preset;

    #[test]
    fn sounds_are_found_by_category_words_and_favourites() {
        let folder = tempfile::tempdir().unwrap();
        let library = Library::at(folder.path());
        let own = Preset { name: "My Glass".to_owned(), ..Preset::find("Marimba").unwrap().clone() };
        library.save(&Playable::Preset(own), false).unwrap();
        std::fs::write(library.presets_folder().join("broken.toml"), "x").unwrap();
        let mut sounds = Sounds::read(Some(library.clone()));
        let names = |sounds: &Sounds, category, words: &str| -> Vec<String> {
            sounds
                .find(category, words, &["Kick", "Marimba"].map(|name| (name.to_owned(), None)))
                .iter()
                .map(|sound| sound.name().to_owned())
                .collect()
        };
        assert_eq!(names(&sounds, Category::Own, ""), ["My Glass"]);
        assert_eq!(names(&sounds, Category::All, "MY glass"), ["My Glass"]);
        assert!(names(&sounds, Category::Family(Family::Mallet), "").contains(&"Marimba".to_owned()));
        assert!(names(&sounds, Category::Family(Family::Kick), "marimba").is_empty());
        assert!(names(&sounds, Category::Kits, "").contains(&"Acoustic Kit".to_owned()));
        assert_eq!(names(&sounds, Category::Like, ""), ["Kick", "Marimba"]);
        assert!(names(&sounds, Category::Favourites, "").is_empty());
        assert_eq!(sounds.set_favourite("Marimba", true), None);
        assert_eq!(names(&sounds, Category::Favourites, ""), ["Marimba"]);
        assert_eq!(names(&Sounds::read(Some(library)), Category::Favourites, ""), ["Marimba"]);
        assert_eq!(sounds.broken.len(), 1);
    }
}
