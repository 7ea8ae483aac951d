//! The sound that the window shows, read again only when another one is loaded.

use crate::loaded::Loaded;
use crate::params::SprungParams;
use sprung::patch::Patch;
use sprung::preset::{Guide, OwnTuning, Playable, Preset};
use sprung::sound::Pad;
use std::sync::Arc;

/// The loaded preset or kit. Its parameters have the loaded values; the knobs have the present ones.
pub(crate) struct Shown {
    loaded: Arc<Loaded>,
    playable: Playable,
    guide: Guide,
}

impl Shown {
    pub(crate) fn new(params: &SprungParams) -> Self {
        // Read first: a sound that is loaded meanwhile is then noticed at the next refresh.
        let loaded = params.loaded();
        let playable = params.state().playable;
        let guide = match &playable {
            Playable::Preset(preset) => preset.guide.clone(),
            // The key of the sound whose modes and body are shown.
            Playable::Kit(_) => {
                let shows = |key: &u8| loaded.kit.pad(*key).is_some_and(|pad| pad.sound == 0);
                let guide = Guide::default();
                Guide { home: (0..128).find(shows).unwrap_or(guide.home), ..guide }
            }
        };
        Self { loaded, playable, guide }
    }

    /// Reads the sound again if another one was loaded.
    pub(crate) fn refresh(&mut self, params: &SprungParams) {
        if !Arc::ptr_eq(&self.loaded, &params.loaded()) {
            *self = Self::new(params);
        }
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

    /// The patch; for a kit, that of its first sound.
    pub(crate) fn patch(&self) -> &Patch {
        self.loaded.kit.sounds()[0].patch()
    }

    /// Whether the note of a key is of the sound whose modes are shown.
    pub(crate) fn shows(&self, key: u8) -> bool {
        self.loaded.kit.pad(key).is_some_and(|pad| pad.sound == 0)
    }

    /// Family and tags of the sound.
    pub(crate) fn words(&self) -> String {
        match &self.playable {
            Playable::Preset(preset) => {
                let family = preset.guide.family.map(|family| family.name().replace('_', " "));
                let tags = preset.tags.iter().filter(|tag| Some(*tag) != family.as_ref()).cloned();
                family.clone().into_iter().chain(tags).collect::<Vec<_>>().join("  ")
            }
            Playable::Kit(kit) => format!("kit  {}", kit.tags.join("  ")),
        }
    }
}
