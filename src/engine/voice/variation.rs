//! Random differences between strikes: the point of the strike, the hardness, and the level of each mode.

use super::values::StruckValues;
use crate::dsp::mode_bank::MAX_MODES;
use crate::dsp::random;
use crate::dsp::series::{powers, sines};
use crate::params::Param;
use std::f64::consts::LOG2_10;

/// Number of the variation's stream. It differs from the stream of the strike's noise.
const VARIATION_STREAM: u64 = 0x56_4152_5900;

/// The random differences of one strike. The same seed and note serial number give the same. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Variation {
    /// Offset of the mallet from its place, as a fraction of the body's length; and that of the pluck, in per cent of it.
    mallet_place: f64,
    pub(super) pluck_place: f64,
    /// Offset of the hardness, which is 0–1.
    pub(super) hardness: f64,
    /// Largest change of a mode's level in decibels, and the stream of its random numbers.
    modes_db: f64,
    key: u64,
}

impl Variation {
    /// No variation.
    pub(super) const NONE: Self = Self { mallet_place: 0.0, pluck_place: 0.0, hardness: 0.0, modes_db: 0.0, key: 0 };

    /// The variation of a strike whose noise has the stream `noise_key`.
    pub(super) fn new(values: &StruckValues, noise_key: u64) -> Self {
        let key = random::key(noise_key, VARIATION_STREAM);
        let number = |n: u64| f64::from(random::uniform(key, n));
        let place = values.get(Param::VaryPosition);
        Self {
            mallet_place: place * 0.01 * number(0),
            pluck_place: place * number(1),
            hardness: values.share(Param::VaryHardness) * number(2),
            modes_db: values.get(Param::VaryModes),
            key: random::key(key, 0),
        }
    }

    /// Moves the place of the mallet by a share of the body's length.
    pub(super) fn move_mallet(&mut self, by: f64) {
        self.mallet_place += by;
    }

    /// Changes the levels of the modes from mode `first` on to those of this strike.
    pub(super) fn vary(&self, first: usize, levels: &mut [f64; MAX_MODES]) {
        if self.modes_db == 0.0 {
            return;
        }
        let numbers: [f64; MAX_MODES] =
            std::array::from_fn(|m| f64::from(random::uniform(self.key, (first + m) as u64)));
        let mut gains = [0.0; MAX_MODES];
        powers(&numbers, self.modes_db * LOG2_10 / 20.0, &mut gains);
        levels.iter_mut().zip(gains).for_each(|(level, gain)| *level *= gain);
    }

    /// The factors by which the mallet's offset changes the levels of modes of these ratios; 1 without the offset. They fall
    /// with the cosine, as the mode shape of a string does around its maximum.
    pub(super) fn at_mallet(&self, ratios: &[f64; MAX_MODES]) -> [f64; MAX_MODES] {
        let mut factors = [1.0; MAX_MODES];
        if self.mallet_place != 0.0 {
            sines(ratios, self.mallet_place, 0.5, &mut factors);
        }
        factors
    }
}
