//! A kit: sounds on keys.

use super::tuning::Pitch;
use super::{Sound, Tuning};
use crate::params::{Param, Values};
use crate::patch::Patch;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// MIDI keys, and most sounds of a kit.
pub const KEYS: usize = 128;

/// Gains that a pad can have, in decibels.
pub const GAINS_DB: RangeInclusive<f32> = -60.0..=12.0;

/// Pitches that a pad can have, in semitones on the MIDI scale: keys, and frequencies from the subsonic to any sample
/// rate's limit.
pub const PITCHES: RangeInclusive<f64> = -60.0..=200.0;

/// Number of the last choke group.
pub const CHOKE_GROUPS: u8 = 16;

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
    /// Pads of a group silence each other; 0 is no group. None for the sound's own.
    pub choke: Option<u8>,
}

impl Pad {
    /// A pad that plays a sound by key, at its own level, position and choke group.
    pub const fn of(sound: usize) -> Self {
        Self { name: String::new(), sound, pitch: None, gain_db: 0.0, pan: 0.0, choke: None }
    }

    /// Brings numbers out of range to the nearest within, and those that are none to what they are without the pad.
    fn confine(&mut self) {
        let within = |value: f32, min: f32, max: f32| if value.is_nan() { 0.0 } else { value.clamp(min, max) };
        self.gain_db = within(self.gain_db, *GAINS_DB.start(), *GAINS_DB.end());
        self.pan = within(self.pan, -1.0, 1.0);
        self.pitch =
            self.pitch.filter(|pitch| !pitch.is_nan()).map(|pitch| pitch.clamp(*PITCHES.start(), *PITCHES.end()));
        self.choke = self.choke.map(|choke| choke.min(CHOKE_GROUPS));
    }
}

/// Sounds, and the keys that play them. Immutable and shared, as [`Sound`] is: one sound is a kit of one.
///
/// A kit of one sound plays with that sound's number of voices, play mode, choke group and limiter. A kit of several
/// always plays polyphonically, with a number of voices of its own, and asks for the limiter if any of its sounds does.
#[derive(Clone, Debug, PartialEq)]
pub struct Kit {
    name: String,
    sounds: Vec<Arc<Sound>>,
    pads: Vec<Option<Pad>>,
    values: Values,
}

impl Kit {
    /// A kit of `sounds` with a pad, or none, for each key from 0. Left out are sounds after the first [`KEYS`], pads
    /// beyond the last key, and pads without a sound. Without any sound it has the default one, on no key. Allocates.
    pub fn new(name: String, mut sounds: Vec<Arc<Sound>>, pads: Vec<Option<Pad>>) -> Self {
        sounds.truncate(KEYS);
        let mut pads: Vec<Option<Pad>> = pads.into_iter().take(KEYS).collect();
        pads.resize(KEYS, None);
        for pad in &mut pads {
            pad.take_if(|pad| pad.sound >= sounds.len());
            pad.iter_mut().for_each(Pad::confine);
        }
        if sounds.is_empty() {
            sounds.push(Arc::new(Sound::new(Patch::default())));
        }
        let values = match &sounds[..] {
            [sound] => sound.patch().values,
            several => {
                let mut values = Values::default();
                values.set(Param::Voices, Param::Voices.info().max);
                let asks = several.iter().any(|sound| sound.patch().get(Param::Limiter) != 0.0);
                values.set(Param::Limiter, f32::from(asks));
                values
            }
        };
        Self { name, sounds, pads, values }
    }

    /// The kit of one sound that every key plays at its own pitch. Allocates.
    pub fn of(sound: Arc<Sound>) -> Arc<Self> {
        Arc::new(Self::new(String::new(), vec![sound], vec![Some(Pad::of(0)); KEYS]))
    }

    /// [`Kit::of`] the sound of a patch. Allocates.
    pub fn of_patch(patch: &Patch) -> Arc<Self> {
        Self::of(Arc::new(Sound::new(patch.clone())))
    }

