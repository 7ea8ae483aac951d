//! A mode's place in the plane of frequency and decay, and sums over its powers.

use libm::{exp, log, sincos};
use realfft::num_complex::Complex;

pub(super) use crate::analysis::damped_sine::LN_60_DB;

/// Samples after which a recurrence for `zⁿ` starts from an exact power again.
const ANCHOR: usize = 512;
/// Modes whose powers are stepped side by side.
const LANES: usize = 4;
/// `|zⁿ|` below which a mode is over: −280 dB.
const OVER: f64 = 1e-14;

/// `ln z = −decay + i·theta` of a damped sinusoid `Re a·zⁿ`, per sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pole {
    pub(super) decay: f64,
    pub(super) theta: f64,
}

impl Pole {
    /// A constant: the pole of what is no vibration.
    pub(super) const CONSTANT: Self = Self { decay: 0.0, theta: 0.0 };

    /// `zⁿ`.
    pub(super) fn power(self, n: usize) -> Complex<f64> {
        let (sin, cos) = sincos(self.theta * n as f64);
        let radius = exp(-self.decay * n as f64);
        Complex::new(radius * cos, radius * sin)
    }

    /// The first of `len` samples at which nothing is left of it.
    pub(super) fn end(self, len: usize) -> usize {
        let end = if self.decay > 0.0 { -log(OVER) / self.decay } else { f64::INFINITY };
        if end < len as f64 { end as usize + 1 } else { len }
    }

    /// Half the width of its resonance in radians per sample, no narrower than `len` samples can tell.
    pub(super) fn width(self, len: usize) -> f64 {
        self.decay.max(1.0 / len as f64)
    }
}

/// `Σ y·z̄ⁿ` and `Σ τ·y·z̄ⁿ` with `τ = n/len`, for each pole.
pub(super) fn correlations(samples: &[f64], poles: &[Pole]) -> Vec<[Complex<f64>; 2]> {
    let scale = 1.0 / samples.len() as f64;
    let mut found = Vec::with_capacity(poles.len());
    for poles in poles.chunks(LANES) {
        let mut step = [[0.0; LANES]; 2];
        for (lane, pole) in poles.iter().enumerate() {
            let z = pole.power(1);
            (step[0][lane], step[1][lane]) = (z.re, -z.im);
        }
        let end = poles.iter().map(|pole| pole.end(samples.len())).max().unwrap_or(0);
        let mut sums = [[0.0; LANES]; 4];
        for base in (0..end).step_by(ANCHOR) {
            let (mut re, mut im) = ([0.0; LANES], [0.0; LANES]);
            for (lane, pole) in poles.iter().enumerate() {
                let z = pole.power(base);
                (re[lane], im[lane]) = (z.re, -z.im);
            }
            for (n, y) in samples.iter().enumerate().take(end.min(base + ANCHOR)).skip(base) {
                let weighted = y * (n as f64 * scale);
                for lane in 0..LANES {
                    sums[0][lane] += y * re[lane];
                    sums[1][lane] += y * im[lane];
                    sums[2][lane] += weighted * re[lane];
                    sums[3][lane] += weighted * im[lane];
                    let turned = re[lane] * step[0][lane] - im[lane] * step[1][lane];
                    im[lane] = re[lane] * step[1][lane] + im[lane] * step[0][lane];
                    re[lane] = turned;
                }
            }
        }
        let sum = |lane: usize, at: usize| Complex::new(sums[at][lane], sums[at + 1][lane]);
        found.extend((0..poles.len()).map(|lane| [sum(lane, 0), sum(lane, 2)]));
    }
    found
}

/// Adds `factor · Re(a·zⁿ)` to the samples.
pub(super) fn add(samples: &mut [f64], pole: Pole, amplitude: Complex<f64>, factor: f64) {
    let end = pole.end(samples.len());
    let step = pole.power(1);
    for base in (0..end).step_by(ANCHOR) {
        let mut z = amplitude * pole.power(base) * factor;
        for sample in &mut samples[base..end.min(base + ANCHOR)] {
            *sample += z.re;
            z *= step;
        }
    }
}

/// Lengths whose sums [`Ladder::sums`] goes through: each the double of the one before, or one more than it.
pub(super) struct Ladder {
    /// From 1 to the whole length.
    lengths: Vec<usize>,
    /// For each pole, its powers at these lengths.
    powers: Vec<Vec<Complex<f64>>>,
}

impl Ladder {
    pub(super) fn new(poles: &[Pole], len: usize) -> Self {
        let mut lengths = vec![len];
        let mut rest = len;
        while rest > 1 {
            rest = if rest.is_multiple_of(2) { rest / 2 } else { rest - 1 };
            lengths.push(rest);
        }
        lengths.reverse();
        let powers = |pole: &Pole| lengths.iter().map(|len| pole.power(*len)).collect();
        Self { powers: poles.iter().map(powers).collect(), lengths }
    }

    /// `Σ τᵐ·wⁿ` with `τ = n/len` for `m` of 0, 1 and 2, where `w` is the product of two poles, the first of them
    /// conjugated if so wanted. By doubling, which loses no digits wherever `w` lies in the unit disk.
    pub(super) fn sums(&self, first: usize, second: usize, conjugated: bool) -> [Complex<f64>; 3] {
        let power = |at: usize| {
            let z = self.powers[first][at];
            (if conjugated { z.conj() } else { z }) * self.powers[second][at]
        };
        let mut sums = [Complex::new(1.0, 0.0), Complex::ZERO, Complex::ZERO];
        for at in 1..self.lengths.len() {
            let (len, w) = (self.lengths[at - 1] as f64, power(at - 1));
            let [s0, s1, s2] = sums;
            sums = if self.lengths[at] == 2 * self.lengths[at - 1] {
                [s0 + w * s0, s1 + w * (s1 + s0 * len), s2 + w * (s2 + s1 * (2.0 * len) + s0 * (len * len))]
            } else {
                [s0 + w, s1 + w * len, s2 + w * (len * len)]
            };
        }
        let len = self.lengths.last().copied().unwrap_or(1) as f64;
        [sums[0], sums[1] / len, sums[2] / (len * len)]
    }
}
