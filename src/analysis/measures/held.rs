//! Measures of held sounds: what lies between the partials, how these enter, whether they beat at one rate, and how the colour changes.
//!
//! All take one channel at [`RATE`], from its onset on, and the pitch in hertz. What recordings have of them, `cargo xtask measure
//! --beside` tells of two soundfonts: in FluidR3 and TimGM6mb, most held programs have valleys of 30 to 80 dB.

use super::{decibels, hann, power, samples};
use crate::analysis::log_mel::RATE;
use libm::{cos, log2, sin, sqrt};
use std::f64::consts::PI;

/// Partials that are looked at, and how far below the strongest one they may lie, in dB.
const PARTIALS: usize = 12;
const SPAN_DB: f64 = 50.0;

/// The part of a note that is steady, in seconds from its onset.
const STEADY: [f64; 2] = [1.0, 2.4];

/// Periods of the pitch in a window in which a partial's entry is seen.
const PERIODS: f64 = 4.0;

/// Rates of beats, in hertz, and how often per second levels are taken.
const BEATS: [f64; 2] = [1.0, 15.0];
const LEVELS_PER_SECOND: f64 = 100.0;

/// A wobble of less than this, in dB, is none.
const LEAST_WOBBLE_DB: f64 = 0.2;

/// A window whose side lobes lie below the noise of 32-bit samples a few bins from the middle: the fourth power of Hann's.
fn steep(at: f64) -> f64 {
    let once = hann(at);
    once * once * once * once
}

/// A part of a sound between two times in seconds; none if the sound is shorter.
fn part(sound: &[f32], [from, to]: [f64; 2]) -> Option<&[f32]> {
    sound.get(samples(from)..samples(to))
}

fn median(mut numbers: Vec<f64>) -> Option<f64> {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len() / 2).copied()
}

/// The partials that are heard in the steady part: their numbers and energies, and the energies half-way above each.
fn partials(sound: &[f32], pitch: f64) -> Option<Vec<(usize, f64, f64)>> {
    let steady = part(sound, STEADY)?;
    let length = steady.len().next_power_of_two();
    let bins = power(steady, steep, length);
    let bin = |frequency: f64| ((frequency * length as f64 / f64::from(RATE)) as usize).min(bins.len() - 1);
    let strongest = |from: f64, to: f64| bins[bin(from)..=bin(to)].iter().copied().fold(0.0, f64::max);
    let found: Vec<(usize, f64, f64)> = (1..=PARTIALS)
        .map(|number| (number, number as f64 * pitch))
        .filter(|(_, frequency)| frequency + pitch < 0.5 * f64::from(RATE))
        .map(|(number, frequency)| {
            let between = bins[bin(frequency + 0.3 * pitch)..=bin(frequency + 0.7 * pitch)].to_vec();
            (number, strongest(frequency - 0.03 * pitch, frequency + 0.03 * pitch), median(between).unwrap_or(0.0))
        })
        .collect();
    let most = found.iter().map(|(_, energy, _)| *energy).fold(0.0, f64::max);
    let is_heard = |energy: f64| energy > 0.0 && decibels(energy / most) > -SPAN_DB;
    Some(found.into_iter().filter(|(_, energy, _)| is_heard(*energy)).collect())
}

/// How deep the valleys between the partials are, in dB: the median over the partials. None for a sound that is too short.
pub(crate) fn valleys(sound: &[f32], pitch: f64) -> Option<f64> {
    median(
        partials(sound, pitch)?.into_iter().map(|(_, energy, between)| decibels(energy / between.max(1e-30))).collect(),
    )
}