    /// The kit with a number of voices, 1 to 64: most notes that sound at once. A kit of one sound keeps that sound's.
    #[must_use]
    pub fn with_voices(mut self, voices: u8) -> Self {
        if !self.is_single() {
            self.values.set(Param::Voices, voices.into());
        }
        self
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The sounds that its pads play, at least one. Real-time safe.
    pub fn sounds(&self) -> &[Arc<Sound>] {
        &self.sounds
    }

    /// What a key plays; nothing if it is silent. Real-time safe.
    pub fn pad(&self, key: u8) -> Option<&Pad> {
        self.pads.get(usize::from(key))?.as_ref()
    }

    /// The pad that a key plays, its pitch, and an offset from that pitch in semitones; `tuning` is for sounds without one
    /// of their own. None for a key that is silent, because it has no pad or its pitch no frequency. Real-time safe.
    pub(crate) fn tuned_pad(&self, key: u8, tuning: &Tuning) -> Option<(&Pad, Pitch, f32)> {
        let pad = self.pad(key)?;
        let tuning = self.sounds.get(pad.sound)?.tuning().unwrap_or(tuning);
        let (key, offset) = match pad.pitch {
            None => (key, 0.0),
            Some(pitch) => {
                let nearest = libm::round(pitch).clamp(0.0, 127.0);
                (nearest as u8, (pitch - nearest) as f32)
            }
        };
        Some((pad, tuning.pitch(key)?, offset))
    }

    /// Whether it has one sound only. Real-time safe.
    pub fn is_single(&self) -> bool {
        self.sounds.len() == 1
    }

    /// The values that its parameters start with: those of a single sound, and of several the defaults, with the number
    /// of voices and the limiter of the kit. Real-time safe.
    pub fn values(&self) -> &Values {
        &self.values
    }

    /// The choke group of a pad while the parameter of the whole kit is at `group`: a single sound follows it.
    /// Real-time safe.
    pub fn choke(&self, pad: &Pad, group: f32) -> u8 {
        let of_sound = || match self.sounds.get(pad.sound) {
            Some(sound) if !self.is_single() => sound.patch().get(Param::Choke),
            _ => group,
        };
        pad.choke.unwrap_or_else(|| of_sound() as u8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sound(choke: f32) -> Arc<Sound> {
        Arc::new(Sound::new(Patch::default().with(Param::Choke, choke).with(Param::Limiter, 0.0)))
    }

    #[test]
    fn pads_without_a_sound_or_a_key_are_left_out() {
        let kit = Kit::new("a".to_owned(), vec![sound(0.0)], vec![None, Some(Pad::of(0)), Some(Pad::of(1))]);
        assert_eq!([0, 1, 2, 127, 128].map(|key| kit.pad(key).is_some()), [false, true, false, false, false]);
        let kit = Kit::new(String::new(), vec![], vec![Some(Pad::of(0)); 200]);
        assert_eq!((kit.sounds().len(), kit.pad(60)), (1, None));
        assert_eq!(Kit::new(String::new(), vec![sound(0.0); 200], vec![]).sounds().len(), KEYS);
    }

    #[test]
    fn a_single_sound_says_what_several_have_of_the_kit() {
        let single = Kit::of(sound(3.0));
        assert_eq!(single.values(), &single.sounds()[0].patch().values);
        assert_eq!(single.choke(&Pad::of(0), 7.0), 7);
        let several = Kit::new(String::new(), vec![sound(3.0), sound(4.0)], vec![]).with_voices(5);
        assert_eq!(
            [Param::Voices, Param::Limiter, Param::Mode].map(|param| several.values().get(param)),
            [5.0, 0.0, 0.0]
        );
        assert_eq!(several.choke(&Pad::of(1), 7.0), 4);
        assert_eq!(several.choke(&Pad { choke: Some(0), ..Pad::of(1) }, 7.0), 0);
    }
}
