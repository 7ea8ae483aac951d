//! A kit: sounds on keys.

use super::tuning::Pitch;
use super::{Sound, Tuning};
use crate::params::{PARAMS, Param, Values};
use crate::patch::Patch;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Number of MIDI keys, and maximum number of sounds in a kit.
pub const KEYS: usize = 128;

/// Range of a pad's gain, in decibels.
pub const GAINS_DB: RangeInclusive<f32> = -60.0..=12.0;

/// Range of a pad's pitch, in semitones on the MIDI scale: wide enough for every key and every audible frequency.
pub(crate) const PITCHES: RangeInclusive<f64> = -60.0..=200.0;

/// Number of the last choke group.
pub const CHOKE_GROUPS: u8 = 16;

/// Number of stereo outputs beside the main one.
pub const OUTPUTS: usize = 16;

/// The pad of a key: the sound that the key plays, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Pad {
    /// Name of the pad, such as “Snare”; may be empty.
    pub name: String,
    /// Index of the sound in [`Kit::sounds`].
    pub sound: usize,
    /// The pitch at which the sound is played, in semitones on the MIDI scale; none for the pitch of the pad's own key.
    pub pitch: Option<f64>,
    /// Gain in decibels, in addition to the sound's own gain.
    pub gain_db: f32,
    /// Pan from −1 (left) to 1 (right), in addition to the sound's own.
    pub pan: f32,
    /// Choke group: notes of one group silence each other; 0 is no group. None for the group of the sound.
    pub choke: Option<u8>,
    /// The stereo output that it goes to where there are several: 1 to [`OUTPUTS`], or 0 for the main one.
    pub output: u8,
}

impl Pad {
    /// A pad that plays a sound at the pitch of each key, without changes to its gain, pan and choke group.
    pub const fn of(sound: usize) -> Self {
        Self { name: String::new(), sound, pitch: None, gain_db: 0.0, pan: 0.0, choke: None, output: 0 }
    }

    /// The key whose pitch the pad has when `key` plays it, and semitones above.
    fn tuned_key(&self, key: u8) -> (u8, f32) {
        match self.pitch {
            None => (key, 0.0),
            Some(pitch) => {
                let nearest = libm::round(pitch).clamp(0.0, 127.0);
                (nearest as u8, (pitch - nearest) as f32)
            }
        }
    }

    /// Clamps values out of range. NaN becomes the neutral value: no gain, centre, the key's own pitch.
    fn confine(&mut self) {
        let within = |value: f32, min: f32, max: f32| if value.is_nan() { 0.0 } else { value.clamp(min, max) };
        self.gain_db = within(self.gain_db, *GAINS_DB.start(), *GAINS_DB.end());
        self.pan = within(self.pan, -1.0, 1.0);
        self.pitch =
            self.pitch.filter(|pitch| !pitch.is_nan()).map(|pitch| pitch.clamp(*PITCHES.start(), *PITCHES.end()));
        self.choke = self.choke.map(|choke| choke.min(CHOKE_GROUPS));
        self.output = if usize::from(self.output) > OUTPUTS { 0 } else { self.output };
    }
}

/// Sounds, and the keys that play them. Immutable and shared, as [`Sound`] is. A single sound is also a kit.
///
/// A kit of one sound has that sound's number of voices, play mode, choke group and limiter. A kit of several is always
/// polyphonic, with its own number of voices, and its limiter is on if it is on for any of the sounds.
/// The sounds share the effects after the voices: each parameter of an effect has the value that all sounds have in common,
/// or, if they differ, its default, which is off.
#[derive(Clone, Debug, PartialEq)]
pub struct Kit {
    name: String,
    sounds: Vec<Arc<Sound>>,
    pads: Vec<Option<Pad>>,
    values: Values,
}

