//! Powers and sines of whole rows of numbers, by series without branches that the compiler turns into vector instructions.
//!
//! A strike needs several of them for each of up to 512 modes, within one block. `libm` takes 50 ns for a power; a row takes
//! 2 to 5 ns each. Plain double precision in a frozen order: the bits are the same on every CPU. All functions are real-time
//! safe. Numbers beyond the shorter slice are not computed.

use super::simd::vector::Vector;
use super::simd::{Instructions, Kernel};
use std::f64::consts::{LN_2, PI};

/// 1 / n! for n from 13 down to 0: the factors of the exponential series.
const INVERSE_FACTORIALS: [f64; 14] = {
    let (mut factors, mut n) = ([1.0; 14], 1);
    while n < 14 {
        factors[13 - n] = factors[14 - n] / n as f64;
        n += 1;
    }
    factors
};

/// Adding this rounds to the nearest integer, which the lowest bits of the sum then contain, negative ones as complement.
pub(crate) const ROUND: f64 = 6_755_399_441_055_744.0;

/// Sets `out[m]` to `2^(exponent · octaves[m])`, that is to the power `exponent` of the number whose logarithm to base 2 is
/// `octaves[m]`. The relative error is below 1e−15. The octaves of the result are limited to ±1000.
pub(crate) fn powers(octaves: &[f64], exponent: f64, out: &mut [f64]) {
    Instructions::current().run(Powers { octaves, exponent, out });
}

/// Sets `out[m]` to the sine of `half_turns · ratios[m] + offset` half turns: π each. An offset of ½ gives the cosine. The
/// error is below 1e−14 plus 7e−16 for each half turn.
pub(crate) fn sines(ratios: &[f64], half_turns: f64, offset: f64, out: &mut [f64]) {
    Instructions::current().run(Sines { ratios, half_turns, offset, out });
}

struct Powers<'a> {
    octaves: &'a [f64],
    exponent: f64,
    out: &'a mut [f64],
}

impl Kernel for Powers<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V::Proof) {
        for (out, octaves) in self.out.iter_mut().zip(self.octaves) {
            *out = exp2(self.exponent * octaves);
        }
    }
}

struct Sines<'a> {
    ratios: &'a [f64],
    half_turns: f64,
    offset: f64,
    out: &'a mut [f64],
}

impl Kernel for Sines<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V::Proof) {
        for (out, ratio) in self.out.iter_mut().zip(self.ratios) {
            *out = sine_of_half_turns(self.half_turns * ratio + self.offset);
        }
    }
}

#[inline(always)]
fn exp2(x: f64) -> f64 {
    let x = if x > -1000.0 { x } else { -1000.0 };
    let x = if x < 1000.0 { x } else { 1000.0 };
    let rounded = x + ROUND;
    let y = LN_2 * (x - (rounded - ROUND));
    // The series of e^y for |y| ≤ ½ ln 2. The first omitted term is below 2e−16.
    let mut sum = 0.0;
    for factor in &INVERSE_FACTORIALS[1..] {
        sum = sum * y + factor;
    }
    // The integer, in the place of the exponent.
    sum * f64::from_bits((rounded.to_bits() << 52).wrapping_add(1.0_f64.to_bits()))
}

#[inline(always)]
fn sine_of_half_turns(x: f64) -> f64 {
    let rounded = x + ROUND;
    let sine = sin_to_right_angle(PI * (x - (rounded - ROUND)));
    // Negative after an odd number of half turns.
    f64::from_bits(sine.to_bits() ^ (rounded.to_bits() << 63))
}

/// `r − 1` from `ln r`, for −1.8 ≤ ln r ≤ 0.
#[inline(always)]
pub(in crate::dsp) fn expm1_of_radius(ln_radius: f64) -> f64 {
    // Computed for a quarter of `ln r`; then (1+u)² − 1 = u (2+u), twice. No digits are lost for r close to 1.
    let y = 0.25 * ln_radius;
    let mut sum = 0.0;
    // The series of (e^y − 1)/y. The first omitted term is below 5e−16 of the sum.
    for factor in &INVERSE_FACTORIALS[..13] {
        sum = sum * y + factor;
    }
    let u = sum * y;
    let u = u * (2.0 + u);
    u * (2.0 + u)
}

/// `sin x` for −π/2 ≤ x ≤ π/2, from its series, with an error below 5e−15.
#[inline(always)]
pub(in crate::dsp) fn sin_to_right_angle(x: f64) -> f64 {
    let x2 = x * x;
    let mut sum = 1.0;
    for n in [18.0_f64, 16.0, 14.0, 12.0, 10.0, 8.0, 6.0, 4.0, 2.0] {
        sum = 1.0 - sum * x2 * (1.0 / (n * (n + 1.0)));
    }
    sum * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::simd::vector::Scalar;
    use libm::{cos, fabs, sin};

    fn row(len: usize, from: f64, to: f64) -> Vec<f64> {
        (0..len).map(|n| from + (to - from) * n as f64 / (len - 1) as f64).collect()
    }

    #[test]
    fn powers_are_those_of_libm() {
        let octaves = row(100_001, -7.0, 10.0);
        let mut out = vec![0.0; octaves.len()];
        for exponent in [0.0, 1.0, -1.0, 0.37, -2.9, 1e-9, 40.0] {
            powers(&octaves, exponent, &mut out);
            for (octaves, power) in octaves.iter().zip(&out) {
                let exact = libm::exp2(exponent * octaves);
                assert!(fabs(power / exact - 1.0) < 1e-15, "2^({exponent} · {octaves}): {power}, {exact}");
            }
        }
        powers(&[f64::INFINITY, f64::NEG_INFINITY, 0.0], 1.0, &mut out);
        assert_eq!(out[..3], [libm::exp2(1000.0), libm::exp2(-1000.0), 1.0]);
    }

    #[test]
    fn sines_are_those_of_libm() {
        let ratios = row(100_001, -3.0, 400.0);
        let mut out = vec![0.0; ratios.len()];
        for half_turns in [0.0, 0.3, -1.0] {
            sines(&ratios, half_turns, 0.0, &mut out);
            let worst = ratios.iter().zip(&out).map(|(x, sine)| fabs(sine - sin(PI * half_turns * x)));
            assert!(worst.fold(0.0, f64::max) < 2e-13);
            sines(&ratios, half_turns, 0.5, &mut out);
            let worst = ratios.iter().zip(&out).map(|(x, cosine)| fabs(cosine - cos(PI * half_turns * x)));
            assert!(worst.fold(0.0, f64::max) < 2e-13);
        }
    }

    #[test]
    fn vectors_give_the_bits_of_scalar_code() {
        let row = row(1001, -20.0, 20.0);
        let (mut vector, mut scalar) = (vec![0.0; row.len()], vec![0.0; row.len()]);
        powers(&row, 1.234, &mut vector);
        Powers { octaves: &row, exponent: 1.234, out: &mut scalar }.run::<Scalar>(());
        assert_eq!(vector, scalar);
        sines(&row, 1.234, 0.5, &mut vector);
        Sines { ratios: &row, half_turns: 1.234, offset: 0.5, out: &mut scalar }.run::<Scalar>(());
        assert_eq!(vector, scalar);
    }
}
