//! Microtonal tuning: a pitch for each MIDI key, read from Scala's files.
//!
//! We read the files with our own code. The crate `tune` (0.37) reads both formats, but puts a map's first entry on the
//! reference key instead of the middle one (with twelve equal steps and A4 = 440 Hz, key 69 becomes 261.6 Hz). It
//! rejects an empty description and ISO 8859-1, accepts the pitch 1/0, and gives intervals only after computing with
//! the system's logarithm, whose bits differ between machines.

mod keymap;
mod lines;
mod scale;

pub use keymap::Keymap;
pub use scale::Scale;

use crate::error::Result;
use crate::units::{key_from_frequency, ratio_from_semitones};
use std::ops::RangeInclusive;

/// Number of MIDI keys.
const KEYS: usize = 128;

/// Range of a tuning's pitches, in semitones on the MIDI scale: those of all keys, detuned by up to 128 semitones. A
/// key outside it (below 0.005 Hz, above 20 MHz) would be inaudible and counts as unmapped.
const PITCHES: RangeInclusive<f64> = -128.0..=255.0;

/// Frequency of A4 in Hz, for the check against [`PITCHES`].
const A4_HZ: f64 = 440.0;

/// The pitch that a tuning gives a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pitch {
    /// Semitones on the MIDI scale: A4 is 69, and the patch sets its frequency.
    Semitones(f64),
    /// A frequency in Hz, independent of the patch's A4.
    Hertz(f64),
}

impl Pitch {
    /// The pitch in semitones on a MIDI scale whose A4 (69) is at `a4_hz`.
    pub fn semitones(self, a4_hz: f64) -> f64 {
        match self {
            Self::Semitones(semitones) => semitones,
            Self::Hertz(frequency) => key_from_frequency(frequency, a4_hz),
        }
    }
}

/// A pitch for each of the 128 MIDI keys, or none for a key that is unmapped and therefore silent.
///
/// Plain data of a fixed size (2 KB): copying it is real-time safe. The same files give the same bits on every machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuning([Option<Pitch>; KEYS]);

impl Tuning {
    /// Twelve equal steps per octave, with the patch's A4 on key 69. It is used unless another tuning is set.
    pub const EQUAL: Self = {
        let (mut pitches, mut key) = ([None; KEYS], 0);
        while key < KEYS {
            pitches[key] = Some(Pitch::Semitones(key as f64));
            key += 1;
        }
        Self(pitches)
    };

    /// Gives a key another pitch. A key that does not exist is ignored. Real-time safe.
    pub(crate) fn set(&mut self, key: u8, pitch: Pitch) {
        if let Some(place) = self.0.get_mut(usize::from(key)) {
            *place = Some(pitch);
        }
    }

    /// The tuning of a scale with a keyboard mapping; [`Keymap::LINEAR`] if there is no file.
    pub(crate) fn new(scale: &Scale, keymap: &Keymap) -> Self {
        Self(std::array::from_fn(|key| {
            let above_reference = keymap.interval_from_reference(scale, key as u8)?;
            let (reference, frequency) = keymap.reference();
            let pitch = match frequency {
                Some(hz) => Pitch::Hertz(hz * ratio_from_semitones(above_reference)),
                None => Pitch::Semitones(f64::from(reference) + above_reference),
            };
            PITCHES.contains(&pitch.semitones(A4_HZ)).then_some(pitch)
        }))
    }

    /// The tuning of a Scala scale (`.scl`) with a keyboard mapping (`.kbm`). Without a mapping, degree 0 is on key 60,
    /// each key plays the next degree, and key 69 has the frequency that the patch gives A4.
    ///
    /// # Errors
    /// As [`Scale::parse`] and [`Keymap::parse`], with the origins `scale` and `keymap`.
    pub fn from_scala(scl: &str, kbm: Option<&str>) -> Result<Self> {
        let scale = Scale::parse(scl, "scale")?;
        let keymap = kbm.map_or(Ok(Keymap::LINEAR), |kbm| Keymap::parse(kbm, "keymap"))?;
        Ok(Self::new(&scale, &keymap))
    }

    /// The pitch of a key; none if it is unmapped or not a MIDI key. Real-time safe.
    pub fn pitch(&self, key: u8) -> Option<Pitch> {
        self.0.get(usize::from(key)).copied().flatten()
    }
}

impl Default for Tuning {
    fn default() -> Self {
        Self::EQUAL
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::frequency_from_key;

    const TWELVE: &str = "\n12\n100.\n200.\n300.\n400.\n500.\n600.\n700.\n800.\n900.\n1000.\n1100.\n2/1\n";

    #[test]
    fn twelve_equal_steps_are_the_default_to_the_bit() {
        assert_eq!(Tuning::from_scala(TWELVE, None).unwrap(), Tuning::EQUAL);
        assert_eq!(Tuning::default().pitch(69), Some(Pitch::Semitones(69.0)));
        assert_eq!(Tuning::EQUAL.pitch(128), None);
    }

    #[test]
    fn a_frequency_is_that_frequency_for_every_a4() {
        let tuning = Tuning::from_scala(TWELVE, Some("0\n0\n127\n60\n69\n432\n0")).unwrap();
        assert_eq!(tuning.pitch(69), Some(Pitch::Hertz(432.0)));
        for a4_hz in [400.0, 432.0, 440.0, 466.0] {
            let pitch = tuning.pitch(57).unwrap().semitones(a4_hz);
            assert!((frequency_from_key(pitch, a4_hz) - 216.0).abs() < 1e-9, "{a4_hz}");
        }
    }

    #[test]
    fn what_could_not_be_heard_is_unmapped() {
        let tuning = Tuning::from_scala("\n1\n10/1\n", None).unwrap();
        let mapped: Vec<u8> = (0..128).filter(|key| tuning.pitch(*key).is_some()).collect();
        // Each key is a decade above the previous one: 440 Hz, and all decades between 0.005 Hz and 20 MHz.
        assert_eq!(mapped, (65..=73).collect::<Vec<_>>());
        let digits = "9".repeat(300);
        assert!(Tuning::from_scala(&format!("\n1\n{digits}.\n"), None).unwrap().pitch(70).is_none());
    }
}
