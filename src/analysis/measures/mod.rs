//! Measures that compare a sound with recordings of real instruments: attack, brightness, motion, partials, loudness.
//!
//! Their thresholds come from 249 recordings (the FluidR3 soundfont and the drum kits of Hydrogen): nine of ten
//! recordings pass each. All measures take one channel at [`RATE`], from its onset on.

pub mod held;
pub mod octaves;
pub mod preset;
pub mod recordings;
pub mod spectrogram;

use super::level::peak;
use super::log_mel::{RATE, hertz, mel};
use libm::{cos, log, log10, sqrt};
use sprung_fourier::forward;
use std::f64::consts::PI;

/// Least values of some measures: the 10th percentiles of the recordings.
#[derive(Clone, Copy, Debug)]
pub struct Least {
    /// [`attack_flatness`] in dB.
    pub attack_flatness: f64,
    /// [`high_share`] in dB.
    pub high_share: f64,
    /// [`motion`] in dB.
    pub motion: f64,
    /// [`partials`].
    pub partials: usize,
}

/// For mallets, plucks and bells.
pub const TUNED: Least = Least { attack_flatness: -48.0, high_share: -42.0, motion: 0.48, partials: 6 };
/// For drums and percussion.
pub const DRUMS: Least = Least { attack_flatness: -29.0, high_share: -39.0, motion: 1.2, partials: 9 };

/// A sound begins at its first sample above this share of its peak.
const AUDIBLE: f64 = 0.03;

/// Lower bound of energies, so that silence has a level.
const LEAST: f64 = 1e-30;

/// Samples of a duration in seconds.
pub(crate) fn samples(seconds: f64) -> usize {
    (seconds * f64::from(RATE)) as usize
}

/// The sound from its onset on.
pub fn from_onset(sound: &[f32]) -> &[f32] {
    let least = AUDIBLE * peak(sound);
    let start = sound.iter().position(|sample| f64::from(sample.abs()) > least).unwrap_or(0);
    &sound[start..]
}

/// Energy of the bins from 0 Hz to Nyquist of samples under a window, filled up with zeros to `length`.
fn power(samples: &[f32], window: impl Fn(f64) -> f64, length: usize) -> Vec<f64> {
    let fft = forward(length);
    let (mut input, mut output) = (fft.make_input_vec(), fft.make_output_vec());
    let last = samples.len().min(length).saturating_sub(1).max(1) as f64;
    for (n, (input, sample)) in input.iter_mut().zip(samples).enumerate() {
        *input = f64::from(*sample) * window(n as f64 / last);
    }
    fft.process(&mut input, &mut output).expect("the buffers are the transform's own");
    output.iter().map(|bin| bin.norm_sqr()).collect()
}

/// The window of Hann, at a place from 0 to 1, and its second half.
fn hann(at: f64) -> f64 {
    0.5 - 0.5 * cos(2.0 * PI * at)
}
fn falling(at: f64) -> f64 {
    0.5 + 0.5 * cos(PI * at)
}

fn decibels(energy: f64) -> f64 {
    10.0 * log10(energy.max(LEAST))
}

/// How much the first 25 ms are noise between 300 Hz and 12 kHz, in dB: the geometric mean of the energy over its
/// arithmetic mean. 0 is white noise, and a pure tone is far below −60.
pub fn attack_flatness(sound: &[f32]) -> f64 {
    const LENGTH: usize = 4096;
    let attack = &sound[..sound.len().min(samples(0.025))];
    let bins = power(attack, hann, LENGTH);
    let bin = |frequency: f64| (frequency * LENGTH as f64 / f64::from(RATE)).ceil() as usize;
    let heard: Vec<f64> = bins[bin(300.0)..bin(12_000.0)].iter().map(|energy| energy + LEAST).collect();
    let count = heard.len() as f64;
    let (logarithms, sum) = heard.iter().fold((0.0, 0.0), |(logs, sum), energy| (logs + log(*energy), sum + energy));
    10.0 / log(10.0) * (logarithms / count - log(sum / count))
}

/// The share of the energy above 2 kHz in the first 50 ms, in dB.
pub fn high_share(sound: &[f32]) -> f64 {
    let start = &sound[..sound.len().min(samples(0.05))];
    let length = start.len().next_multiple_of(2).max(16);
    let bins = power(start, falling, length);
    let first = (2000.0 * length as f64 / f64::from(RATE)).ceil() as usize;
    let (high, all): (f64, f64) = (bins[first.min(bins.len())..].iter().sum(), bins.iter().sum());
    decibels(high / all.max(LEAST)).max(-120.0)
}

