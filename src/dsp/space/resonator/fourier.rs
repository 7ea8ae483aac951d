//! The fast Fourier transform, with the same operations in the same order on every CPU.
//!
//! `X[k] = Σ x[n] e^(2πi kn/N)` for a power of two `N`, by halves: a stage takes the numbers `a` and `b` of both halves to `a + b`
//! and `(a − b) e^…`, of which each then has half the size. Four stages have constant geometry (M. C. Pease, 1968): they read both
//! halves and write pairs. After them, 16 neighbours need the same operations, so the other stages work on rows of 16, in place
//! and two stages at a time. (All stages in constant geometry took twice as long, half of it for constants.) The
//! result is in an order of its own; whoever reads it knows where ([`Fourier::place`]).

use crate::dsp::simd::Kernel;
use crate::dsp::simd::vector::{LANES, Vector};
use libm::{cos, sin};
use std::f64::consts::TAU;
use std::sync::OnceLock;

/// Two rows of numbers: real and imaginary parts, or left and right.
pub(super) type Pair = [Vec<f32>; 2];

/// The constants of a transform.
#[derive(Debug)]
pub(super) struct Fourier {
    size: usize,
    /// For each stage of constant geometry, the cosines and then the sines of its pairs. Those of the first are of all angles.
    factors: Vec<f32>,
    places: Vec<u16>,
}

/// Number of stages of constant geometry, after which neighbours fill [`LANES`]. An even number, so that their result is where
/// the input was.
const STAGES: u32 = LANES.trailing_zeros();

/// Largest size, as a power of two. Places are 16-bit numbers.
const LARGEST: usize = 16;

impl Fourier {
    /// The constants for a size of at least 32. All transforms of a size share them; the first call computes them, so do not
    /// make it on the audio thread.
    pub(super) fn of(size: usize) -> &'static Self {
        static SHARED: [OnceLock<Fourier>; LARGEST + 1] = [const { OnceLock::new() }; LARGEST + 1];
        SHARED[size.trailing_zeros() as usize].get_or_init(|| Self::new(size))
    }

    fn new(size: usize) -> Self {
        let half = size / 2;
        let mut factors = Vec::with_capacity(size * STAGES as usize);
        for stage in 0..STAGES {
            let angle = |pair: usize| TAU * ((pair >> stage) << stage) as f64 / size as f64;
            factors.extend((0..half).map(|pair| cos(angle(pair)) as f32));
            factors.extend((0..half).map(|pair| sin(angle(pair)) as f32));
        }
        // The lowest bits of `k` are in a row, and the others are the row, both reversed.
        let row_bits = size.trailing_zeros() - STAGES;
        let reversed = |number: usize, bits: u32| number.reverse_bits().unbounded_shr(usize::BITS - bits);
        let place = |k: usize| reversed(k >> STAGES, row_bits) * LANES + reversed(k % LANES, STAGES);
        Self { size, factors, places: (0..size).map(|k| place(k) as u16).collect() }
    }

    /// Number of points.
    pub(super) fn size(&self) -> usize {
        self.size
    }

    /// Where `X[k]` is in the result.
    #[inline(always)]
    pub(super) fn place(&self, k: usize) -> usize {
        self.places[k].into()
    }
}

/// Transforms complex numbers in place.
pub(super) struct Transform<'a> {
    pub(super) fourier: &'static Fourier,
    /// Real and imaginary parts.
    pub(super) values: &'a mut Pair,
    /// Room for as many numbers.
    pub(super) spare: &'a mut Pair,
}

impl Kernel for Transform<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, proof: V::Proof) {
        let Self { fourier, values, spare } = self;
        let mut stage = 0;
        while stage < STAGES as usize {
            pairs::<V>(proof, fourier, stage, values, spare);
            pairs::<V>(proof, fourier, stage + 1, spare, values);
            stage += 2;
        }
        let rows = fourier.size / LANES;
        let mut size = rows;
        while size >= 4 {
            for part in 0..rows / size {
                four_rows::<V>(proof, fourier, size, part * size, values);
            }
            size /= 4;
        }
        if size == 2 {
            for part in 0..rows / 2 {
                two_rows::<V>(proof, part * 2, values);
            }
        }
    }
}

