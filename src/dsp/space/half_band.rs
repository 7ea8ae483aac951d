//! Twice the sample rate and back: half-band filters of two branches of allpass filters.

use libm::{cos, pow, sin, sqrt, tan};
use std::f64::consts::{FRAC_PI_4, PI};

/// An elliptic half-band filter of order `2 (A + B) + 1`, as two branches of allpass filters of first order in `z⁻²`:
/// `A` in the first, `B` in the second. (R. A. Valenzuela and A. G. Constantinides, "Digital signal processing schemes for
/// efficient interpolation and decimation", IEE Proc. 130 G (1983).) It has minimum delay, not linear phase. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfBand<const A: usize, const B: usize> {
    first: Branch<A>,
    second: Branch<B>,
}

/// A chain of allpass filters `(c + z⁻¹)/(1 + c z⁻¹)` at the lower of the two rates.
#[derive(Clone, Copy, Debug)]
struct Branch<const N: usize> {
    coefficients: [f32; N],
    /// The last input and the last output of each filter.
    inputs: [f32; N],
    outputs: [f32; N],
}

impl<const N: usize> Branch<N> {
    fn next(&mut self, mut sample: f32) -> f32 {
        for n in 0..N {
            let out = self.coefficients[n] * (sample - self.outputs[n]) + self.inputs[n];
            (self.inputs[n], self.outputs[n]) = (sample, out);
            sample = out;
        }
        sample
    }
}

impl<const A: usize, const B: usize> HalfBand<A, B> {
    /// A filter whose pass band ends at `0.25 − transition/2` of the higher rate, and whose stop band begins at
    /// `0.25 + transition/2`.
    pub(super) fn new(transition: f64) -> Self {
        let coefficients = coefficients::<A, B>(transition);
        let branch = |first: usize| coefficients.0.iter().chain(&coefficients.1).skip(first).step_by(2);
        let (mut first, mut second) = ([0.0; A], [0.0; B]);
        first.iter_mut().zip(branch(0)).for_each(|(to, from)| *to = *from as f32);
        second.iter_mut().zip(branch(1)).for_each(|(to, from)| *to = *from as f32);
        Self {
            first: Branch { coefficients: first, inputs: [0.0; A], outputs: [0.0; A] },
            second: Branch { coefficients: second, inputs: [0.0; B], outputs: [0.0; B] },
        }
    }

    /// Resets the state to silence.
    pub(super) fn clear(&mut self) {
        (self.first.inputs, self.first.outputs) = ([0.0; A], [0.0; A]);
        (self.second.inputs, self.second.outputs) = ([0.0; B], [0.0; B]);
    }

    /// Returns two samples at the higher rate for one sample.
    pub(super) fn up(&mut self, sample: f32) -> [f32; 2] {
        [self.first.next(sample), self.second.next(sample)]
    }

    /// Returns one sample for two samples at the higher rate.
    pub(super) fn down(&mut self, [earlier, later]: [f32; 2]) -> f32 {
        0.5 * (self.first.next(later) + self.second.next(earlier))
    }
}

/// The coefficients of the chain, ascending: theta series of the elliptic functions (Valenzuela and Constantinides;
/// M. D. Lutovac, D. V. Tošić and B. L. Evans, *Filter Design for Signal Processing*, 2001).
fn coefficients<const A: usize, const B: usize>(transition: f64) -> ([f64; A], [f64; B]) {
    let count = A + B;
    let order = (2 * count + 1) as f64;
    let edge = tan((1.0 - 2.0 * transition) * FRAC_PI_4);
    let k = edge * edge;
    let root = sqrt(sqrt(1.0 - k * k));
    let e = 0.5 * (1.0 - root) / (1.0 + root);
    let e4 = e * e * e * e;
    let q = e * (1.0 + e4 * (2.0 + e4 * (15.0 + 150.0 * e4)));
    let coefficient = |index: usize| {
        let angle = (index + 1) as f64 * PI / order;
        let (mut upper, mut lower) = (0.0, 0.5);
        for i in 0..8 {
            let (i, sign) = (f64::from(i), if i % 2 == 0 { 1.0 } else { -1.0 });
            upper += sign * pow(q, i * (i + 1.0)) * sin((2.0 * i + 1.0) * angle);
            if i > 0.0 {
                lower += sign * pow(q, i * i) * cos(2.0 * i * angle);
            }
        }
        let ratio = upper * pow(q, 0.25) / lower;
        let square = ratio * ratio;
        let x = sqrt((1.0 - square * k) * (1.0 - square / k)) / (1.0 + square);
        (1.0 - x) / (1.0 + x)
    };
    (std::array::from_fn(coefficient), std::array::from_fn(|n| coefficient(A + n)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gain of the downsampling at a frequency, as a fraction of the higher rate.
    fn gain(filter: &HalfBand<6, 6>, frequency: f64) -> f64 {
        let mut filter = *filter;
        let mut peak = 0.0_f64;
        for n in 0..8000 {
            let at = |n: usize| sin(2.0 * PI * frequency * n as f64) as f32;
            let out = filter.down([at(2 * n), at(2 * n + 1)]);
            if n > 4000 {
                peak = peak.max(f64::from(out).abs());
            }
        }
        peak
    }

    #[test]
    fn half_of_the_band_passes() {
        let filter = HalfBand::<6, 6>::new(0.02);
        // No frequency with a short period, since samples could miss its peaks.
        for frequency in [0.0103, 0.1007, 0.2013, 0.2391] {
            assert!((gain(&filter, frequency) - 1.0).abs() < 0.01, "{} at {frequency}", gain(&filter, frequency));
        }
        for frequency in [0.2605, 0.3, 0.4, 0.49] {
            assert!(gain(&filter, frequency) < 1e-5, "{} at {frequency}", gain(&filter, frequency));
        }
    }
}
