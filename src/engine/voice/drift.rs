//! Modes that wander by themselves, each in level and in pitch.

use crate::dsp::mode_bank::MAX_MODES;
use crate::dsp::random;
use crate::dsp::series::powers;
use crate::dsp::wander::wander;
use crate::engine::controls::Controls;
use std::f64::consts::LOG2_10;

/// Number of the stream. It differs from those of the strike.
const DRIFT_STREAM: u64 = 0x44_5246_5400;

/// The drift of a voice: for each mode two random curves, smooth from one random number to the next, which come `drift_rate` times
/// a second. Levels only fall, so that no bound of a strike changes. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drift {
    /// The stream of the voice's first strike.
    key: u64,
    /// Random numbers that have passed.
    phase: f64,
    /// The same at the next control tick.
    next_phase: f64,
    /// Largest fall of a level in decibels, and largest change of a pitch in octaves.
    fall: f64,
    octaves: f64,
}

impl Drift {
    /// The drift of a voice whose first strike has the stream `key`.
    pub(super) fn new(key: u64) -> Self {
        Self { key: random::key(key, DRIFT_STREAM), phase: 0.0, next_phase: 0.0, fall: 0.0, octaves: 0.0 }
    }

    /// Advances by `passed` seconds, and takes the values for the time `ahead` seconds from now. Pitches come back to those of the note
    /// if it `is_played`.
    pub(super) fn control(&mut self, controls: &Controls, is_played: bool, [passed, ahead]: [f64; 2]) {
        self.phase += controls.drift_rate * passed;
        self.next_phase = self.phase + controls.drift_rate * ahead;
        (self.fall, self.octaves) = (controls.drift_level, if is_played { 0.0 } else { controls.drift_pitch / 1200.0 });
    }

    /// Whether levels drift, and whether pitches do.
    pub(super) fn moves(&self) -> [bool; 2] {
        [self.fall > 0.0, self.octaves > 0.0]
    }

    /// Gains of the first `len` modes of a cell at the next control tick, 0–1, and the ratios of their pitches.
    pub(super) fn at(&self, cell: usize, len: usize) -> [[f64; MAX_MODES]; 2] {
        let [mut gains, mut ratios] = [[1.0; MAX_MODES]; 2];
        let [drifts, detunes] = self.moves();
        if drifts || detunes {
            let [mut levels, mut pitches] = [[0.0; MAX_MODES]; 2];
            wander(self.key, self.next_phase, cell * MAX_MODES, [&mut levels[..len], &mut pitches[..len]]);
            if drifts {
                let falls = levels.map(|level| 0.5 * (level - 1.0));
                powers(&falls[..len], self.fall * (LOG2_10 / 20.0), &mut gains);
            }
            if detunes {
                powers(&pitches[..len], self.octaves, &mut ratios);
            }
        }
        [gains, ratios]
    }
}
