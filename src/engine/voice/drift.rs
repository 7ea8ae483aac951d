//! Modes that wander by themselves, each in level and in pitch.

use crate::dsp::cells::Cells;
use crate::dsp::mode_bank::MAX_MODES;
use crate::dsp::random;
use crate::dsp::series::powers;
use crate::engine::controls::Controls;
use libm::floor;
use std::f64::consts::LOG2_10;

/// Numbers of the streams: where each mode stands in its round, its levels and its pitches. They differ from those of the strike.
const OFFSETS: u64 = 0x44_5246_5400;
const LEVELS: u64 = OFFSETS + 1;
const PITCHES: u64 = OFFSETS + 2;

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
    is_detuned: bool,
}

impl Drift {
    /// The drift of a voice whose first strike has the stream `key`.
    pub(super) const fn new(key: u64) -> Self {
        Self { key, phase: 0.0, next_phase: 0.0, fall: 0.0, octaves: 0.0, is_detuned: false }
    }

    /// Advances by `passed` seconds, and takes the values for the time `ahead` seconds from now.
    pub(super) fn control(&mut self, controls: &Controls, [passed, ahead]: [f64; 2]) {
        self.phase += controls.drift_rate * passed;
        self.next_phase = self.phase + controls.drift_rate * ahead;
        (self.fall, self.octaves) = (controls.drift_level, controls.drift_pitch / 1200.0);
    }

    pub(super) fn moves_levels(&self) -> bool {
        self.fall > 0.0
    }

    /// Gains of the modes of a cell, 0–1.
    pub(super) fn levels(&self, cell: usize) -> [f64; MAX_MODES] {
        let falls = self.numbers(LEVELS, cell).map(|number| 0.5 * (number - 1.0));
        let mut gains = [1.0; MAX_MODES];
        powers(&falls, self.fall * (LOG2_10 / 20.0), &mut gains);
        gains
    }

    /// Moves the pitches of modes whose note has this frequency in Hz. The next ramp reaches them.
    pub(super) fn detune(&mut self, frequency: f64, bank: &mut Cells) {
        let drifts = self.octaves > 0.0;
        if drifts || self.is_detuned {
            self.is_detuned = drifts;
            bank.transpose(|cell| {
                let mut factors = [1.0; MAX_MODES];
                powers(&self.numbers(PITCHES, cell), self.octaves, &mut factors);
                factors.map(|factor| frequency * factor)
            });
        }
    }

    /// The numbers of the modes of a cell at the next control tick, −1 to 1.
    fn numbers(&self, stream: u64, cell: usize) -> [f64; MAX_MODES] {
        let (offsets, stream) = (random::key(self.key, OFFSETS), random::key(self.key, stream));
        let whole = floor(self.next_phase);
        let draws = [0, 1, 2].map(|n| random::key(stream, whole as u64 + n));
        std::array::from_fn(|m| {
            let m = (cell * MAX_MODES + m) as u64;
            // Modes do not turn round together.
            let place = self.next_phase - whole + random::unit(offsets, m);
            let (first, share) = if place < 1.0 { (0, place) } else { (1, place - 1.0) };
            let [from, to] = [first, first + 1].map(|n| f64::from(random::uniform(draws[n], m)));
            from + (to - from) * share * share * (3.0 - 2.0 * share)
        })
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
                drift.numbers(LEVELS, 1)
            })
            .collect();
        let course = |m: usize| curves.iter().map(move |row| row[m]);
        for m in [0, 5, 63] {
            let (least, most) = course(m).fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
            assert!((-1.0..-0.8).contains(&least) && (0.8..1.0).contains(&most), "{least} to {most}");
            let values: Vec<f64> = course(m).collect();
            // The steepest slope between numbers from −1 to 1 is 1.5 · 2.
            let steepest = values.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
            assert!(steepest < 3.01 * rate * tick, "{steepest}");
            let crossings = values.windows(2).filter(|w| (w[0] < 0.0) != (w[1] < 0.0)).count();
            // Half of the numbers have another sign than the one before: 2 a second, in 20 s.
            assert!((24..56).contains(&crossings), "{crossings}");
        }
        let product = |a: usize, b: usize| course(a).zip(course(b)).map(|(x, y)| x * y).sum::<f64>() / 30_000.0;
        assert!(product(3, 4).abs() < 0.35 * product(3, 3), "{} of {}", product(3, 4), product(3, 3));
    }
}
