//! The sound that the window shows, read again only when another one is loaded.

use crate::loaded::Loaded;
use crate::params::SprungParams;
use sprung::internals::library::tags_to_save;
use sprung::patch::Patch;
use sprung::preset::{Family, Guide, KitPreset, OwnTuning, Playable, Preset};
use sprung::sound::{Pad, Sound};
use std::sync::Arc;

/// The loaded preset or kit. Its parameters have the loaded values; the knobs have the present ones.
pub(crate) struct Shown {
    loaded: Arc<Loaded>,
    playable: Playable,
    guide: Guide,
    /// Number of the sound whose modes and body are shown: in a kit, that of the pad that was struck or chosen last.
    sound: usize,
}

/// What is shown of what is loaded, so that it is read again only when it is another.
#[derive(Clone)]
pub(crate) struct Subject(pub(crate) Arc<Loaded>, usize);

impl PartialEq for Subject {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) && self.1 == other.1
    }
}

impl Shown {
    pub(crate) fn new(params: &SprungParams) -> Self {
        // Read first: a sound that is loaded meanwhile is then noticed at the next refresh.
        let loaded = params.loaded();
        let mut playable = params.state().playable;
        // Tags that another body contradicts, such as its material, are not shown.
        let tags = matches!(playable, Playable::Preset(_)).then(|| tags_to_save(&playable));
        if let (Playable::Preset(preset), Some(tags)) = (&mut playable, tags) {
            preset.tags = tags;
        }
        let mut shown = Self { loaded, playable, guide: Guide::default(), sound: 0 };
        match &shown.playable {
            Playable::Preset(preset) => shown.guide = preset.guide.clone(),
            Playable::Kit(_) => {
                let first = (0..128).find(|key| shown.loaded.kit.pad(*key).is_some());
                shown.follow(first.unwrap_or(shown.guide.home));
            }
        }
        shown
    }

    /// Shows the sound of a kit's pad, if the key has one.
    pub(crate) fn follow(&mut self, key: u8) {
        if let (Playable::Kit(kit), Some(pad)) = (&self.playable, self.loaded.kit.pad(key)) {
            (self.sound, self.guide.home) = (pad.sound, key);
            if let Some((_, preset)) = kit.sounds.get(pad.sound) {
                self.guide.macros.clone_from(&preset.guide.macros);
            }
        }
    }

    /// Reads the sound again if another one was loaded.
    pub(crate) fn refresh(&mut self, params: &SprungParams) {
        if !Arc::ptr_eq(&self.loaded, &params.loaded()) {
            self.read_again(params);
        }
    }

    /// Reads the sound again: its name, author or tags may have changed.
    pub(crate) fn read_again(&mut self, params: &SprungParams) {
        let before = self.kit().map(|_| self.guide.home);
        *self = Self::new(params);
        before.into_iter().for_each(|key| self.follow(key));
    }

    /// What is shown.
    pub(crate) fn subject(&self) -> Subject {
        Subject(self.loaded.clone(), self.sound)
    }

    /// The sound with exact values, as it was loaded.
    pub(crate) fn loaded(&self) -> &Arc<Loaded> {
        &self.loaded
    }

    /// The preset; none for a kit.
    pub(crate) fn preset(&self) -> Option<&Preset> {
        match &self.playable {
            Playable::Preset(preset) => Some(preset),
            Playable::Kit(_) => None,
        }
    }

    pub(crate) fn guide(&self) -> &Guide {
        &self.guide
    }

    /// The family of the sound whose modes are shown.
    pub(crate) fn family(&self) -> Option<Family> {
        let of_kit = |kit: &KitPreset| kit.sounds.get(self.sound).and_then(|(_, preset)| preset.guide.family);
        self.kit().map_or(self.guide.family, of_kit)
    }

    /// The tags of the sound whose modes are shown.
    pub(crate) fn tags(&self) -> &[String] {
        match &self.playable {
            Playable::Preset(preset) => &preset.tags,
            Playable::Kit(kit) => kit.sounds.get(self.sound).map_or(&[], |(_, preset)| &preset.tags),
        }
    }

