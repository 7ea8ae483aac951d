//! The waveform between samples, by interpolation: points that are complete, and those that samples to come will complete.

use libm::{cos, sin};
use std::f64::consts::PI;

/// Samples that each interpolated point is made of.
pub const TAPS: usize = 12;

/// Points per sample: the sample itself and three between it and the next.
const POINTS: usize = 4;

const WEIGHTS: usize = TAPS * POINTS;

/// The interpolation of ITU-R BS.1770-5, annex 2, at four times the sample rate: a sinc function under a Hann window.
/// Plain data; making one calls transcendental functions.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// Weight of the newest sample in each point that it contributes to, by age of the point: those that are complete
    /// with it first.
    weights: [f32; WEIGHTS],
    /// The most that each point can be so far, if it and all before it never exceed 1 once complete.
    partial_bounds: [f32; WEIGHTS],
}

impl Kernel {
    /// The kernel; the same bits on every machine.
    pub fn new() -> Self {
        let weights = std::array::from_fn(|index| {
            let window = 0.5 * (1.0 - cos(2.0 * PI * index as f64 / WEIGHTS as f64));
            let x = PI * (index as f64 - WEIGHTS as f64 / 2.0) / POINTS as f64;
            (if x == 0.0 { 1.0 } else { window * sin(x) / x }) as f32
        });
        // What a point has so far is at most the sum of the weights had, since samples are at most 1, and at most what
        // it will be and the sum of the weights to come.
        let partial_bounds = std::array::from_fn(|index| {
            let of_point = |range: std::ops::Range<usize>| -> f32 {
                range.skip(index % POINTS).step_by(POINTS).map(|index| f32::abs(weights[index])).sum()
            };
            let to_come = index - index % POINTS;
            of_point(to_come..WEIGHTS).min(1.0 + of_point(0..to_come))
        });
        Self { weights, partial_bounds }
    }

    /// The most that each point can be so far, in the order of its weights, where no point ever exceeds `peak` once
    /// complete.
    pub fn partial_bounds(&self, peak: f32) -> [f32; WEIGHTS] {
        self.partial_bounds.map(|bound| bound * peak)
    }
}

impl Default for Kernel {
    fn default() -> Self {
        Self::new()
    }
}

/// The points of one channel. Its state depends on the last [`TAPS`] samples only, to the bit. Real-time safe.
#[derive(Clone, Debug)]
pub struct Interpolator {
    /// The points by their age, as [`Kernel::weights`] has them; after them, what a new point starts from.
    sums: [f32; WEIGHTS + POINTS],
}

impl Interpolator {
    /// After silence.
    pub const SILENT: Self = Self { sums: [0.0; WEIGHTS + POINTS] };

    /// Takes in the next sample and returns the largest magnitude of the points that it completes, which lie half of
    /// [`TAPS`] samples back.
    pub fn push(&mut self, kernel: &Kernel, sample: f32) -> f32 {
        for (index, weight) in kernel.weights.iter().enumerate() {
            self.sums[index] = self.sums[index + POINTS] + weight * sample;
        }
        self.sums[..POINTS].iter().fold(0.0, |peak, point| peak.max(point.abs()))
    }

    /// Whether no point exceeds its limit, those that are not complete by what they have so far.
    pub fn is_within(&self, limits: &[f32; WEIGHTS]) -> bool {
        // Without a branch, so that it is done in vectors.
        self.sums.iter().zip(limits).fold(true, |within, (sum, limit)| within & (sum.abs() <= *limit))
    }

    /// The largest share of `sample`, 0–1, with which no point so far exceeds its limit. A point that does already
    /// does not grow.
    pub fn share_within(&self, kernel: &Kernel, limits: &[f32; WEIGHTS], sample: f32) -> f32 {
        let mut whole = self.clone();
        whole.push(kernel, sample);
        if whole.is_within(limits) {
            return 1.0;
        }
        let points = self.sums[POINTS..].iter().zip(&kernel.weights).zip(limits);
        points.fold(1.0, |share, ((sum, weight), limit)| {
            let (change, limit) = (weight * sample, limit.max(sum.abs()));
            let room = if change > 0.0 { limit - sum } else { limit + sum };
            if change.abs() <= room { share } else { share.min(room / change.abs()) }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_is_as_high_between_samples_as_it_is() {
        let kernel = Kernel::new();
        for frequency in [0.01, 0.1, 0.25, 0.4] {
            let mut interpolator = Interpolator::SILENT;
            let samples = (0..400).map(|n| sin(2.0 * PI * (frequency * f64::from(n) + 0.125)) as f32);
            let peaks: Vec<f32> = samples.map(|sample| interpolator.push(&kernel, sample)).collect();
            let peak = peaks[TAPS..].iter().fold(0.0, |peak: f32, point| peak.max(*point));
            assert!((0.97..1.03).contains(&peak), "{frequency}: {peak}");
        }
    }

    #[test]
    fn the_state_is_that_of_the_last_samples() {
        let kernel = Kernel::new();
        let (mut long, mut short) = (Interpolator::SILENT, Interpolator::SILENT);
        let sample = |n: u32| sin(f64::from(n * n)) as f32;
        (0..100).for_each(|n| _ = long.push(&kernel, sample(n)));
        (100 - TAPS as u32..100).for_each(|n| _ = short.push(&kernel, sample(n)));
        assert_eq!(long.sums, short.sums);
    }

    #[test]
    fn a_share_keeps_every_point_within_its_limit() {
        let kernel = Kernel::new();
        let limits = kernel.partial_bounds(0.5);
        let mut interpolator = Interpolator::SILENT;
        for n in 0..2000_u32 {
            let sample = 2.0 * sin(f64::from(n * n)) as f32;
            let share = interpolator.share_within(&kernel, &limits, sample);
            assert!((0.0..=1.0).contains(&share));
            let before = interpolator.sums;
            interpolator.push(&kernel, sample * share);
            for (index, limit) in limits.iter().enumerate() {
                let limit = limit.max(before[index + POINTS].abs());
                assert!(interpolator.sums[index].abs() <= limit * (1.0 + 1e-6), "{n}");
            }
        }
    }

    #[test]
    fn partial_bounds_hold_for_signals_within_their_peak() {
        let kernel = Kernel::new();
        for (seed, frequency) in [0.003, 0.11, 0.25, 0.31, 0.45, 0.49, 0.499].into_iter().enumerate() {
            let wave = |n: u32| {
                let n = f64::from(n);
                sin(2.0 * PI * frequency * n + seed as f64) + 0.5 * sin(2.0 * PI * 0.37 * frequency * n)
            };
            let mut interpolator = Interpolator::SILENT;
            let mut largest = 0.0f32;
            (0..4000).for_each(|n| largest = largest.max(interpolator.push(&kernel, wave(n) as f32)));
            let (limits, mut again) = (kernel.partial_bounds(1.0), Interpolator::SILENT);
            for n in 0..4000 {
                let sample = wave(n) as f32 / largest;
                assert_eq!(again.share_within(&kernel, &limits.map(|limit| limit * 1.000_01), sample), 1.0);
                again.push(&kernel, sample);
            }
        }
    }
}