/// The level of a partial over time: its amplitude in windows of `periods` periods of the pitch, taken `rate` times a second.
fn levels(sound: &[f32], pitch: f64, number: usize, periods: f64, rate: f64) -> Vec<f64> {
    let length = (periods / pitch * f64::from(RATE)) as usize;
    let step = 2.0 * PI * number as f64 * pitch / f64::from(RATE);
    let weights: Vec<[f64; 2]> = (0..length)
        .map(|n| {
            let weight = hann(n as f64 / length as f64);
            [weight * cos(step * n as f64), weight * sin(step * n as f64)]
        })
        .collect();
    let amplitude = |window: &[f32]| {
        let [real, imaginary] = window.iter().zip(&weights).fold([0.0, 0.0], |[real, imaginary], (sample, weight)| {
            [real + f64::from(*sample) * weight[0], imaginary + f64::from(*sample) * weight[1]]
        });
        sqrt(real * real + imaginary * imaginary) / length as f64
    };
    sound.windows(length).step_by((f64::from(RATE) / rate) as usize).map(amplitude).collect()
}

/// Over which time the partials enter, in ms: from the tenth to the ninetieth percentile of the times at which each has half of the
/// level that it has from 0.3 to 0.6 s. None for a sound of fewer than three partials.
pub(crate) fn entry(sound: &[f32], pitch: f64) -> Option<f64> {
    // A window is centred on its time: half of the first lies before the sound.
    let before = (0.5 * PERIODS / pitch * f64::from(RATE)) as usize;
    let start = [&vec![0.0; before][..], part(sound, [0.0, 0.6])?].concat();
    let mut times: Vec<f64> = partials(sound, pitch)?
        .into_iter()
        .filter_map(|(number, ..)| {
            let levels = levels(&start, pitch, number, PERIODS, 1000.0);
            let steady = median(levels[levels.len() / 2..].to_vec())?;
            levels.iter().position(|level| *level >= 0.5 * steady).map(|place| place as f64)
        })
        .collect();
    if times.len() < 3 {
        return None;
    }
    times.sort_by(f64::total_cmp);
    let at = |share: f64| times[(share * (times.len() - 1) as f64).round() as usize];
    Some(at(0.9) - at(0.1))
}

/// The share of the wobble of the partials' levels that is at one rate from 1 to 15 Hz, as a mean over the partials that wobble. None if
/// none does.
pub(crate) fn regularity(sound: &[f32], pitch: f64) -> Option<f64> {
    let steady = part(sound, [0.5, 3.5]).or(part(sound, [0.5, 2.4]))?;
    let shares: Vec<f64> = partials(sound, pitch)?
        .into_iter()
        .filter_map(|(number, ..)| {
            let levels: Vec<f64> = levels(steady, pitch, number, 6.0, LEVELS_PER_SECOND)
                .into_iter()
                .map(|level| 2.0 * decibels(level))
                .collect();
            let apart = from_line(&levels)?;
            let square = apart.iter().map(|level| f64::from(*level) * f64::from(*level)).sum::<f64>();
            let length = apart.len().next_power_of_two();
            let bins = power(&apart, hann, length);
            let bin = |rate: f64| (rate * length as f64 / LEVELS_PER_SECOND) as usize;
            // A line is as wide as the window's lobe.
            let wide = 2 * length / apart.len();
            let rates = &bins[bin(BEATS[0])..=bin(BEATS[1])];
            let share = rates.iter().sum::<f64>() / bins.iter().sum::<f64>().max(1e-30);
            if sqrt(share * square / apart.len() as f64) < LEAST_WOBBLE_DB {
                return None;
            }
            let lines = rates.windows(2 * wide + 1).map(|line| line.iter().sum::<f64>());
            Some(lines.fold(0.0, f64::max) / rates.iter().sum::<f64>().max(1e-30))
        })
        .collect();
    (!shares.is_empty()).then(|| shares.iter().sum::<f64>() / shares.len() as f64)
}

/// Numbers without their best line; none if they are too few for one.
fn from_line(numbers: &[f64]) -> Option<Vec<f32>> {
    let count = numbers.len() as f64;
    let place = |n: usize| n as f64 - 0.5 * (count - 1.0);
    let mean = numbers.iter().sum::<f64>() / count;
    let square: f64 = (0..numbers.len()).map(|n| place(n) * place(n)).sum();
    let slope = numbers.iter().enumerate().map(|(n, number)| place(n) * number).sum::<f64>() / square;
    slope
        .is_finite()
        .then(|| numbers.iter().enumerate().map(|(n, number)| (number - mean - slope * place(n)) as f32).collect())
}

