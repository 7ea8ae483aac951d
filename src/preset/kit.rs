//! Kits as people save them: which preset each key plays.

use super::Preset;
use crate::sound::kit::KEYS;
use crate::sound::{Kit, Pad};
use std::sync::Arc;

/// The kit format that this version reads and writes.
pub const KIT_VERSION: i64 = 1;

/// Presets on keys, and what a person calls them.
#[derive(Clone, Debug, PartialEq)]
pub struct KitPreset {
    /// What it is called; never empty.
    pub name: String,
    /// Who made it.
    pub author: String,
    /// Words to search by.
    pub tags: Vec<String>,
    /// What it is and how to play it.
    pub comment: String,
    /// Most notes that sound at once.
    pub voices: u8,
    /// The presets that its pads play, each under the name that the file has for it.
    pub sounds: Vec<(String, Preset)>,
    /// Keys from 0 to 127 with what they play, in the order of the file, each once.
    pub pads: Vec<(u8, Pad)>,
}

/// What a file holds that can be played.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "there is one for each file that is read")]
pub enum Playable {
    /// One sound for all keys.
    Preset(Preset),
    /// Sounds on keys.
    Kit(KitPreset),
}

impl KitPreset {
    /// The kit to play. Allocates.
    pub fn kit(&self) -> Arc<Kit> {
        let sounds = self.sounds.iter().map(|(_, preset)| preset.sound()).collect();
        let mut pads = vec![None; KEYS];
        for (key, pad) in &self.pads {
            if let Some(place) = pads.get_mut(usize::from(*key)) {
                *place = Some(pad.clone());
            }
        }
        Arc::new(Kit::new(self.name.clone(), sounds, pads).with_voices(self.voices))
    }
}

impl Playable {
    /// What it is called.
    pub fn name(&self) -> &str {
        match self {
            Self::Preset(preset) => &preset.name,
            Self::Kit(kit) => &kit.name,
        }
    }

    /// The kit to play. Allocates.
    pub fn kit(&self) -> Arc<Kit> {
        match self {
            Self::Preset(preset) => preset.kit(),
            Self::Kit(kit) => kit.kit(),
        }
    }

    /// The presets that it plays.
    pub fn presets_mut(&mut self) -> Vec<&mut Preset> {
        match self {
            Self::Preset(preset) => vec![preset],
            Self::Kit(kit) => kit.sounds.iter_mut().map(|(_, preset)| preset).collect(),
        }
    }
}
