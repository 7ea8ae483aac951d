//! Compares two sounds: whether they are the same, and if not, how they differ.

use super::alignment::{Alignment, align};
use super::diff::{Difference, compare};
use super::spectrum::{BAND_CENTRES, band_levels};
use libm::{log10, pow};
use std::iter::repeat;

/// Largest residual of an alignment, in dB, for which one sound counts as a shifted or scaled copy of the other.
const SAME_BUT_MOVED_DB: f64 = -60.0;
/// Smallest change of a gain that is reported, 10⁻⁵ dB: single precision has no finer ones. The residual must be smaller.
const LEAST_SCALING: f64 = 1e-6;

/// An octave's levels, RMS in dBFS as mean power of the channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Octave {
    /// Centre in Hz.
    pub frequency: f64,
    /// Of the expected sound.
    pub expected_db: f64,
    /// Of the actual sound.
    pub actual_db: f64,
    /// Of the difference, actual minus expected.
    pub difference_db: f64,
}

/// The differences between two sounds of the same sample rate.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Where and by how much.
    pub difference: Difference,
    /// The levels of each octave; empty if a sample of either sound is not finite.
    pub octaves: Vec<Octave>,
    /// The shift and the gain that best turn the expected sound into the actual one.
    pub alignment: Option<Alignment>,
}

impl Comparison {
    /// Compares two sounds, a list of samples for each channel; `None` if they are the same to the bit.
    pub fn of(expected: &[Vec<f32>], actual: &[Vec<f32>], sample_rate: f64) -> Option<Self> {
        let difference = compare(expected, actual)?;
        let channels = expected.len().max(actual.len());
        let left = |channel: usize| {
            let (expected, actual) = (channel_of(expected, channel), channel_of(actual, channel));
            let sample = |samples: &[f32], frame: usize| samples.get(frame).copied().unwrap_or(0.0);
            (0..difference.frames[0].max(difference.frames[1]))
                .map(|frame| sample(actual, frame) - sample(expected, frame))
                .collect::<Vec<f32>>()
        };
        let differences: Vec<Vec<f32>> = (0..channels).map(left).collect();
        let finite = differences.iter().flatten().all(|sample| sample.is_finite());
        let octaves = if finite { octaves(expected, actual, &differences, sample_rate) } else { Vec::new() };
        Some(Self { difference, octaves, alignment: align(expected, actual) })
    }

    /// The alignment, if the actual sound is a shifted or scaled copy of the expected one.
    pub fn moved(&self) -> Option<Alignment> {
        let least = |found: &Alignment| LEAST_SCALING.max(pow(10.0, found.residual_db / 20.0));
        let is_moved = |found: &Alignment| found.shift != 0 || (found.gain - 1.0).abs() > least(found);
        self.alignment.filter(|found| found.residual_db < SAME_BUT_MOVED_DB && is_moved(found))
    }
}

fn channel_of(sound: &[Vec<f32>], channel: usize) -> &[f32] {
    sound.get(channel).map_or(&[], Vec::as_slice)
}

fn octaves(expected: &[Vec<f32>], actual: &[Vec<f32>], differences: &[Vec<f32>], sample_rate: f64) -> Vec<Octave> {
    // All are means over the length of the longer sound: the shorter one counts as silent after its end.
    let frames = differences.iter().map(Vec::len).max().unwrap_or(0);
    let whole = |channel: &Vec<f32>| channel.iter().copied().chain(repeat(0.0)).take(frames).collect::<Vec<f32>>();
    let levels = |sound: &[Vec<f32>]| {
        let channels: Vec<_> = sound.iter().map(|channel| band_levels(&whole(channel), sample_rate)).collect();
        let power = |band: usize| channels.iter().map(|levels| pow(10.0, levels[band] / 10.0)).sum::<f64>();
        let mean = |band: usize| 10.0 * log10(power(band) / channels.len().max(1) as f64);
        std::array::from_fn::<f64, 8, _>(mean)
    };
    let [expected, actual, difference] = [expected, actual, differences].map(levels);
    let octave = |(band, frequency): (usize, &f64)| Octave {
        frequency: *frequency,
        expected_db: expected[band],
        actual_db: actual[band],
        difference_db: difference[band],
    };
    BAND_CENTRES.iter().enumerate().filter(|(_, centre)| **centre < 0.5 * sample_rate).map(octave).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(frequency: f64, gain: f64) -> Vec<f32> {
        let step = std::f64::consts::TAU * frequency / 48_000.0;
        (0..24_000).map(|n| (gain * libm::exp(-1e-4 * f64::from(n)) * libm::sin(step * f64::from(n))) as f32).collect()
    }

    #[test]
    fn a_difference_is_in_its_octave() {
        let (a, b) = (sine(250.0, 0.5), sine(4000.0, 0.01));
        let both: Vec<f32> = a.iter().zip(&b).map(|(a, b)| a + b).collect();
        assert_eq!(Comparison::of(std::slice::from_ref(&a), std::slice::from_ref(&a), 48_000.0), None);
        let found = Comparison::of(&[a], &[both], 48_000.0).unwrap();
        let loudest = found.octaves.iter().max_by(|a, b| a.difference_db.total_cmp(&b.difference_db)).unwrap();
        assert_eq!((loudest.frequency, found.octaves.len()), (4000.0, 8));
        assert_eq!(found.moved(), None);
    }

    #[test]
    fn octaves_are_means_over_the_longer_sound() {
        let short = sine(250.0, 0.5);
        let mut long = short.clone();
        long.resize(2 * short.len(), 0.0);
        long[40_000] = 1e-4;
        let found = Comparison::of(&[short], &[long], 48_000.0).unwrap();
        let octave = found.octaves.iter().find(|octave| octave.frequency == 250.0).unwrap();
        assert!((octave.expected_db - octave.actual_db).abs() < 0.01, "{octave:?}");
    }

    #[test]
    fn what_was_only_scaled_is_told() {
        let found = Comparison::of(&[sine(250.0, 0.5)], &[sine(250.0, 0.25)], 48_000.0).unwrap();
        let moved = found.moved().unwrap();
        assert!(moved.shift == 0 && (moved.gain_db() + 6.0206).abs() < 1e-3, "{moved:?}");
        let found = Comparison::of(&[sine(250.0, 0.5)], &[sine(250.0, 0.500_05)], 48_000.0).unwrap();
        let moved = found.moved().unwrap();
        assert!((moved.gain_db() - 8.685e-4).abs() < 1e-5, "{moved:?}");
        // A gain that changes by less than what is left says nothing.
        let mut near = sine(250.0, 0.5);
        near[100] += 1e-3;
        assert_eq!(Comparison::of(&[sine(250.0, 0.5)], &[near], 48_000.0).unwrap().moved(), None);
    }

    #[test]
    fn what_is_not_finite_has_no_octaves() {
        let found = Comparison::of(&[vec![f32::NAN]], &[vec![0.0]], 48_000.0).unwrap();
        assert!(found.octaves.is_empty() && found.alignment.is_none());
    }
}
