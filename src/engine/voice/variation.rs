//! How one strike differs from the next, by chance: its place, its hardness, and the level of each mode.

use super::values::StruckValues;
use crate::dsp::random;
use crate::params::Param;
use libm::{cos, pow};
use std::f64::consts::PI;

/// The stream of a strike's variation, beside that of its noise.
const VARIATION_STREAM: u64 = 0x56_4152_5900;

/// How one strike differs. It repeats with the seed and the note's place among the notes. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Variation {
    /// How far from its place the mallet falls, as a share of the body's length; and the pluck, in per cent of it.
    mallet_place: f64,
    pub(super) pluck_place: f64,
    /// Added to the hardness, from 0 to 1.
    pub(super) hardness: f64,
    /// Most decibels by which a mode is louder or softer, and the stream of its numbers.
    modes_db: f64,
    key: u64,
}

impl Variation {
    /// Every strike is like the others.
    pub(super) const NONE: Self = Self { mallet_place: 0.0, pluck_place: 0.0, hardness: 0.0, modes_db: 0.0, key: 0 };

    /// That of the strike whose noise has a certain stream.
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

    /// The level that mode `m` has in this strike.
    pub(super) fn mode_level(&self, m: usize, level: f64) -> f64 {
        if self.modes_db == 0.0 {
            return level;
        }
        level * pow(10.0, self.modes_db * f64::from(random::uniform(self.key, m as u64)) / 20.0)
    }

    /// What the mallet gives a mode that it would give `level` at its own place. Modes fall off that place as those of a
    /// string do off a crest.
    pub(super) fn at_mallet(&self, ratio: f64, level: f64) -> f64 {
        if self.mallet_place == 0.0 { level } else { level * cos(PI * self.mallet_place * ratio) }
    }
}
