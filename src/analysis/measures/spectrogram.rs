//! A note as levels in 48 mel bands over 14 time spans, at equal energy, to compare instruments.

use super::samples;
use crate::analysis::log_mel::{BANDS, HOP, LogMel, MelBands, from_onset};
use libm::{log10, pow};

/// How long the note is held, in seconds.
pub const HELD: f64 = 1.5;

/// The ends of the spans, in seconds from the onset: they are short where most happens, at the start and after the release.
const ENDS: [f64; 14] = [0.02, 0.05, 0.1, 0.2, 0.35, 0.55, 0.8, 1.1, HELD, 1.55, 1.63, 1.75, 1.95, 2.3];

/// Levels of a note in dB relative to its mean power, so that loudness does not matter.
pub struct Spectrogram(LogMel);

impl Spectrogram {
    /// Measures a note at 44.1 kHz, held for [`HELD`] seconds from its onset. None if it is silent.
    pub fn new(sound: &[f32]) -> Option<Self> {
        if sound.iter().all(|sample| *sample == 0.0) {
            return None;
        }
        let windows = MelBands::new().measure(from_onset(sound)).columns;
        let (mut spans, mut start, mut energy) = (vec![], 0, 0.0);
        for end in ENDS {
            let end = (samples(end) / HOP).max(start + 1);
            let power = |n: usize, band: usize| windows.get(n).map_or(0.0, |levels| pow(10.0, levels[band] / 10.0));
            let sums: [f64; BANDS] = std::array::from_fn(|band| (start..end).map(|n| power(n, band)).sum());
            energy += sums.iter().sum::<f64>();
            spans.push(sums.map(|sum| sum / (end - start) as f64));
            start = end;
        }
        let whole = energy / start as f64;
        let level = |power: f64| 10.0 * log10((power / whole).max(f64::MIN_POSITIVE));
        Some(Self(LogMel { columns: spans.into_iter().map(|span| span.map(level)).collect() }))
    }

    /// The mean difference from another note in dB, over all points that are within 60 dB of the highest.
    pub fn distance(&self, other: &Self) -> f64 {
        self.0.distance(&other.0)
    }

    /// How far this note lies outside two others in dB: 0 where it is between them, and the mean over the same points.
    pub fn outside(&self, others: [&Self; 2]) -> f64 {
        self.0.outside(others.map(|other| &other.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::log_mel::RATE;
    use std::f64::consts::PI;

    fn note(frequency: f64, amplitude: f64) -> Spectrogram {
        let sample = |n: usize| amplitude * libm::sin(2.0 * PI * frequency * n as f64 / f64::from(RATE));
        Spectrogram::new(&(0..samples(2.5)).map(|n| sample(n) as f32).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn loudness_does_not_matter_and_pitch_does() {
        let [low, high, louder] = [note(400.0, 0.1), note(3000.0, 0.1), note(400.0, 0.5)];
        assert!(low.distance(&louder) < 0.01 && low.distance(&high) > 10.0);
        assert!(low.outside([&louder, &high]) < 0.01 && high.outside([&low, &louder]) > 10.0);
        assert!(Spectrogram::new(&[0.0; 4000]).is_none());
    }

    #[test]
    fn only_what_is_not_between_two_levels_lies_outside_by_so_much() {
        let at = |level: f64| Spectrogram(LogMel { columns: vec![[level; BANDS]; ENDS.len()] });
        let [low, high] = [at(-10.0), at(10.0)];
        for (own, expected) in [(0.0, 0.0), (-10.0, 0.0), (15.0, 5.0), (-12.0, 2.0)] {
            assert!((at(own).outside([&high, &low]) - expected).abs() < 1e-9, "{own}");
        }
        assert!((at(0.0).outside([&high, &high]) - 10.0).abs() < 1e-9);
    }
}
