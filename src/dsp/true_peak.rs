//! The waveform between samples, by interpolation: complete points, and points that still need later samples.

use libm::{cos, sin};
use std::f64::consts::PI;

/// Number of samples from which each point is interpolated.
pub(crate) const TAPS: usize = 12;

/// Points per sample: the sample itself and three between it and the next one.
const POINTS: usize = 4;

const WEIGHTS: usize = TAPS * POINTS;

/// One number for each incomplete point, ordered by age: the first are those of the points that the newest sample completes.
/// Stored twice in a row, so that it can be read starting at any age.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct ByAge([f32; 2 * WEIGHTS]);

impl ByAge {
    fn new(number: impl Fn(usize) -> f32) -> Self {
        Self(std::array::from_fn(|index| number(index % WEIGHTS)))
    }

    /// Applies `change` to every number.
    pub(crate) fn map(self, change: impl Fn(f32) -> f32) -> Self {
        Self(self.0.map(change))
    }

    /// The numbers in the order in which an [`Interpolator`] stores its points, if its oldest points are at place `next`.
    #[inline(always)]
    fn from(&self, next: usize) -> &[f32; WEIGHTS] {
        let start = (TAPS - next) * POINTS;
        self.0[start..].first_chunk().unwrap_or(&[0.0; WEIGHTS])
    }
}

/// The interpolation of ITU-R BS.1770-5, annex 2, at four times the sample rate: a sinc function under a Hann window.
/// Plain data; making one calls transcendental functions.
#[derive(Clone, Debug)]
pub(crate) struct Weights {
    /// Weight of the newest sample in each point to which it contributes.
    of_newest: ByAge,
    /// A mask: zero bits for points that the previous sample completed, since the newest points replace them, and one bits for
    /// the others. Unlike multiplication by 0, a mask also removes infinity.
    kept: ByAge,
    /// Upper bound of each point's partial sum, if no point ever exceeds 1 when complete.
    partial_bounds: ByAge,
}

impl Weights {
    /// Computes the weights; the same bits on every machine.
    pub(crate) fn new() -> Self {
        let of_newest: [f32; WEIGHTS] = std::array::from_fn(|index| {
            let window = 0.5 * (1.0 - cos(2.0 * PI * index as f64 / WEIGHTS as f64));
            let x = PI * (index as f64 - WEIGHTS as f64 / 2.0) / POINTS as f64;
            (if x == 0.0 { 1.0 } else { window * sin(x) / x }) as f32
        });
        // A partial sum is at most the sum of the weights used so far, since samples are at most 1. It is also at most
        // the complete point, 1, plus the sum of the remaining weights.
        let partial_bounds = ByAge::new(|index| {
            let of_point = |range: std::ops::Range<usize>| -> f32 {
                range.skip(index % POINTS).step_by(POINTS).map(|index| f32::abs(of_newest[index])).sum()
            };
            let to_come = index - index % POINTS;
            of_point(to_come..WEIGHTS).min(1.0 + of_point(0..to_come))
        });
        let kept = ByAge::new(|index| f32::from_bits(if index < WEIGHTS - POINTS { u32::MAX } else { 0 }));
        Self { of_newest: ByAge::new(|index| of_newest[index]), kept, partial_bounds }
    }

    /// Upper bound of each point's partial sum, if no point ever exceeds `peak` when complete.
    pub(crate) fn partial_bounds(&self, peak: f32) -> ByAge {
        self.partial_bounds.map(|bound| bound * peak)
    }
}

impl Default for Weights {
    fn default() -> Self {
        Self::new()
    }
}

/// The interpolated points of one channel. They depend on the last [`TAPS`] samples only, bit for bit. Real-time safe.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Interpolator {
    /// The partial sum of each point. A point stays in its place until it is complete; then a new one takes the place.
    sums: [f32; WEIGHTS],
    /// The place, in groups of [`POINTS`], of the points that the next sample will complete.
    next: usize,
}

impl Interpolator {
    /// The state after silence.
    pub(crate) const SILENT: Self = Self { sums: [0.0; WEIGHTS], next: 0 };

    /// Each point's partial sum before the next sample, and the weight of that sample in the point.
    #[inline(always)]
    fn points<'a>(&'a self, weights: &'a Weights) -> impl Iterator<Item = (f32, f32)> + 'a {
        let kept = self
            .sums
            .iter()
            .zip(weights.kept.from(self.next))
            .map(|(sum, kept)| f32::from_bits(sum.to_bits() & kept.to_bits()));
        kept.zip(weights.of_newest.from(self.next).iter().copied())
    }

    /// The largest magnitude of the points that `sample` would complete. They lie half of [`TAPS`] samples in the past.
    #[inline(always)]
    pub(crate) fn peak_with(&self, weights: &Weights, sample: f32) -> f32 {
        let (sums, weights) = (self.sums.as_chunks::<POINTS>().0, weights.of_newest.0.as_chunks::<POINTS>().0);
        let mut peak = 0.0;
        for point in 0..POINTS {
            let magnitude = (sums[self.next][point] + weights[0][point] * sample).abs();
            peak = if magnitude > peak { magnitude } else { peak };
        }
        peak
    }