/// How many octaves the centre of the spectrum moves from 0.2–0.5 s to 2.0–2.4 s. None if it is silent by then.
pub(crate) fn colour(sound: &[f32]) -> Option<f64> {
    let centre = |times| {
        let part = part(sound, times)?;
        let length = part.len().next_power_of_two();
        let bins = power(part, steep, length);
        let weighted: f64 = bins.iter().enumerate().map(|(bin, energy)| bin as f64 * energy).sum();
        let whole = bins.iter().sum::<f64>();
        (whole > 0.0).then(|| weighted / whole / length as f64)
    };
    Some(log2(centre([2.0, 2.4])? / centre([0.2, 0.5])?))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PITCH: f64 = 220.0;

    /// Six partials, each with an amplitude over time, and white noise.
    fn tone(amplitude: impl Fn(usize, f64) -> f64, noise: f64) -> Vec<f32> {
        let mut seed = 1_u32;
        (0..samples(3.6))
            .map(|n| {
                let time = n as f64 / f64::from(RATE);
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let random = f64::from(seed >> 8) / f64::from(1 << 23) - 1.0;
                let partial = |number: usize| {
                    amplitude(number, time) * sin(2.0 * PI * number as f64 * PITCH * time) / number as f64
                };
                (0.1 * (1..=6).map(partial).sum::<f64>() + noise * random) as f32
            })
            .collect()
    }

    #[test]
    fn valleys_are_as_deep_as_the_noise_is_low() {
        let depth = |noise| valleys(&tone(|_, _| 1.0, noise), PITCH).unwrap();
        let [clean, faint, loud] = [0.0, 1e-5, 1e-3].map(depth);
        assert!(clean > 100.0, "{clean}");
        assert!((faint - loud - 40.0).abs() < 2.0, "{faint} {loud}");
    }

    #[test]
    fn partials_enter_as_late_as_they_do() {
        let delayed = |ms: f64| {
            let tone = tone(|number, time| f64::from(time >= 0.001 * ms * (number - 1) as f64 / 5.0), 0.0);
            entry(&tone, PITCH).unwrap()
        };
        assert!(delayed(0.0) <= 2.0, "{}", delayed(0.0));
        // From the tenth to the ninetieth of six: the second to the fifth, rounded.
        assert!((delayed(50.0) - 40.0).abs() <= 12.0, "{}", delayed(50.0));
    }

    #[test]
    fn beats_of_one_rate_are_told_from_those_of_many() {
        let beating = |rate: fn(usize) -> [f64; 2]| {
            let level = move |number: usize, time: f64| {
                let [a, b] = rate(number).map(|rate| sin(2.0 * PI * rate * time));
                1.0 + 0.2 * a + 0.2 * b
            };
            regularity(&tone(level, 0.0), PITCH).unwrap()
        };
        assert!(beating(|_| [5.0, 5.0]) > 0.9, "{}", beating(|_| [5.0, 5.0]));
        assert!(
            beating(|number| [2.0 + number as f64, 11.0]) < 0.6,
            "{}",
            beating(|number| [2.0 + number as f64, 11.0])
        );
        assert_eq!(regularity(&tone(|_, _| 1.0, 0.0), PITCH), None);
        let drifting = tone(|_, time| libm::exp(-0.04 * time), 0.0);
        assert_eq!(regularity(&drifting, PITCH), None, "a drift is no beat");
    }

    #[test]
    fn a_tone_that_darkens_falls_by_octaves() {
        let darker = tone(|number, time| if number == 1 || time < 1.0 { 1.0 } else { 0.0 }, 0.0);
        let change = colour(&darker).unwrap();
        assert!((-1.2..-0.3).contains(&change), "{change}");
        assert!(colour(&tone(|_, _| 1.0, 0.0)).unwrap().abs() < 0.01);
        assert_eq!(colour(&vec![0.0; samples(3.0)]), None);
    }
}