/// A stage of constant geometry: pair `i` takes the numbers `i` of both halves to their sum, and to their difference times a
/// factor.
#[inline(always)]
fn pairs<V: Vector>(proof: V::Proof, fourier: &Fourier, stage: usize, from: &Pair, to: &mut Pair) {
    let half = fourier.size / 2;
    let (cosines, sines) = fourier.factors[stage * fourier.size..][..fourier.size].split_at(half);
    let ((real_a, real_b), (imaginary_a, imaginary_b)) = (from[0].split_at(half), from[1].split_at(half));
    let [real, imaginary] = to;
    let mut i = 0;
    while i < half {
        let a = [V::load(proof, &real_a[i..]), V::load(proof, &imaginary_a[i..])];
        let b = [V::load(proof, &real_b[i..]), V::load(proof, &imaginary_b[i..])];
        let factor = [V::load(proof, &cosines[i..]), V::load(proof, &sines[i..])];
        let (sum, other) = combine(a, b, factor);
        sum[0].store_pairs(other[0], &mut real[2 * i..]);
        sum[1].store_pairs(other[1], &mut imaginary[2 * i..]);
        i += V::WIDTH;
    }
}

/// Two stages of `size` rows from `start` on.
#[inline(always)]
fn four_rows<V: Vector>(proof: V::Proof, fourier: &Fourier, size: usize, start: usize, [real, imaginary]: &mut Pair) {
    let (cosines, sines) = fourier.factors[..fourier.size].split_at(fourier.size / 2);
    let (quarter, step) = (size / 4, fourier.size / size);
    macro_rules! factor {
        ($row:expr) => {
            [V::splat(proof, cosines[$row * step]), V::splat(proof, sines[$row * step])]
        };
    }
    for row in 0..quarter {
        let (first, second, both) = (factor!(row), factor!(row + quarter), factor!(2 * row));
        let mut i = (start + row) * LANES;
        let (next, end) = (quarter * LANES, i + LANES);
        while i < end {
            macro_rules! load {
                ($part:literal) => {
                    [V::load(proof, &real[i + $part * next..]), V::load(proof, &imaginary[i + $part * next..])]
                };
            }
            let (a, c) = combine(load!(0), load!(2), first);
            let (b, d) = combine(load!(1), load!(3), second);
            let ((a, b), (c, d)) = (combine(a, b, both), combine(c, d, both));
            macro_rules! store {
                ($part:literal, $value:ident) => {
                    $value[0].store(&mut real[i + $part * next..]);
                    $value[1].store(&mut imaginary[i + $part * next..]);
                };
            }
            store!(0, a);
            store!(1, b);
            store!(2, c);
            store!(3, d);
            i += V::WIDTH;
        }
    }
}

/// A last stage, of two rows.
#[inline(always)]
fn two_rows<V: Vector>(proof: V::Proof, start: usize, values: &mut Pair) {
    for part in values {
        let mut i = start * LANES;
        let end = i + LANES;
        while i < end {
            let (a, b) = (V::load(proof, &part[i..]), V::load(proof, &part[i + LANES..]));
            a.add(b).store(&mut part[i..]);
            a.sub(b).store(&mut part[i + LANES..]);
            i += V::WIDTH;
        }
    }
}

/// The sum, and the difference times a factor.
#[inline(always)]
fn combine<V: Vector>(a: [V; 2], b: [V; 2], [c, s]: [V; 2]) -> ([V; 2], [V; 2]) {
    let (re, im) = (a[0].sub(b[0]), a[1].sub(b[1]));
    ([a[0].add(b[0]), a[1].add(b[1])], [im.neg_mul_add(s, re.mul(c)), im.mul_add(c, re.mul(s))])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::random::{key, uniform};
    use crate::dsp::simd::Instructions;
    use libm::sqrt;

    #[test]
    fn transforms_are_those_of_the_definition() {
        for size in [32, 128, 1024] {
            let fourier = Fourier::of(size);
            let given: Pair = [0, 1].map(|part| (0..size as u64).map(|n| uniform(key(3, part), n)).collect());
            let (mut values, mut spare) = (given.clone(), [vec![0.0; size], vec![0.0; size]]);
            Instructions::current().run(Transform { fourier, values: &mut values, spare: &mut spare });
            let (mut error, mut all) = (0.0, 0.0);
            for k in 0..size {
                let mut exact = [0.0; 2];
                for (n, (re, im)) in given[0].iter().zip(&given[1]).enumerate() {
                    let angle = TAU * (k * n % size) as f64 / size as f64;
                    let (re, im) = (f64::from(*re), f64::from(*im));
                    exact[0] += re * cos(angle) - im * sin(angle);
                    exact[1] += re * sin(angle) + im * cos(angle);
                }
                for part in 0..2 {
                    let found = f64::from(values[part][fourier.place(k)]);
                    error += (found - exact[part]) * (found - exact[part]);
                    all += exact[part] * exact[part];
                }
            }
            assert!(sqrt(error / all) < 3e-7, "{size}: {:e}", sqrt(error / all));
        }
    }
}
