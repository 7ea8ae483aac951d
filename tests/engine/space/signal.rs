//! Signals and measurements for the tests of the space.

use sprung::internals::random::{key, uniform};
use std::f64::consts::{LN_10, PI};

/// Left and right.
pub(crate) type Stereo = [Vec<f32>; 2];

pub(crate) const RATE: f64 = 48_000.0;

/// White noise of a level for some frames, the sides independent, and silence up to `frames`.
pub(crate) fn noise(level: f32, sounding: usize, frames: usize) -> Stereo {
    [0, 1].map(|side| {
        let stream = key(3, side);
        (0..frames).map(|n| if n < sounding { level * uniform(stream, n as u64) } else { 0.0 }).collect()
    })
}

/// One sample of 1 on both sides, and silence.
pub(crate) fn impulse(frames: usize) -> Stereo {
    let side: Vec<f32> = (0..frames).map(|n| if n == 0 { 1.0 } else { 0.0 }).collect();
    [side.clone(), side]
}

pub(crate) fn rms(samples: &[f32]) -> f64 {
    (samples.iter().map(|x| f64::from(*x) * f64::from(*x)).sum::<f64>() / samples.len() as f64).sqrt()
}

pub(crate) fn peak(samples: &[f32]) -> f32 {
    samples.iter().fold(0.0, |peak, x| peak.max(x.abs()))
}

pub(crate) fn decibels(ratio: f64) -> f64 {
    20.0 * libm::log10(ratio)
}

/// An octave band: three band-pass filters of second order (R. Bristow-Johnson's cookbook), one after the other.
pub(crate) fn octave(samples: &[f32], centre: f64) -> Vec<f64> {
    let angle = 2.0 * PI * centre / RATE;
    let alpha = libm::sin(angle) / (2.0 * 1.2);
    let (a1, a2) = (-2.0 * libm::cos(angle) / (1.0 + alpha), (1.0 - alpha) / (1.0 + alpha));
    let gain = alpha / (1.0 + alpha);
    let mut band: Vec<f64> = samples.iter().map(|x| f64::from(*x)).collect();
    for _ in 0..3 {
        let (mut x, mut y) = ([0.0; 2], [0.0; 2]);
        for sample in &mut band {
            let out = gain * (*sample - x[1]) - a1 * y[0] - a2 * y[1];
            (x, y) = ([*sample, x[0]], [out, y[0]]);
            *sample = out;
        }
    }
    band
}

/// T60 in seconds by Schroeder's backward integration of both pick-ups' energy, from a straight line through −5 to −35 dB (ISO
/// 3382: T30, over several positions).
pub(crate) fn t60(bands: &[Vec<f64>; 2]) -> f64 {
    let energies = bands[0].iter().zip(&bands[1]).map(|(left, right)| left * left + right * right);
    let mut sum = 0.0;
    let mut left: Vec<f64> = Vec::new();
    for energy in energies.rev() {
        sum += energy;
        left.push(sum);
    }
    left.reverse();
    let level = |energy: f64| 10.0 * libm::log(energy / left[0]) / LN_10;
    let points: Vec<(f64, f64)> = left
        .iter()
        .enumerate()
        .map(|(n, energy)| (n as f64 / RATE, level(*energy)))
        .filter(|(_, level)| (-35.0..=-5.0).contains(level))
        .collect();
    let count = points.len() as f64;
    let (time, mean) = points.iter().fold((0.0, 0.0), |(t, l), point| (t + point.0 / count, l + point.1 / count));
    let (mut over, mut under) = (0.0, 0.0);
    for (t, l) in &points {
        over += (t - time) * (l - mean);
        under += (t - time) * (t - time);
    }
    -60.0 * under / over
}

/// Correlation of two bands.
pub(crate) fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    product(a, b) / (product(a, a) * product(b, b)).sqrt()
}

/// Runs a processor over a signal in blocks of one size. `at` is called with the first frame of each block and can change
/// parameters; blocks also end at the frames in `stops`.
pub(crate) fn run<P>(
    processor: &mut P,
    signal: &Stereo,
    block: usize,
    stops: &[usize],
    mut at: impl FnMut(&mut P, usize),
    process: impl Fn(&mut P, &mut [f32], &mut [f32]),
) -> Stereo {
    let [mut left, mut right] = signal.clone();
    let mut start = 0;
    while start < left.len() {
        at(processor, start);
        let stop = stops.iter().copied().find(|stop| *stop > start).unwrap_or(left.len());
        let end = (start + block).min(stop).min(left.len());
        process(processor, &mut left[start..end], &mut right[start..end]);
        start = end;
    }
    [left, right]
}

/// Checks that blocks of any size give the same bits, with the same changes of parameters at `stops`.
#[track_caller]
pub(crate) fn blocks_are_equal<P: Clone>(
    processor: &P,
    signal: &Stereo,
    stops: &[usize],
    at: impl Fn(&mut P, usize),
    process: impl Fn(&mut P, &mut [f32], &mut [f32]),
) {
    let bits = |block: usize| {
        let turned = |processor: &mut P, frame: usize| {
            if stops.contains(&frame) {
                at(processor, frame)
            }
        };
        let out = run(&mut processor.clone(), signal, block, stops, turned, &process);
        out.map(|side| side.into_iter().map(f32::to_bits).collect::<Vec<_>>())
    };
    let whole = bits(4096);
    for block in [1, 7, 64, 480] {
        let parts = bits(block);
        let differs = (0..signal[0].len()).find(|n| whole[0][*n] != parts[0][*n] || whole[1][*n] != parts[1][*n]);
        assert_eq!(differs, None, "blocks of {block}");
    }
}
