//! The catalogue of sounds: those of the factory and the user's own.

use super::library::Library;
pub use super::moods::MOODS;
use super::moods::moods;
pub use super::traits::tagged_material;
use super::traits::{traits, true_tags};
use super::{Family, KitPreset, Playable, Preset};
use crate::error::{Error, LEAST_SIMILARITY, similarity};
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

/// Words that people search for, and those that our sounds have for the same. Makers' names stand for the kind of instrument.
const OTHER_WORDS: &[(&str, &str)] = &[
    ("rhodes", "electric piano"),
    ("wurlitzer", "electric piano"),
    ("wurli", "electric piano"),
    ("epiano", "electric piano"),
    ("e-piano", "electric piano"),
    ("dx7", "electric piano 2"),
    ("hammond", "organ"),
    ("b3", "organ"),
    ("farfisa", "organ"),
    ("vibes", "vibraphone"),
    ("glock", "glockenspiel"),
    ("handpan", "steel tongue"),
    ("hang", "steel tongue"),
    ("steelpan", "steel drum"),
    ("mbira", "kalimba"),
    ("cymbalom", "dulcimer"),
    ("cimbalom", "dulcimer"),
    ("ukulele", "nylon guitar"),
    ("double-bass", "contrabass"),
    ("saxophone", "sax"),
    ("hihat", "hat"),
    ("hi-hat", "hat"),
    ("bassdrum", "kick"),
    ("bd", "kick"),
    ("sd", "snare"),
    ("hh", "hat"),
    ("rimshot", "rim"),
    ("808", "electronic"),
    ("909", "electronic"),
    ("vox", "voice"),
];

/// A sound of a catalogue.
#[derive(Debug)]
pub struct Listed {
    /// The preset or kit.
    pub playable: Playable,
    /// Its file, if it is one of the user's own.
    pub path: Option<PathBuf>,
    /// Its tags, and those that follow from its knobs.
    tags: Vec<String>,
    /// See [`Listed::moods`].
    moods: OnceLock<Vec<&'static str>>,
    /// The text in which words are searched, in lower case.
    text: String,
}

/// Sounds in the order in which lists show them. They are shared, since user interfaces fetch some of them many times a
/// second.
#[derive(Debug, Default)]
pub struct Catalogue {
    /// The sounds.
    pub sounds: Vec<Arc<Listed>>,
    /// Files of the user that could not be read, and why.
    pub broken: Vec<Error>,
}

impl Listed {
    fn new(playable: Playable, path: Option<PathBuf>) -> Self {
        let tags = tags_of(&playable);
        let words = [playable.name(), playable.comment(), playable.details(), &tags.join(" ")].join(" ");
        let mut listed = Self { playable, path, tags, moods: OnceLock::new(), text: words.to_lowercase() };
        listed.text = format!("{} {}", listed.text, listed.family_name().replace('_', " "));
        listed
    }

    /// Its name.
    pub fn name(&self) -> &str {
        self.playable.name()
    }

    /// Its tags: those of its file, and for a preset what moves its body (`struck`, `pluck`, `bow`, `breath`, `noise`) and how long it
    /// sounds (`short`, `ringing`, `long`, or `sustained` while a key is held).
    pub fn tags(&self) -> &[String] {
        &self.tags
    }

    /// Those of [`MOODS`] that a preset has by its knobs, computed when they are first asked for. Only lists that show moods have them:
    /// they are no tags in files, and no words that are searched.
    pub fn moods(&self) -> &[&'static str] {
        self.moods.get_or_init(|| match &self.playable {
            Playable::Preset(preset) => moods(preset),
            Playable::Kit(_) => Vec::new(),
        })
    }

    /// Whether it has this tag. Case does not matter.
    pub fn has_tag(&self, tag: &str) -> bool {
        self.tags.iter().any(|own| own.to_lowercase() == tag.trim().to_lowercase())
    }

    /// Its family; none for a kit, and for a preset whose file names none.
    pub fn family(&self) -> Option<Family> {
        match &self.playable {
            Playable::Preset(preset) => preset.guide.family,
            Playable::Kit(_) => None,
        }
    }

