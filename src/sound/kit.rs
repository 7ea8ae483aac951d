//! A kit: sounds on keys.

use super::Sound;
use std::sync::Arc;

/// MIDI keys.
pub const KEYS: usize = 128;

/// What a key of a kit plays.
#[derive(Clone, Debug, PartialEq)]
pub struct Pad {
    /// What it is called, such as “Snare”; empty if it has no name.
    pub name: String,
    /// Which of [`Kit::sounds`].
    pub sound: usize,
    /// The key on whose pitch the sound is played, in semitones on the MIDI scale; none for that of the key itself.
    pub pitch: Option<f64>,
    /// Beside the sound's own gain, in decibels.
    pub gain_db: f32,
    /// Beside the sound's own, from −1 (left) to 1 (right).
    pub pan: f32,
    /// Pads of a group silence each other; 0 is none. In place of the sound's own.
    pub choke: u8,
}

/// Sounds, and the keys that play them. Immutable and shared, as [`Sound`] is: one sound is a kit of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Kit {
    name: String,
    sounds: Vec<Arc<Sound>>,
    pads: Vec<Option<Pad>>,
}

impl Kit {
    /// A kit of `sounds` with a pad, or none, for each key from 0. Pads beyond the last key and pads without a sound are
    /// left out. Allocates.
    pub fn new(name: String, sounds: Vec<Arc<Sound>>, pads: Vec<Option<Pad>>) -> Self {
        let mut pads: Vec<Option<Pad>> = pads.into_iter().take(KEYS).collect();
        pads.resize(KEYS, None);
        for pad in &mut pads {
            pad.take_if(|pad| pad.sound >= sounds.len());
        }
        Self { name, sounds, pads }
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The sounds that its pads play.
    pub fn sounds(&self) -> &[Arc<Sound>] {
        &self.sounds
    }

    /// What a key plays; nothing if it is silent. Real-time safe.
    pub fn pad(&self, key: u8) -> Option<&Pad> {
        self.pads.get(usize::from(key))?.as_ref()
    }
}