/// Weights of the bins of a transform in `count` mel bands from 40 Hz to 16 kHz: for each band its first bin and the
/// weights from there.
fn mel_bands(count: usize, length: usize) -> Vec<(usize, Vec<f64>)> {
    let (low, high) = (mel(40.0), mel(16_000.0));
    let edge = |n: usize| hertz(low + (high - low) * n as f64 / (count + 1) as f64);
    let width = f64::from(RATE) / length as f64;
    let band = |n: usize| {
        let (from, centre, to) = (edge(n), edge(n + 1), edge(n + 2));
        let (first, last) = ((from / width).ceil() as usize, (to / width).floor() as usize);
        let weight = |bin: usize| {
            let frequency = bin as f64 * width;
            ((frequency - from) / (centre - from)).min((to - frequency) / (to - centre)).max(0.0)
        };
        let weights: Vec<f64> = (first..=last).map(weight).collect();
        // A band narrower than a bin has the nearest one.
        if weights.iter().sum::<f64>() > 0.0 {
            (first, weights)
        } else {
            ((centre / width).round() as usize, vec![1.0])
        }
    };
    (0..count).map(band).collect()
}

fn in_bands(bands: &[(usize, Vec<f64>)], power: &[f64]) -> Vec<f64> {
    let sum = |(first, weights): &(usize, Vec<f64>)| {
        weights.iter().zip(&power[*first..]).map(|(weight, energy)| weight * energy).sum()
    };
    bands.iter().map(sum).collect()
}

/// How far the decay of each band departs from a smooth one, in dB: from 50 to 850 ms, the RMS deviation from its own best
/// parabola, as a mean over those of 48 mel bands that are within 40 dB of the loudest. None if the sound is too short.
pub fn motion(sound: &[f32]) -> Option<f64> {
    const WINDOW: usize = 2048;
    const HOP: usize = 256;
    const SPAN: f64 = 1e-4;
    let middle = &sound[samples(0.05).min(sound.len())..samples(0.85).min(sound.len())];
    let least = 1e-4 * peak(middle);
    let end = middle.iter().rposition(|sample| f64::from(sample.abs()) > least)?;
    let middle = &middle[..end];
    if middle.len() < WINDOW + 12 * HOP {
        return None;
    }
    let bands = mel_bands(48, WINDOW);
    let columns: Vec<Vec<f64>> =
        middle.windows(WINDOW).step_by(HOP).map(|column| in_bands(&bands, &power(column, hann, WINDOW))).collect();
    let total = |band: usize| columns.iter().map(|column| column[band]).sum::<f64>();
    let totals: Vec<f64> = (0..bands.len()).map(total).collect();
    let loudest = totals.iter().fold(LEAST, |most: f64, total| most.max(*total));
    let heard = (0..bands.len()).filter(|band| totals[*band] >= SPAN * loudest);
    let departures: Vec<f64> = heard
        .map(|band| {
            let levels: Vec<f64> = columns.iter().map(|column| decibels(column[band] + loudest * 1e-12)).collect();
            from_parabola(&levels)
        })
        .collect();
    Some(departures.iter().sum::<f64>() / departures.len() as f64)
}

/// RMS deviation of evenly spaced numbers from their best parabola, by projection on three orthogonal polynomials.
fn from_parabola(numbers: &[f64]) -> f64 {
    let count = numbers.len();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut rest = numbers.to_vec();
    let place = |n: usize| 2.0 * n as f64 / (count - 1).max(1) as f64 - 1.0;
    for power in [|_| 1.0, |x: f64| x, |x: f64| x * x] {
        let mut polynomial: Vec<f64> = (0..count).map(|n| power(place(n))).collect();
        basis.iter().for_each(|known| remove(&mut polynomial, known));
        remove(&mut rest, &polynomial);
        basis.push(polynomial);
    }
    sqrt(rest.iter().map(|number| number * number).sum::<f64>() / count as f64)
}

/// Removes from a vector its part along another.
fn remove(vector: &mut [f64], along: &[f64]) {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let share = product(vector, along) / product(along, along).max(LEAST);
    vector.iter_mut().zip(along).for_each(|(number, along)| *number -= share * along);
}

/// Number of partials in the first 0.6 s: peaks within 55 dB of the strongest that stand out by 12 dB.
pub fn partials(sound: &[f32]) -> usize {
    const LENGTH: usize = 1 << 16;
    let start = &sound[..sound.len().min(samples(0.6))];
    let bins = power(start, hann, LENGTH);
    let below = (18_000.0 * LENGTH as f64 / f64::from(RATE)) as usize;
    let levels: Vec<f64> = bins[..below].iter().map(|energy| decibels(*energy)).collect();
    let strongest = levels.iter().fold(f64::NEG_INFINITY, |most: f64, level| most.max(*level));
    // How far the level falls on one side of a peak before it rises above the peak.
    let depth = |level: f64, side: &mut dyn Iterator<Item = &f64>| {
        let mut lowest = level;
        for next in side {
            if *next > level {
                break;
            }
            lowest = lowest.min(*next);
        }
        level - lowest
    };
    let is_partial = |n: &usize| {
        let (level, n) = (levels[*n], *n);
        level > levels[n - 1]
            && level >= levels[n + 1]
            && level >= strongest - 55.0
            && depth(level, &mut levels[..n].iter().rev()) >= 12.0
            && depth(level, &mut levels[n + 1..].iter()) >= 12.0
    };
    (1..levels.len() - 1).filter(is_partial).count()
}

