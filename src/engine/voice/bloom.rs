//! The bloom of a voice: its energy climbs to higher modes after a hard strike.

use crate::dsp::CONTROL_FRAMES;
use crate::dsp::cells::{Cells, Climb};
use crate::engine::controls::Controls;

/// In a bloom time, the lowest half octave at full energy passes on this many times what is missing above it. Soft mallets
/// bring much less than full energy to a gong; with this its high modes are loudest after about the bloom time.
const SPEED: f64 = 6.0;

/// The bloom of a voice. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bloom {
    /// The bank's modes are sorted into bands.
    is_sorted: bool,
    /// Stream of random numbers for the signs of modes that are woken.
    key: u64,
}

impl Bloom {
    /// That of a voice before its first note.
    pub(super) const NONE: Self = Self { is_sorted: false, key: 0 };

    /// The ratios of the modes may have changed.
    pub(super) fn forget_bands(&mut self) {
        self.is_sorted = false;
    }

    /// A strike with a stream of random numbers.
    pub(super) fn strike(&mut self, key: u64) {
        self.key = key;
    }

    /// Whether energy climbs as long as nothing changes, at an energy in units of a full strike.
    pub(super) fn acts(controls: &Controls, energy: f64) -> bool {
        // Measured energy has rounding errors of single precision.
        controls.bloom > 0.0 && energy > 0.99 * Climb::LEAST_ENERGY
    }

    /// Lets energy climb for one control tick, if the sound blooms. `full` is the energy of a full strike.
    pub(super) fn climb(&mut self, controls: &Controls, full: f64, sample_rate: f64, bank: &mut Cells) {
        if controls.bloom == 0.0 {
            return;
        }
        if !self.is_sorted {
            self.is_sorted = true;
            bank.sort_into_bands();
        }
        let speed = SPEED * CONTROL_FRAMES as f64 / (controls.bloom_time * sample_rate);
        bank.climb(&Climb { share: controls.bloom, speed, full, key: self.key });
    }
}