    /// The keys that the sound is made for, or that have a pad: one bit each.
    pub(crate) fn keys(&self) -> u128 {
        let is_meant = |key: &u8| match self.kit() {
            Some(_) => self.loaded.kit.pad(*key).is_some(),
            None => (self.guide.lowest..=self.guide.highest).contains(key),
        };
        (0..128).filter(is_meant).fold(0, |keys, key| keys | 1 << key)
    }

    /// The name of a pad: its own, or that of its sound.
    pub(crate) fn pad_name(&self, pad: &Pad) -> String {
        self.playable.pad_name(pad).to_owned()
    }

    /// The sound's own tuning; for a kit, the first one among its sounds.
    pub(crate) fn tuning(&self) -> Option<&OwnTuning> {
        match &self.playable {
            Playable::Preset(preset) => preset.tuning.as_ref(),
            Playable::Kit(kit) => kit.sounds.iter().find_map(|(_, preset)| preset.tuning.as_ref()),
        }
    }

    /// The name of the sound whose modes are shown.
    pub(crate) fn sound_name(&self) -> &str {
        self.kit().and_then(|kit| kit.sounds.get(self.sound)).map_or(self.playable.name(), |(_, preset)| &preset.name)
    }

    /// The patch; for a kit, that of the sound whose modes are shown.
    pub(crate) fn patch(&self) -> &Patch {
        self.loaded.kit.sounds()[self.sound].patch()
    }

    /// In a kit of several sounds, the one that is shown.
    pub(crate) fn one_of_several(&self) -> Option<Arc<Sound>> {
        let sounds = self.loaded.kit.sounds();
        (sounds.len() > 1).then(|| sounds[self.sound].clone())
    }

    /// The kit; none for a preset.
    pub(crate) fn kit(&self) -> Option<&KitPreset> {
        match &self.playable {
            Playable::Preset(_) => None,
            Playable::Kit(kit) => Some(kit),
        }
    }

    /// Whether the note of a key is of the sound whose modes are shown.
    pub(crate) fn shows(&self, key: u8) -> bool {
        self.loaded.kit.pad(key).is_some_and(|pad| pad.sound == self.sound)
    }

    /// Family and tags of the sound.
    pub(crate) fn words(&self) -> String {
        match &self.playable {
            Playable::Preset(preset) => {
                let family = preset.guide.family.map(|family| family.name().replace('_', " "));
                let tags = preset.tags.iter().filter(|tag| Some(*tag) != family.as_ref()).cloned();
                family.clone().into_iter().chain(tags).collect::<Vec<_>>().join("  ")
            }
            Playable::Kit(kit) => {
                let tags = kit.tags.iter().map(String::as_str).filter(|tag| *tag != "kit");
                std::iter::once("kit").chain(tags).collect::<Vec<_>>().join("  ")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::{State, VIEW};

    #[test]
    fn a_kit_shows_the_pad_that_was_chosen_last() {
        let params = SprungParams::default();
        params.load(State::new(Playable::find("Acoustic Kit").unwrap(), 0, VIEW).into());
        let mut shown = Shown::new(&params);
        let first = shown.subject();
        for key in [36, 49] {
            shown.follow(key);
            let pad = shown.loaded().kit.pad(key).unwrap().sound;
            assert_eq!(shown.patch(), shown.loaded().kit.sounds()[pad].patch());
            assert!(shown.family().is_some() && shown.keys() >> key & 1 == 1 && shown.keys() & 1 == 0);
            assert!(shown.shows(key) && shown.guide().home == key && shown.subject() != first);
        }
        shown.follow(0);
        assert_eq!(shown.guide().home, 49, "there is no pad");
        params.load(State::new(Playable::find("Brush Kit").unwrap(), 0, VIEW).into());
        shown.refresh(&params);
        assert!(shown.shows(49), "another kit shows the same pad");
        params.load(State::new(Playable::find("Marimba").unwrap(), 0, VIEW).into());
        shown.refresh(&params);
        shown.follow(36);
        assert_eq!(shown.guide().home, 60, "a preset is one sound");
    }
}
