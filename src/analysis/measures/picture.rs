//! A note as a picture of few points, in bands and in parts of its time, to compare with notes of other instruments.

use super::{decibels, samples};
use crate::analysis::log_mel::{BANDS, HOP, LogMel, MelBands, from_onset};
use libm::pow;

/// How long the note is held, in seconds.
pub const HELD: f64 = 1.5;

/// The ends of the parts, in seconds from the onset: they are short where most happens, at the start and after the release.
const ENDS: [f64; 14] = [0.02, 0.05, 0.1, 0.2, 0.35, 0.55, 0.8, 1.1, HELD, 1.55, 1.63, 1.75, 1.95, 2.3];

/// A note at equal energy, so that loudness counts for nothing.
pub struct Picture(LogMel);

impl Picture {
    /// The picture of a note at 44.1 kHz, held for [`HELD`] seconds from its onset.
    pub fn new(sound: &[f32]) -> Self {
        let windows = MelBands::new().measure(from_onset(sound)).columns;
        let (mut parts, mut start, mut energy) = (vec![], 0, 0.0);
        for end in ENDS {
            let end = (samples(end) / HOP).max(start + 1);
            let power = |n: usize, band: usize| windows.get(n).map_or(0.0, |levels| pow(10.0, levels[band] / 10.0));
            let sums: [f64; BANDS] = std::array::from_fn(|band| (start..end).map(|n| power(n, band)).sum());
            energy += sums.iter().sum::<f64>();
            parts.push(sums.map(|sum| sum / (end - start) as f64));
            start = end;
        }
        let whole = decibels(energy / start as f64);
        Self(LogMel { columns: parts.into_iter().map(|part| part.map(|power| decibels(power) - whole)).collect() })
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

    fn note(frequency: f64, amplitude: f64) -> Picture {
        let sample = |n: usize| amplitude * libm::sin(2.0 * PI * frequency * n as f64 / f64::from(RATE));
        Picture::new(&(0..samples(2.5)).map(|n| sample(n) as f32).collect::<Vec<_>>())
    }

    #[test]
    fn only_what_is_not_between_two_lies_outside() {
        let [low, high, louder] = [note(400.0, 0.1), note(3000.0, 0.1), note(400.0, 0.5)];
        assert!(low.distance(&louder) < 0.01 && low.distance(&high) > 10.0);
        assert!(low.outside([&louder, &high]) < 0.01 && high.outside([&low, &louder]) > 10.0);
        assert_eq!(high.outside([&low, &low]), high.distance(&low));
    }
}