    /// Adds the next sample.
    #[inline(always)]
    pub(crate) fn push(&mut self, weights: &Weights, sample: f32) {
        let mut sums = [0.0; WEIGHTS];
        sums.iter_mut().zip(self.points(weights)).for_each(|(to, (sum, weight))| *to = sum + weight * sample);
        self.sums = sums;
        self.next = if self.next + 1 < TAPS { self.next + 1 } else { 0 };
    }

    /// Whether no partial sum would exceed its limit after the next sample.
    #[inline(always)]
    pub(crate) fn is_within(&self, weights: &Weights, limits: &ByAge, sample: f32) -> bool {
        let points = self.points(weights).zip(limits.from(self.next));
        // Has no branch, so that the compiler can use vectors.
        points.fold(true, |within, ((sum, weight), limit)| within & ((sum + weight * sample).abs() <= *limit))
    }

    /// The largest factor for `sample`, 0–1, with which no partial sum exceeds its limit. A partial sum that already exceeds it
    /// does not grow.
    #[inline(always)]
    pub(crate) fn share_within(&self, weights: &Weights, limits: &ByAge, sample: f32) -> f32 {
        if self.is_within(weights, limits, sample) {
            return 1.0;
        }
        let points = self.points(weights).zip(limits.from(self.next));
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

    fn push(points: &mut Interpolator, weights: &Weights, sample: f32) -> f32 {
        let peak = points.peak_with(weights, sample);
        points.push(weights, sample);
        peak
    }

    #[test]
    fn a_sine_is_as_high_between_samples_as_it_is() {
        let weights = Weights::new();
        for frequency in [0.01, 0.1, 0.25, 0.4] {
            let mut interpolator = Interpolator::SILENT;
            let samples = (0..400).map(|n| sin(2.0 * PI * (frequency * f64::from(n) + 0.125)) as f32);
            let peaks: Vec<f32> = samples.map(|sample| push(&mut interpolator, &weights, sample)).collect();
            let peak = peaks[TAPS..].iter().fold(0.0, |peak: f32, point| peak.max(*point));
            assert!((0.97..1.03).contains(&peak), "{frequency}: {peak}");
        }
    }

    #[test]
    fn the_state_is_that_of_the_last_samples() {
        let weights = Weights::new();
        let (mut long, mut short) = (Interpolator::SILENT, Interpolator::SILENT);
        let sample = |n: u32| sin(f64::from(n * n)) as f32;
        (0..100).for_each(|n| long.push(&weights, sample(n)));
        (100 - TAPS as u32..100).for_each(|n| short.push(&weights, sample(n)));
        long.sums.rotate_left(long.next * POINTS);
        assert_eq!(long.sums, short.sums);
    }

    #[test]
    fn an_overflow_is_forgotten() {
        let weights = Weights::new();
        let (mut one, mut other) = (Interpolator::SILENT, Interpolator::SILENT);
        (0..3).for_each(|_| one.push(&weights, f32::MAX));
        for n in 0..40_u32 {
            let sample = sin(f64::from(n * n)) as f32;
            one.push(&weights, sample);
            other.push(&weights, sample);
        }
        one.sums.rotate_left(one.next * POINTS);
        other.sums.rotate_left(other.next * POINTS);
        assert_eq!(one.sums, other.sums);
    }

    #[test]
    fn a_share_keeps_every_point_within_its_limit() {
        let weights = Weights::new();
        let limits = weights.partial_bounds(0.5);
        let mut interpolator = Interpolator::SILENT;
        for n in 0..2000_u32 {
            let sample = 2.0 * sin(f64::from(n * n)) as f32;
            let share = interpolator.share_within(&weights, &limits, sample);
            assert!((0.0..=1.0).contains(&share));
            let limits = limits.from(interpolator.next).iter().zip(interpolator.sums);
            let least: Vec<_> = limits.map(|(limit, before)| limit.max(before.abs()) * (1.0 + 1e-6)).collect();
            interpolator.push(&weights, sample * share);
            assert!(interpolator.sums.iter().zip(least).all(|(sum, limit)| sum.abs() <= limit), "{n}");
        }
    }

    #[test]
    fn partial_bounds_hold_for_signals_within_their_peak() {
        let weights = Weights::new();
        for (seed, frequency) in [0.003, 0.11, 0.25, 0.31, 0.45, 0.49, 0.499].into_iter().enumerate() {
            let wave = |n: u32| {
                let n = f64::from(n);
                sin(2.0 * PI * frequency * n + seed as f64) + 0.5 * sin(2.0 * PI * 0.37 * frequency * n)
            };
            let mut interpolator = Interpolator::SILENT;
            let mut largest = 0.0f32;
            (0..4000).for_each(|n| largest = largest.max(push(&mut interpolator, &weights, wave(n) as f32)));
            let (limits, mut again) = (weights.partial_bounds(1.0), Interpolator::SILENT);
            for n in 0..4000 {
                let sample = wave(n) as f32 / largest;
                assert_eq!(again.share_within(&weights, &limits.map(|limit| limit * 1.000_01), sample), 1.0);
                again.push(&weights, sample);
            }
        }
    }
}