impl Kit {
    /// A kit of `sounds`, with a pad or none for each key from 0. Ignores sounds after the first [`KEYS`], pads after
    /// the last key, and pads whose sound does not exist. If there is no sound, the kit has the default sound and no
    /// pads. Allocates.
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
                for info in PARAMS.iter().filter(|info| info.param.is_behind_voices()) {
                    let mut own = several.iter().map(|sound| sound.patch().get(info.param));
                    let first = own.next().unwrap_or(info.default);
                    values.set(info.param, if own.all(|value| value == first) { first } else { info.default });
                }
                let asks = several.iter().any(|sound| sound.patch().get(Param::Limiter) != 0.0);
                values.set(Param::Limiter, f32::from(asks));
                values
            }
        };
        Self { name, sounds, pads, values }
    }

    /// A kit of one sound, which every key plays at its own pitch. Allocates.
    pub(crate) fn of(sound: Arc<Sound>) -> Arc<Self> {
        Self::single(String::new(), sound)
    }

    /// A kit of the sound of a patch, which every key plays at its own pitch. Allocates.
    pub fn of_patch(patch: &Patch) -> Arc<Self> {
        Self::of(Arc::new(Sound::new(patch.clone())))
    }

    /// A kit of one sound with a name, which every key plays at its own pitch. Allocates.
    pub fn single(name: String, sound: Arc<Sound>) -> Arc<Self> {
        Arc::new(Self::new(name, vec![sound], vec![Some(Pad::of(0)); KEYS]))
    }

    /// The kit with a maximum number of notes at once, 1 to 64. A kit of one sound keeps the number of that sound.
    #[must_use]
    pub(crate) fn with_voices(mut self, voices: u8) -> Self {
        if !self.is_single() {
            self.values.set(Param::Voices, voices.into());
        }
        self
    }

    /// The kit with all of its pads louder by a gain in dB, within [`GAINS_DB`]. Allocates.
    #[must_use]
    pub(crate) fn with_gain(&self, gain_db: f32) -> Self {
        let mut kit = self.clone();
        for pad in kit.pads.iter_mut().flatten() {
            pad.gain_db += gain_db;
            pad.confine();
        }
        kit
    }

    /// The kit with a value for a parameter of the effects after the voices, in place of its sounds' values. Does nothing for
    /// other parameters.
    #[must_use]
    pub(crate) fn with_effect(mut self, param: Param, value: f32) -> Self {
        if param.is_behind_voices() {
            self.values.set(param, value);
        }
        self
    }

    /// The name of the kit.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The sounds of the pads, at least one. Real-time safe.
    pub fn sounds(&self) -> &[Arc<Sound>] {
        &self.sounds
    }

    /// The pad of a key; none if the key is silent. Real-time safe.
    pub fn pad(&self, key: u8) -> Option<&Pad> {
        self.pads.get(usize::from(key))?.as_ref()
    }

    /// The pad of a key, its pitch, and an offset from that pitch in semitones. `tuning` is used for sounds without a
    /// tuning of their own. None if the key is silent, because it has no pad or the tuning does not map its pitch.
    /// Real-time safe.
    pub(crate) fn tuned_pad(&self, key: u8, tuning: &Tuning) -> Option<(&Pad, Pitch, f32)> {
        let pad = self.pad(key)?;
        let tuning = self.sounds.get(pad.sound)?.tuning().unwrap_or(tuning);
        let (key, offset) = pad.tuned_key(key);
        Some((pad, tuning.pitch(key)?, offset))
    }

    /// Whether a key has the pitch of the key `tuned` in the tuning of its channel. Real-time safe.
    pub(crate) fn follows(&self, key: u8, tuned: u8) -> bool {
        self.pad(key).is_some_and(|pad| {
            let is_fixed = self.sounds.get(pad.sound).is_none_or(|sound| sound.tuning().is_some());
            !is_fixed && pad.tuned_key(key).0 == tuned
        })
    }

    /// Whether the kit has only one sound. Real-time safe.
    pub(crate) fn is_single(&self) -> bool {
        self.sounds.len() == 1
    }

    /// The initial values of the kit's parameters: those of a single sound; for several, the defaults with the kit's
    /// number of voices, limiter and effects. Real-time safe.
    pub fn values(&self) -> &Values {
        &self.values
    }

    /// The choke group of a pad. `group` is the value of the kit's parameter, which applies to a kit of one sound only.
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