    /// The name of its family: `kit` for a kit, empty for none.
    pub fn family_name(&self) -> &'static str {
        match &self.playable {
            Playable::Preset(_) => self.family().map_or("", Family::name),
            Playable::Kit(_) => Self::KIT,
        }
    }

    /// The family name of kits.
    pub const KIT: &str = "kit";

    /// Whether all of these words, or what they stand for, are in its name, tags, family or description. Case does not matter.
    pub fn has_words(&self, words: &str) -> bool {
        words.to_lowercase().split_whitespace().all(|word| self.text.contains(word) || self.is_meant_by(word))
    }

    /// Whether its name, its tags or its family have what a word in lower case stands for.
    fn is_meant_by(&self, word: &str) -> bool {
        let named = [self.name(), &self.tags.join(" "), self.family_name()].join(" ").to_lowercase();
        let has = |word: &str| named.split_whitespace().any(|own| own == word);
        OTHER_WORDS.iter().any(|(own, words)| *own == word && words.split(' ').all(has))
    }
}

/// The tags of a sound, as [`Listed::tags`] has them.
pub fn tags_of(playable: &Playable) -> Vec<String> {
    let mut tags = playable.tags().to_vec();
    if let Playable::Preset(preset) = playable {
        let is_new = |tag: &&str| !playable.tags().iter().any(|own| own.eq_ignore_ascii_case(tag));
        tags.extend(traits(preset).into_iter().filter(is_new).map(str::to_owned));
    }
    tags
}

/// The tags to save a sound with: its own, as far as they are still true of a preset.
pub fn tags_to_save(playable: &Playable) -> Vec<String> {
    match playable {
        Playable::Preset(preset) => origin(preset).map_or(preset.tags.clone(), |other| true_tags(preset, other)),
        Playable::Kit(kit) => kit.tags.clone(),
    }
}

/// The factory preset whose description a preset still has, although it is another sound now.
fn origin(preset: &Preset) -> Option<&'static Preset> {
    let of = Preset::described(&preset.comment)?;
    (of.patch != preset.patch || of.tuning != preset.tuning).then_some(of)
}

/// The name of the factory sound whose description a sound still has, although it is another sound now.
pub fn made_from(playable: &Playable) -> Option<&'static str> {
    match playable {
        Playable::Preset(preset) => origin(preset).map(|of| of.name.as_str()),
        Playable::Kit(kit) => {
            let is_same = |other: &&KitPreset| !other.comment.is_empty() && other.comment == kit.comment;
            let of = KitPreset::factory().iter().find(is_same)?;
            let is_same = of.sounds == kit.sounds && of.pads == kit.pads && of.params == kit.params;
            (!is_same).then_some(&of.name)
        }
    }
}

impl Catalogue {
    /// The presets of the factory, then its kits.
    pub fn of_factory() -> Self {
        let presets = Preset::factory().iter().cloned().map(Playable::Preset);
        let kits = KitPreset::factory().iter().cloned().map(Playable::Kit);
        let sounds = presets.chain(kits).map(|playable| Arc::new(Listed::new(playable, None))).collect();
        Self { sounds, broken: Vec::new() }
    }

    /// The sounds of a library, in the order of their files' names. Reads files.
    pub fn of_library(library: &Library) -> Self {
        let mut catalogue = Self::default();
        for entry in library.entries() {
            match entry.playable {
                Ok(playable) => catalogue.sounds.push(Arc::new(Listed::new(playable, Some(entry.path)))),
                Err(error) => catalogue.broken.push(error),
            }
        }
        catalogue
    }

    /// The sounds of the factory, then those of a library. Reads files.
    pub fn read(library: Option<&Library>) -> Self {
        let mut all = Self::of_factory();
        let own = library.map(Self::of_library).unwrap_or_default();
        all.sounds.extend(own.sounds);
        Self { broken: own.broken, ..all }
    }

    /// The sounds with all of these words, by [`Listed::has_words`]: first the sound with exactly this name, then those
    /// with all words in their name, then the others.
    pub fn find(&self, words: &str) -> Vec<Arc<Listed>> {
        let mut found: Vec<_> = self.sounds.iter().filter(|listed| listed.has_words(words)).cloned().collect();
        let lower = words.to_lowercase();
        found.sort_by_cached_key(|listed| {
            let name = listed.name().to_lowercase();
            let is_named = |word: &str| name.contains(word) || listed.is_meant_by(word);
            (name != lower.trim(), !lower.split_whitespace().all(is_named))
        });
        found
    }

