//! The sounds to choose from: the factory's and the user's own, by family, words and favourites.

use sprung::internals::library::{Catalogue, Library, Listed};
use sprung::internals::text::counted;
use sprung::preset::{Family, Playable, Preset};
use sprung_picture::{Figure, small_figure};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::Arc;

/// How many sounds are shown in place of none.
const NEAREST: usize = 3;
/// What is said above them, and where nothing is near.
const NEAR: &str = "No sound has all of this. The nearest:";
const NOTHING: &str = "No sound is like this: try a family, or another word.";

/// A category of sounds in the browser.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::editor) enum Category {
    #[default]
    All,
    Favourites,
    Recent,
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
        [Self::All, Self::Favourites, Self::Recent, Self::Own, Self::Kits].into_iter().chain(families)
    }

    /// The name as shown to the user.
    pub(in crate::editor) fn name(self) -> String {
        match self {
            Self::All => "All".to_owned(),
            Self::Favourites => "Favourites".to_owned(),
            Self::Recent => "Recent".to_owned(),
            Self::Own => "Your own".to_owned(),
            Self::Kits => "Kits".to_owned(),
            Self::Like => "Like another".to_owned(),
            Self::Family(family) => {
                let name = family.name().replace('_', " ");
                name[..1].to_uppercase() + &name[1..]
            }
        }
    }

    /// So many of its sounds, in words: by their name, if they have one of which there can be several.
    pub(super) fn counted(self, count: usize) -> String {
        use Family::{Bell, Cymbal, Drone, Effect, HandDrum, Hat, Kick, Lead, Mallet, Pad, Snare, Tom};
        let noun = match self {
            Self::Kits => "kit".to_owned(),
            Self::Family(
                family @ (Kick | Snare | Tom | Hat | Cymbal | HandDrum | Mallet | Bell | Lead | Pad | Drone | Effect),
            ) => family.name().replace('_', " "),
            _ => "sound".to_owned(),
        };
        counted(count, &noun)
    }

    /// What fills it; for those that are never empty, nothing.
    pub(in crate::editor) fn invitation(self) -> &'static str {
        match self {
            Self::Favourites => "None yet: a click on a sound’s star keeps it here.",
            Self::Recent => "None yet: the sounds that you load will be here, the last one first.",
            Self::Own => "None yet: Save keeps the present sound here, Import brings in files.",
            _ => "",
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
    /// The names of the sounds that were chosen last, the newest first.
    recent: Vec<String>,
    /// The bodies of sounds, by their places in memory.
    figures: BTreeMap<usize, Figure>,
    /// Sounds by their distance to the words for which they were last ranked.
    ranked: RefCell<Option<(String, Vec<Arc<Listed>>)>>,
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
        let figure = |sound: &Arc<Listed>| {
            // A kit is drawn as its first drum.
            let is_drum =
                |preset: &&Preset| matches!(preset.guide.family, Some(Family::Kick | Family::Snare | Family::Tom));
            let preset = match &sound.playable {
                Playable::Preset(preset) => preset,
                Playable::Kit(kit) => {
                    let mut presets = kit.sounds.iter().map(|(_, preset)| preset);
                    presets.clone().find(is_drum).or(presets.next())?
                }
            };
            Some((Arc::as_ptr(sound).addr(), small_figure(&preset.patch.modes, preset.guide.family, &preset.tags)))
        };
        let figures = catalogue.sounds.iter().filter_map(figure).collect();
        let mut sounds =
            Self { library, catalogue, favourites, recent: Vec::new(), figures, ranked: RefCell::default(), broken };
        sounds.read_recent();
        sounds
    }

    /// Reads again which sounds were chosen last. A list that cannot be read is told where it is written.
    pub(in crate::editor) fn read_recent(&mut self) {
        self.recent = self.library.as_ref().and_then(|library| library.recent().ok()).unwrap_or_default();
    }

    /// The picture of its body, of a kit that of its first sound; none for a kit without sounds.
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

    /// The sounds of a category that contain all words; those with the words in their names come first, recent ones in the order in
    /// which they were chosen, and those in `like` in the order of these.
    pub(in crate::editor) fn find(&self, category: Category, words: &str, like: &[Place]) -> Vec<Arc<Listed>> {
        let rank = |sound: &Listed| match category {
            Category::Recent => self.recent.iter().position(|name| name == sound.name()),
            Category::Like => place(sound).and_then(|own| like.iter().position(|place| *place == own)),
            _ => None,
        };
        let is_on = |sound: &Listed| match category {
            Category::All => true,
            Category::Favourites => self.is_favourite(sound),
            Category::Own => sound.path.is_some(),
            Category::Kits => matches!(sound.playable, Playable::Kit(_)),
            Category::Recent | Category::Like => rank(sound).is_some(),
            Category::Family(wanted) => sound.family() == Some(wanted),
        };
        let mut found = self.catalogue.find(words);
        found.retain(|sound| is_on(sound));
        found.sort_by_key(|sound| rank(sound));
        found
    }

    /// Up to three sounds that are nearest to some words, among those that are wanted, and what is said above them.
    pub(in crate::editor) fn nearest(
        &self,
        words: &str,
        is_wanted: impl Fn(&Listed) -> bool,
    ) -> (Vec<Arc<Listed>>, &'static str) {
        let mut ranked = self.ranked.borrow_mut();
        if ranked.as_ref().is_none_or(|(known, _)| known != words) {
            *ranked = Some((words.to_owned(), self.catalogue.nearest(words)));
        }
        let all = ranked.iter().flat_map(|(_, sounds)| sounds);
        let near: Vec<_> = all.filter(|sound| is_wanted(sound)).take(NEAREST).cloned().collect();
        let says = if near.is_empty() { NOTHING } else { NEAR };
        (near, says)
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
        for name in ["Marimba", "My Glass", "Gone", "Kick"] {
            library.note_recent(name).unwrap();
        }
        sounds.read_recent();
        assert_eq!(names(&sounds, Category::Recent, ""), ["Kick", "My Glass", "Marimba"]);
        assert!(names(&sounds, Category::Favourites, "").is_empty());
        assert_eq!(sounds.set_favourite("Marimba", true), None);
        assert_eq!(names(&sounds, Category::Favourites, ""), ["Marimba"]);
        assert_eq!(names(&Sounds::read(Some(library)), Category::Favourites, ""), ["Marimba"]);
        assert_eq!(sounds.broken.len(), 1);
    }
}