/// How much two sounds differ in timbre over their first 100 ms, in dB: the RMS difference of 24 mel bands at the same
/// total level, over the bands within 60 dB.
pub(crate) fn timbre_change(first: &[f32], second: &[f32]) -> f64 {
    const LENGTH: usize = 8192;
    const LEAST_DB: f64 = -60.0;
    let bands = mel_bands(24, LENGTH);
    let levels = |sound: &[f32]| {
        let energies = in_bands(&bands, &power(&sound[..sound.len().min(samples(0.1))], hann, LENGTH));
        let total: f64 = energies.iter().sum();
        energies.iter().map(|energy| decibels(energy / total.max(LEAST)).max(LEAST_DB)).collect::<Vec<_>>()
    };
    let (first, second) = (levels(first), levels(second));
    let pairs = first.iter().zip(&second).filter(|(a, b)| **a > LEAST_DB || **b > LEAST_DB);
    let (sum, count) = pairs.fold((0.0, 0), |(sum, count), (a, b)| (sum + (a - b) * (a - b), count + 1));
    sqrt(sum / f64::from(count.max(1)))
}

/// Energy of the difference of two sounds at the same level, over that of the first, in dB.
pub(crate) fn difference(first: &[f32], second: &[f32]) -> f64 {
    let product = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum::<f64>();
    let own = product(first, first).max(LEAST);
    let shared = product(first, second);
    // This share of the first remains when the second is subtracted with the best gain.
    decibels((1.0 - shared * shared / (own * product(second, second).max(LEAST))).max(1e-12))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::random::uniform;
    use libm::pow;

    fn tone(frequencies: &[f64], t60: f64, seconds: f64) -> Vec<f32> {
        let at = |n: usize| {
            let time = n as f64 / f64::from(RATE);
            let sum: f64 = frequencies.iter().map(|f| libm::sin(2.0 * PI * f * time)).sum();
            (sum * pow(10.0, -3.0 * time / t60)) as f32
        };
        (0..samples(seconds)).map(at).collect()
    }

    fn noise(seconds: f64) -> Vec<f32> {
        (0..samples(seconds)).map(|n| uniform(1, n as u64)).collect()
    }

    #[test]
    fn noise_is_flat_and_a_tone_is_not() {
        assert!(attack_flatness(&noise(0.1)) > -6.0);
        assert!(attack_flatness(&tone(&[440.0], 1.0, 0.1)) < -50.0);
    }

    #[test]
    fn the_share_of_highs_is_that_of_the_tones() {
        let both: Vec<f32> = tone(&[500.0, 5000.0], 5.0, 0.2);
        assert!((high_share(&both) + 3.0).abs() < 0.5);
        assert!(high_share(&tone(&[500.0], 5.0, 0.2)) < -25.0);
    }

    #[test]
    fn a_straight_decay_has_no_motion_and_a_beat_has() {
        assert!(motion(&tone(&[440.0], 2.0, 1.0)).unwrap() < 0.2);
        assert!(motion(&tone(&[440.0, 444.0], 2.0, 1.0)).unwrap() > 1.0);
        assert_eq!(motion(&tone(&[440.0], 0.02, 1.0)), None);
        assert!(from_parabola(&[1.0, 4.0, 9.0, 16.0, 25.0]) < 1e-12);
    }

    #[test]
    fn partials_are_counted() {
        assert_eq!(partials(&tone(&[300.0, 700.0, 1500.0, 4000.0], 3.0, 1.0)), 4);
    }

    #[test]
    fn changes_of_timbre_and_strike_are_seen() {
        let [dull, bright] = [&[300.0][..], &[300.0, 3000.0]].map(|f| tone(f, 1.0, 0.2));
        assert!(timbre_change(&dull, &dull) < 1e-9 && timbre_change(&dull, &bright) > 3.0);
        let louder: Vec<f32> = dull.iter().map(|sample| 3.0 * sample).collect();
        assert!(difference(&dull, &louder) < -90.0);
        assert!((difference(&tone(&[300.0], 9.0, 1.0), &tone(&[400.0], 9.0, 1.0))).abs() < 0.1);
    }
}
