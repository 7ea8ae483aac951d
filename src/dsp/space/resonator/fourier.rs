//! The fast Fourier transform, with the same operations in the same order on every CPU.
//!
//! `X[k] = Σ x[n] e^(2πi kn/N)` for a power of two `N`, by stages of constant geometry (M. C. Pease, 1968): each reads both
//! halves of the numbers and writes pairs. So all stages are the same code for vectors of every width. The result is in
//! bit-reversed order; whoever reads it knows where ([`Fourier::place`]).

use crate::dsp::simd::Kernel;
use crate::dsp::simd::vector::Vector;
use libm::{cos, sin};
use std::f64::consts::TAU;
use std::sync::OnceLock;

/// Two rows of numbers: real and imaginary parts, or left and right.
pub(super) type Pair = [Vec<f32>; 2];

/// The constants of a transform.
#[derive(Debug)]
pub(super) struct Fourier {
    size: usize,
    stages: u32,
    /// For each of the first stages, the cosines and then the sines of its pairs.
    factors: Vec<f32>,
    places: Vec<u16>,
}

/// Number of stages with factors of their own. In a later stage, 16 neighbouring pairs have the same factor: that of the first of
/// them in the first stage. Rows for all stages would take longer to fetch from memory than the work takes.
const OWN: u32 = 4;

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
        let stages = size.trailing_zeros();
        let half = size / 2;
        let mut factors = Vec::with_capacity(size * OWN as usize);
        for stage in 0..OWN {
            let angle = |pair: usize| TAU * ((pair >> stage) << stage) as f64 / size as f64;
            factors.extend((0..half).map(|pair| cos(angle(pair)) as f32));
            factors.extend((0..half).map(|pair| sin(angle(pair)) as f32));
        }
        let places = (0..size as u32).map(|k| (k.reverse_bits() >> (32 - stages)) as u16).collect();
        Self { size, stages, factors, places }
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
        for stage in 0..fourier.stages {
            let (from, to) = if stage % 2 == 0 { (&*values, &mut *spare) } else { (&*spare, &mut *values) };
            match stage < OWN {
                true => combine::<V, true>(proof, fourier, stage, from, to),
                false => combine::<V, false>(proof, fourier, stage, from, to),
            }
        }
        if fourier.stages % 2 == 1 {
            for (value, spare) in values.iter_mut().zip(spare) {
                value.copy_from_slice(spare);
            }
        }
    }
}

/// One stage: pair `i` takes the numbers `i` of both halves to their sum, and to their difference times a factor.
#[inline(always)]
fn combine<V: Vector, const OWN: bool>(proof: V::Proof, fourier: &Fourier, stage: u32, from: &Pair, to: &mut Pair) {
    let half = fourier.size / 2;
    let own = if OWN { stage as usize * fourier.size } else { 0 };
    let (cosines, sines) = fourier.factors[own..own + fourier.size].split_at(half);
    let ((real_a, real_b), (imaginary_a, imaginary_b)) = (from[0].split_at(half), from[1].split_at(half));
    let [real, imaginary] = to;
    let (real, imaginary) = (&mut real[..2 * half], &mut imaginary[..2 * half]);
    let mut i = 0;
    while i < half {
        let (ar, br) = (V::load(proof, &real_a[i..]), V::load(proof, &real_b[i..]));
        let (ai, bi) = (V::load(proof, &imaginary_a[i..]), V::load(proof, &imaginary_b[i..]));
        let (c, s) = if OWN {
            (V::load(proof, &cosines[i..]), V::load(proof, &sines[i..]))
        } else {
            let first = (i >> stage) << stage;
            (V::splat(proof, cosines[first]), V::splat(proof, sines[first]))
        };
        let (dr, di) = (ar.sub(br), ai.sub(bi));
        ar.add(br).store_pairs(di.neg_mul_add(s, dr.mul(c)), &mut real[2 * i..]);
        ai.add(bi).store_pairs(di.mul_add(c, dr.mul(s)), &mut imaginary[2 * i..]);
        i += V::WIDTH;
    }
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
                for n in 0..size {
                    let angle = TAU * (k * n % size) as f64 / size as f64;
                    let (re, im) = (f64::from(given[0][n]), f64::from(given[1][n]));
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
