//! The pole of a mode, which is its frequency and decay, and sums over powers of poles.

use libm::{exp, log, sincos};
use nalgebra::DMatrix;
use sprung_fourier::Complex;

/// Samples per block: within it powers come from a table, from block to block from a recurrence.
const BLOCK: usize = 64;
/// Number of blocks after which the recurrence starts from an exact power again.
const ANCHOR: usize = 16;
/// Number of poles whose sums are computed side by side, and numbers per pole: two complex sums.
const SIDE_BY_SIDE: usize = 16;
const PARTS: usize = 4;
/// Distance below which two poles coincide, as a share of their width.
const COINCIDING: f64 = 0.05;
/// `|zⁿ|` below which a mode is over: −280 dB.
const OVER: f64 = 1e-14;

/// `ln z = −decay + i·theta` of a damped sinusoid `Re a·zⁿ`, per sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pole {
    pub(super) decay: f64,
    pub(super) theta: f64,
}

impl Pole {
    /// The pole of a constant.
    pub(super) const CONSTANT: Self = Self { decay: 0.0, theta: 0.0 };

    /// `zⁿ`.
    pub(super) fn power(self, n: usize) -> Complex<f64> {
        let (sin, cos) = sincos(self.theta * n as f64);
        let radius = exp(-self.decay * n as f64);
        Complex::new(radius * cos, radius * sin)
    }

    /// The first of `len` samples at which the mode is over.
    pub(super) fn end(self, len: usize) -> usize {
        let end = if self.decay > 0.0 { -log(OVER) / self.decay } else { f64::INFINITY };
        if end < len as f64 { end as usize + 1 } else { len }
    }

    /// Whether it almost coincides with another one over `len` samples. Real pairs of modes beat.
    pub(super) fn coincides(self, other: Self, len: usize) -> bool {
        let distance = libm::hypot(self.theta - other.theta, self.decay - other.decay);
        distance <= COINCIDING * self.width(len).min(other.width(len))
    }

    /// Half the width of its resonance in radians per sample, but not less than `len` samples can resolve.
    pub(super) fn width(self, len: usize) -> f64 {
        self.decay.max(1.0 / len as f64)
    }
}

/// `|z|`. `Complex::norm` calls the system's library, whose last bit differs from system to system.
pub(super) fn magnitude(z: Complex<f64>) -> f64 {
    libm::hypot(z.re, z.im)
}

/// `Σ y·z̄ⁿ` and `Σ τ·y·z̄ⁿ` with `τ = n/len`, for each pole.
pub(super) fn correlations(samples: &[f64], poles: &[Pole]) -> Vec<[Complex<f64>; 2]> {
    // Poles that ring about as long go side by side, since a group takes as long as its longest.
    let mut order: Vec<usize> = (0..poles.len()).collect();
    order.sort_unstable_by(|a, b| poles[*a].decay.total_cmp(&poles[*b].decay));
    let mut found = vec![[Complex::ZERO; 2]; poles.len()];
    for places in order.chunks(SIDE_BY_SIDE) {
        let together: Vec<Pole> = places.iter().map(|place| poles[*place]).collect();
        let end = together.iter().map(|pole| pole.end(samples.len())).max().unwrap_or(0);
        for (place, [sum, moment]) in places.iter().zip(sums_of_group(&samples[..end], &together)) {
            found[*place] = [sum, moment / samples.len() as f64];
        }
    }
    found
}

/// `Σ y·z̄ⁿ` and `Σ n·y·z̄ⁿ` for each pole.
///
/// The sums of every block, as if it were the first one, are the product of a table of powers with the samples, which a matrix
/// product does fastest.
fn sums_of_group(samples: &[f64], poles: &[Pole]) -> Vec<[Complex<f64>; 2]> {
    let parts = |(n, pole): (usize, &Pole)| {
        let z = pole.power(n).conj();
        [z.re, z.im, n as f64 * z.re, n as f64 * z.im]
    };
    let powers = (0..BLOCK).flat_map(|n| poles.iter().map(move |pole| (n, pole)).flat_map(parts));
    let table = DMatrix::from_iterator(PARTS * poles.len(), BLOCK, powers);
    let mut sums = vec![[Complex::ZERO; 2]; poles.len()];
    let mut start = 0;
    for stretch in samples.chunks(ANCHOR * BLOCK) {
        let mut blocks = DMatrix::zeros(BLOCK, stretch.len().div_ceil(BLOCK));
        blocks.as_mut_slice()[..stretch.len()].copy_from_slice(stretch);
        let locals = &table * blocks;
        for ((pole, sums), first) in poles.iter().zip(&mut sums).zip((0..).step_by(PARTS)) {
            let (mut z, step) = (pole.power(start).conj(), pole.power(BLOCK).conj());
            for (block, local) in locals.column_iter().enumerate() {
                let sum = z * Complex::new(local[first], local[first + 1]);
                let moment = z * Complex::new(local[first + 2], local[first + 3]);
                sums[0] += sum;
                sums[1] += moment + sum * (start + block * BLOCK) as f64;
                z *= step;
            }
        }
        start += stretch.len();
    }
    sums
}

/// Adds `factor · Re(a·zⁿ)` to the samples.
pub(super) fn add(samples: &mut [f64], pole: Pole, amplitude: Complex<f64>, factor: f64) {
    let end = pole.end(samples.len());
    let table: [Complex<f64>; BLOCK] = std::array::from_fn(|n| pole.power(n));
    let (re, im) = (table.map(|z| z.re), table.map(|z| z.im));
    let (step, mut z) = (pole.power(BLOCK), Complex::ZERO);
    for (index, block) in samples[..end].chunks_mut(BLOCK).enumerate() {
        if index.is_multiple_of(ANCHOR) {
            z = amplitude * pole.power(index * BLOCK) * factor;
        }
        for (sample, (re, im)) in block.iter_mut().zip(re.iter().zip(&im)) {
            *sample += z.re * re - z.im * im;
        }
        z *= step;
    }
}

/// The lengths through which [`Ladder::sums`] goes: each is twice the one before, or one more.
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

    /// `Σ τᵐ·wⁿ` with `τ = n/len` for `m` of 0, 1 and 2, where `w` is the product of two poles, of which the
    /// first may be `conjugated`. The doubling loses no precision if `w` lies in the unit disk.
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
