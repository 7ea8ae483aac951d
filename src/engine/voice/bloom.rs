//! The bloom of a voice: its energy moves to higher modes after a hard strike.

use crate::dsp::CONTROL_FRAMES;
use crate::dsp::cells::{Cells, Climb};
use crate::engine::controls::Controls;

/// During one bloom time, the lowest half octave at full energy passes on this many times the energy that is missing above
/// it. Soft mallets give a gong much less than full energy; with this value its high modes are loudest after about the
/// bloom time.
const SPEED: f64 = 6.0;

/// The bloom of a voice. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bloom {
    /// Whether the bank's modes are sorted into bands.
    is_sorted: bool,
    /// Stream of random numbers for the signs of modes that receive their first energy.
    key: u64,
}

impl Bloom {
    /// The bloom of a voice before its first note.
    pub(super) const NONE: Self = Self { is_sorted: false, key: 0 };

    /// Marks the bands as out of date, since the ratios of the modes may have changed.
    pub(super) fn forget_bands(&mut self) {
        self.is_sorted = false;
    }

    /// Sets the stream of random numbers for a strike.
    pub(super) fn strike(&mut self, key: u64) {
        self.key = key;
    }

    /// Whether energy moves to higher modes if no event comes, at an energy in units of a full strike.
    pub(super) fn acts(controls: &Controls, energy: f64) -> bool {
        // Measured energy has rounding errors of single precision.
        controls.bloom > 0.0 && energy > 0.99 * Climb::LEAST_ENERGY
    }

    /// Moves energy to higher modes for one control tick. `full` is the energy of a full strike.
    pub(super) fn climb(&mut self, controls: &Controls, full: f64, sample_rate: f64, bank: &mut Cells) {
        if !self.is_sorted {
            self.is_sorted = true;
            bank.sort_into_bands();
        }
        let speed = SPEED * CONTROL_FRAMES as f64 / (controls.bloom_time * sample_rate);
        bank.climb(&Climb { share: controls.bloom, speed, full, key: self.key });
    }
}
