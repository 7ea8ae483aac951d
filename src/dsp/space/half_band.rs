//! Twice the sample rate and back: half-band filters of two branches of allpass filters.

use libm::{cos, pow, sin, sqrt, tan};
use std::f64::consts::{FRAC_PI_4, PI};

/// A sample of the left and of the right side.
pub(super) type Both = [f32; 2];

/// An elliptic half-band filter of order `4 N + 1` for both sides, as two branches of `N` allpass filters
/// `(c + z⁻¹)/(1 + c z⁻¹)` at the lower of the two rates. (R. A. Valenzuela and A. G. Constantinides, "Digital signal
/// processing schemes for efficient interpolation and decimation", IEE Proc. 130 G (1983).) It has minimum delay, not linear
/// phase. Real-time safe.
///
/// The two branches of the two sides are four lanes of one vector: the first branch of left and right, then the second.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfBand<const N: usize> {
    coefficients: [[f32; 4]; N],
    /// The last input and the last output of each filter.
    inputs: [[f32; 4]; N],
    outputs: [[f32; 4]; N],
}

impl<const N: usize> HalfBand<N> {
    /// A filter whose pass band ends at `0.25 − transition/2` of the higher rate, and whose stop band begins at
    /// `0.25 + transition/2`.
    pub(super) fn new(transition: f64) -> Self {
        let coefficients = std::array::from_fn(|n| {
            let [first, second] = [0, 1].map(|branch| coefficient(transition, 2 * n + branch, 2 * N) as f32);
            [first, first, second, second]
        });
        Self { coefficients, inputs: [[0.0; 4]; N], outputs: [[0.0; 4]; N] }
    }

    /// Resets the state to silence.
    pub(super) fn clear(&mut self) {
        (self.inputs, self.outputs) = ([[0.0; 4]; N], [[0.0; 4]; N]);
    }

    #[inline(always)]
    fn next(&mut self, mut sample: [f32; 4]) -> [f32; 4] {
        for ((coefficients, inputs), outputs) in self.coefficients.iter().zip(&mut self.inputs).zip(&mut self.outputs) {
            let mut out = [0.0; 4];
            for lane in 0..4 {
                out[lane] = coefficients[lane] * (sample[lane] - outputs[lane]) + inputs[lane];
            }
            (*inputs, *outputs) = (sample, out);
            sample = out;
        }
        sample
    }

    /// Returns two samples at the higher rate for one sample.
    #[inline(always)]
    pub(super) fn up(&mut self, [left, right]: Both) -> [Both; 2] {
        let [left_earlier, right_earlier, left_later, right_later] = self.next([left, right, left, right]);
        [[left_earlier, right_earlier], [left_later, right_later]]
    }

    /// Returns one sample for two samples at the higher rate.
    #[inline(always)]
    pub(super) fn down(&mut self, [earlier, later]: [Both; 2]) -> Both {
        let [left_first, right_first, left_second, right_second] =
            self.next([later[0], later[1], earlier[0], earlier[1]]);
        [0.5 * (left_first + left_second), 0.5 * (right_first + right_second)]
    }
}

/// One of `count` coefficients, ascending; even ones belong to the first branch. By theta series of the elliptic functions
/// (Valenzuela and Constantinides; M. D. Lutovac, D. V. Tošić and B. L. Evans, *Filter Design for Signal Processing*, 2001).
fn coefficient(transition: f64, index: usize, count: usize) -> f64 {
    let order = (2 * count + 1) as f64;
    let edge = tan((1.0 - 2.0 * transition) * FRAC_PI_4);
    let k = edge * edge;
    let root = sqrt(sqrt(1.0 - k * k));
    let e = 0.5 * (1.0 - root) / (1.0 + root);
    let e4 = e * e * e * e;
    let q = e * (1.0 + e4 * (2.0 + e4 * (15.0 + 150.0 * e4)));
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
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gain of the downsampling at a frequency, as a fraction of the higher rate.
    fn gain(filter: &HalfBand<6>, frequency: f64) -> f64 {
        let mut filter = *filter;
        let mut peak = 0.0_f64;
        for n in 0..8000 {
            let at = |n: usize| sin(2.0 * PI * frequency * n as f64) as f32;
            // The right side has the opposite sign, so that it is another signal.
            let [left, right] = filter.down([at(2 * n), at(2 * n + 1)].map(|sample| [sample, -sample]));
            assert_eq!(left, -right);
            if n > 4000 {
                peak = peak.max(f64::from(left).abs());
            }
        }
        peak
    }

    #[test]
    fn half_of_the_band_passes() {
        let filter = HalfBand::<6>::new(0.02);
        // No frequency with a short period, since samples could miss its peaks.
        for frequency in [0.0103, 0.1007, 0.2013, 0.2391] {
            assert!((gain(&filter, frequency) - 1.0).abs() < 0.01, "{} at {frequency}", gain(&filter, frequency));
        }
        for frequency in [0.2605, 0.3, 0.4, 0.49] {
            assert!(gain(&filter, frequency) < 1e-5, "{} at {frequency}", gain(&filter, frequency));
        }
    }
}
