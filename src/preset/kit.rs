//! Kits as they are saved: the preset that each key plays.

use super::Preset;
use crate::params::Param;
use crate::sound::kit::KEYS;
use crate::sound::{Kit, Pad};
use std::sync::Arc;

/// The kit format version that is read and written.
pub(crate) const KIT_VERSION: i64 = 1;

/// Presets on keys, with name, author, tags, comment and details.
#[derive(Clone, Debug, PartialEq)]
pub struct KitPreset {
    /// Name; never empty.
    pub name: String,
    /// Author.
    pub author: String,
    /// Words to search for.
    pub tags: Vec<String>,
    /// Description for musicians, and how to play it.
    pub comment: String,
    /// How it is made, and where its figures come from.
    pub details: String,
    /// Maximum number of notes that sound at once.
    pub voices: u8,
    /// Values of effects behind the voices. They replace the values that the sounds have in common.
    pub params: Vec<(Param, f32)>,
    /// The presets of the pads, each with the name by which the file refers to it.
    pub sounds: Vec<(String, Preset)>,
    /// Keys from 0 to 127 with their pads, in the order of the file. Each key occurs once.
    pub pads: Vec<(u8, Pad)>,
}

/// The content of a file: a preset or a kit.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "there is one for each file that is read")]
pub enum Playable {
    /// One sound, which all keys play.
    Preset(Preset),
    /// Sounds that are assigned to keys.
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
        let kit = Kit::new(self.name.clone(), sounds, pads).with_voices(self.voices);
        Arc::new(self.params.iter().fold(kit, |kit, (param, value)| kit.with_effect(*param, *value)))
    }
}

impl Playable {
    /// The name of the preset or kit.
    pub fn name(&self) -> &str {
        match self {
            Self::Preset(preset) => &preset.name,
            Self::Kit(kit) => &kit.name,
        }
    }

    /// Who made it.
    pub fn author(&self) -> &str {
        match self {
            Self::Preset(preset) => &preset.author,
            Self::Kit(kit) => &kit.author,
        }
    }

    /// Its tags.
    pub fn tags(&self) -> &[String] {
        match self {
            Self::Preset(preset) => &preset.tags,
            Self::Kit(kit) => &kit.tags,
        }
    }

    /// Its description for musicians.
    pub fn comment(&self) -> &str {
        match self {
            Self::Preset(preset) => &preset.comment,
            Self::Kit(kit) => &kit.comment,
        }
    }

    /// How it is made, and where its figures come from; often empty.
    pub fn details(&self) -> &str {
        match self {
            Self::Preset(preset) => &preset.details,
            Self::Kit(kit) => &kit.details,
        }
    }

    /// The name of a pad: its own, or that of its sound.
    pub fn pad_name<'a>(&'a self, pad: &'a Pad) -> &'a str {
        match self {
            _ if !pad.name.is_empty() => &pad.name,
            Self::Preset(preset) => &preset.name,
            Self::Kit(kit) => kit.sounds.get(pad.sound).map_or("", |(_, preset)| &preset.name),
        }
    }

    /// The kit to play. Allocates.
    pub fn kit(&self) -> Arc<Kit> {
        match self {
            Self::Preset(preset) => preset.kit(),
            Self::Kit(kit) => kit.kit(),
        }
    }

    /// The presets in it.
    pub fn presets_mut(&mut self) -> Vec<&mut Preset> {
        match self {
            Self::Preset(preset) => vec![preset],
            Self::Kit(kit) => kit.sounds.iter_mut().map(|(_, preset)| preset).collect(),
        }
    }
}
