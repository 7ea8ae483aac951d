//! Modes that wander by themselves, each in level and in pitch.

use crate::dsp::mode_bank::MAX_MODES;
use crate::dsp::random;
use crate::dsp::series::powers;
use crate::engine::controls::Controls;
use libm::floor;
use std::f64::consts::LOG2_10;

/// Number of the stream. It differs from those of the strike.
const DRIFT_STREAM: u64 = 0x44_5246_5400;
/// Where modes stand between one random number and the next: as far apart as can be (the golden ratio).
const STAGGER: f64 = 0.618_033_988_749_894_9;

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
            let [levels, pitches] = self.curves(cell, len);
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

    /// Where the curves of levels and of pitches stand, −1 to 1.
    fn curves(&self, cell: usize, len: usize) -> [[f64; MAX_MODES]; 2] {
        let whole = floor(self.next_phase);
        let draws = [0, 1, 2].map(|n| random::key(self.key, whole as u64 + n));
        let mut curves = [[0.0; MAX_MODES]; 2];
        for m in 0..len.min(MAX_MODES) {
            let number = cell * MAX_MODES + m;
            let stagger = STAGGER * number as f64;
            let place = self.next_phase - whole + stagger - f64::from(stagger as u32);
            let (first, share) = if place < 1.0 { (0, place) } else { (1, place - 1.0) };
            let [from, to] = [first, first + 1].map(|n| random::bits(draws[n], number as u64));
            let share = share * share * (3.0 - 2.0 * share);
            for (curve, shift) in curves.iter_mut().zip([0, 32]) {
                let [from, to] =
                    [from, to].map(|bits| f64::from((bits >> shift) as u32 as i32) * (1.0 / 2_147_483_648.0));
                curve[m] = from + (to - from) * share;
            }
        }
        curves
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The curves keep within their bounds, are smooth, differ from mode to mode, and have the rate that they are said to have.
    #[test]
    fn curves_wander_at_their_rate() {
        let (mut drift, rate, tick) = (Drift::new(7), 4.0, 1.0 / 1500.0);
        let curves: Vec<[f64; MAX_MODES]> = (0..30_000)
            .map(|n| {
                drift.phase = rate * tick * f64::from(n);
                drift.next_phase = drift.phase;
                drift.curves(1, MAX_MODES)[0]
            })
            .collect();
        let curve = |m: usize| curves.iter().map(move |row| row[m]);
        for m in [0, 5, 63] {
            let (least, most) = curve(m).fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
            assert!((-1.0..-0.8).contains(&least) && (0.8..1.0).contains(&most), "{least} to {most}");
            let values: Vec<f64> = curve(m).collect();
            // The steepest slope between numbers from −1 to 1 is 1.5 · 2.
            let steepest = values.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
            assert!(steepest < 3.01 * rate * tick, "{steepest}");
            let crossings = values.windows(2).filter(|w| (w[0] < 0.0) != (w[1] < 0.0)).count();
            // Half of the numbers have another sign than the one before: 2 a second, in 20 s.
            assert!((24..56).contains(&crossings), "{crossings}");
        }
        let product = |a: usize, b: usize| curve(a).zip(curve(b)).map(|(x, y)| x * y).sum::<f64>() / 30_000.0;
        assert!(product(3, 4).abs() < 0.35 * product(3, 3), "{} of {}", product(3, 4), product(3, 3));
    }
}