    /// The sounds that have some of these words, or a name that may be meant, the nearest first: those with the most of the words, and
    /// of these the names that differ the least.
    pub fn nearest(&self, words: &str) -> Vec<Arc<Listed>> {
        let words = words.trim().to_lowercase();
        let count = words.split_whitespace().count();
        let rank = |listed: &Arc<Listed>| {
            let missing = words.split_whitespace().filter(|word| !listed.has_words(word)).count();
            let likeness = similarity(&words, listed.name());
            (missing < count || likeness > LEAST_SIMILARITY).then_some((missing, ((1.0 - likeness) * 1e6) as u32))
        };
        let mut near: Vec<_> = self.sounds.iter().filter_map(|sound| Some((rank(sound)?, sound))).collect();
        near.sort_by_key(|(rank, _)| *rank);
        near.into_iter().map(|(_, sound)| sound.clone()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Param;
    use crate::preset::body::modes_of_body;
    use crate::sound::bodies::{Body, MATERIALS, Model};

    #[test]
    fn sounds_of_the_factory_and_the_user_are_found_by_words() {
        let folder = tempfile::tempdir().unwrap();
        let library = Library::at(folder.path());
        let own = Preset { name: "My Glass".to_owned(), ..Preset::find("Marimba").unwrap().clone() };
        let path = library.save(&Playable::Preset(own), false).unwrap();
        std::fs::write(library.presets_folder().join("broken.toml"), "x").unwrap();
        let all = Catalogue::read(Some(&library));
        assert_eq!((all.sounds.len(), all.broken.len()), (Catalogue::of_factory().sounds.len() + 1, 1));
        let found =
            |words: &str| -> Vec<String> { all.find(words).iter().map(|listed| listed.name().to_owned()).collect() };
        assert_eq!(found("MY glass"), ["My Glass"]);
        assert_eq!(found("kick")[0], "Kick", "the one of just this name comes first");
        let kicks = found("kick");
        let named = kicks.iter().take_while(|name| name.to_lowercase().contains("kick")).count();
        assert!(kicks[named..].iter().all(|name| !name.to_lowercase().contains("kick")), "{kicks:?}");
        assert!(found("hand drum").contains(&"Conga".to_owned()), "by its family");
        assert!(found("kit acoustic").contains(&"Acoustic Kit".to_owned()));
        assert!(found("no such sound").is_empty());
        for (word, words) in OTHER_WORDS {
            assert!(!all.find(words).is_empty(), "{word}");
            assert!(all.find(word)[0].is_meant_by(word), "{word}");
        }
        assert!(found("hihat").len() < 20, "not each sound that has the letters in a description");
        assert!(found("rhodes").contains(&"Electric Piano 1".to_owned()));
        assert!(all.nearest("qwzx").is_empty() && all.nearest("rhodos").is_empty(), "nothing is like it");
        let nearest = |words: &str| all.nearest(words)[0].name().to_owned();
        assert_eq!(["marimab", "acoustc kit"].map(nearest), ["Marimba", "Acoustic Kit"]);
        assert!(nearest("no such marimba").ends_with("Marimba"), "it has one of the words");
        let tags = |name: &str| tags_of(&Playable::Preset(Preset::find(name).unwrap().clone())).join(" ");
        assert_eq!(tags("Marimba"), "mallet wood struck ringing");
        for (name, tag) in
            [("Side Stick", "short"), ("Church Bell", "long"), ("Violin", "bow"), ("Clarinet", "sustained")]
        {
            assert!(tags(name).contains(tag), "{name}: {}", tags(name));
        }
        let marimba = Preset::find("Marimba").unwrap();
        let made = |preset: &Preset| {
            let playable = Playable::Preset(preset.clone());
            (made_from(&playable), tags_to_save(&playable).join(" "))
        };
        assert_eq!(made(marimba), (None, "mallet wood".to_owned()));
        let model = Model::find("marimba").unwrap().clone();
        let mut glass = Preset { name: "Mine".to_owned(), ..marimba.clone() };
        let material = *MATERIALS.iter().find(|material| material.id == "glass").unwrap();
        glass.patch.modes = modes_of_body(&Body { material, ..Body::new(model) });
        assert_eq!(made(&glass), (Some("Marimba"), "mallet glass".to_owned()));
        let mut plucked = Preset::find("Bowed Glass").unwrap().clone();
        plucked.patch.set(Param::BowLevel, Param::BowLevel.info().min);
        assert!(!made(&plucked).1.contains("bow"), "{:?}", made(&plucked));
        let own = all.sounds.last().unwrap();
        assert_eq!((own.path.as_ref(), own.family_name()), (Some(&path), "mallet"));
    }
}
