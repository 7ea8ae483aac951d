//! The tables of freely ringing modes: a state's displacement over the next sixteen frames, and the state after them.
//!
//! A freely ringing mode is a point that turns: `x = A sin φ` and, a quarter period later, `y = A cos φ`. One frame
//! multiplies `y + ix` by `z = r e^(iθ)`, so after `n` frames the displacement is `Re zⁿ · x + Im zⁿ · y`. In these
//! coordinates, a rounding error of the coefficients is an error of pitch or decay of the same relative size, at every
//! pitch. Powers of the step's own matrix, in `x` and `v`, had errors of up to 37 % of T60 near half the sample rate,
//! and still 0.2 % at 22 kHz when the diagonal was stored as a difference from 1.
//!
//! With the diagonal stored as an integer and a remainder, the pitch was wrong by 0.017 cents. Here each coefficient is
//! stored as the sum of two numbers, and T60 is exact to 6e−6 %.

use super::MAX_MODES;
use super::rows::{Row, Wide};
use super::tuning::below_top;
use crate::dsp::series::{expm1_of_radius, sin_to_right_angle};
use crate::dsp::simd::Kernel;
use crate::dsp::simd::vector::Vector;

/// Frames that a table covers; two windows are a control tick. Must not change: the accepted bits depend on it.
pub(super) const WINDOW: usize = 16;

/// The displacement after `j + 1` frames is `taps[2j]·x + taps[2j+1]·y`.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Taps(pub(super) [f32; 2 * WINDOW]);

/// Rotation and decay of each mode over a window: real and imaginary part of `z¹⁶`, each as the sum of two numbers. With one
/// number each, T60 would be wrong by up to 0.1 % at 20 s and 192 kHz.
#[derive(Clone, Debug)]
pub(super) struct Turn {
    pub(super) real: Row,
    pub(super) real_rest: Row,
    pub(super) imaginary: Row,
    pub(super) imaginary_rest: Row,
}

/// Both coordinates of each mode as a pair, at the start of each window of a tick.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Pairs(pub(super) [[[f32; 2]; MAX_MODES]; 2]);

/// The tables of all modes of a bank.
#[derive(Clone, Debug)]
pub(super) struct Table {
    pub(super) taps: [Taps; MAX_MODES],
    pub(super) turn: Turn,
    /// The states of the tick, times the left and the right gains.
    pub(super) pairs: [Pairs; 2],
}

impl Table {
    pub(super) const EMPTY: Table = Table {
        taps: [Taps([0.0; 2 * WINDOW]); MAX_MODES],
        turn: Turn { real: Row::ZERO, real_rest: Row::ZERO, imaginary: Row::ZERO, imaginary_rest: Row::ZERO },
        pairs: [const { Pairs([[[0.0; 2]; MAX_MODES]; 2]) }; 2],
    };
}

/// Makes the tables of the first `len` modes at a pitch ratio. Does not change the others.
pub(super) struct Build<'a> {
    pub(super) table: &'a mut Table,
    pub(super) ln_radius: &'a Wide,
    pub(super) half_angle: &'a Wide,
    pub(super) ratio: f64,
    pub(super) len: usize,
}

impl Kernel for Build<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V::Proof) {
        let Self { table: Table { taps, turn, .. }, ln_radius, half_angle, ratio, len } = self;
        for m in 0..len.min(MAX_MODES) {
            let radius = 1.0 + expm1_of_radius(ln_radius[m]);
            let half_chord = sin_to_right_angle(below_top(half_angle[m] * ratio));
            let chord2 = half_chord * half_chord;
            let z = Complex(radius * (1.0 - 2.0 * chord2), 2.0 * radius * half_chord * (1.0 - chord2).sqrt());
            let z2 = z.times(z);
            let z4 = z2.times(z2);
            let z8 = z4.times(z4);
            let z16 = z8.times(z8);
            (turn.real.0[m], turn.real_rest.0[m]) = halves(z16.0);
            (turn.imaginary.0[m], turn.imaginary_rest.0[m]) = halves(z16.1);
            let mut powers = [z; WINDOW];
            for (n, power) in [(1, z), (2, z2), (4, z4), (8, z8)] {
                for j in 0..n {
                    powers[n + j] = powers[j].times(power);
                }
            }
            let (taps, _) = taps[m].0.as_chunks_mut::<2>();
            for j in 0..WINDOW {
                taps[j] = [powers[j].0 as f32, powers[j].1 as f32];
            }
        }
    }
}

/// A number as the sum of two single-precision numbers.
#[inline(always)]
fn halves(value: f64) -> (f32, f32) {
    let nearest = value as f32;
    (nearest, (value - f64::from(nearest)) as f32)
}

/// Real and imaginary part.
#[derive(Clone, Copy)]
struct Complex(f64, f64);

impl Complex {
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::coefficients::LN_MINUS_60_DB;
    use crate::dsp::random::{key, uniform};
    use crate::dsp::simd::vector::Scalar;
    use libm::{atan2, log, pow};
    use std::f64::consts::PI;

    /// Compares pitch and decay of the rounded tables with the requested ones, over everything that a voice can
    /// request: from 8 Hz up, at 8 to 192 kHz, T60 up to 60 s.
    #[test]
    fn windows_keep_pitch_and_decay() {
        let stream = key(17, 0);
        let unit = |n: u64| f64::from(uniform(stream, n)) * 0.5 + 0.5;
        let mut table = Table::EMPTY;
        let (mut cents_worst, mut t60_worst) = (0.0_f64, 0.0_f64);
        for case in 0..20_000 {
            let rate = [8_000.0, 44_100.0, 48_000.0, 96_000.0, 192_000.0][(case % 5) as usize];
            let frequency = 8.0 * pow(0.49 * rate / 8.0, unit(3 * case));
            // A mode that decays within one period has no measurable pitch.
            let t60 = (0.01 * pow(6_000.0, unit(3 * case + 1))).max(1.0 / frequency);
            let ln_radius = [LN_MINUS_60_DB / (t60 * rate); MAX_MODES];
            // Half the angle comes from here, the other half from the ratio of 2.
            let half_angle = [0.5 * PI * frequency / rate; MAX_MODES];
            let build = Build { table: &mut table, ln_radius: &ln_radius, half_angle: &half_angle, ratio: 2.0, len: 1 };
            build.run::<Scalar>(());
            let turn = &table.turn;
            let real = f64::from(turn.real.0[0]) + f64::from(turn.real_rest.0[0]);
            let imaginary = f64::from(turn.imaginary.0[0]) + f64::from(turn.imaginary_rest.0[0]);
            let expected = 16.0 * 2.0 * PI * frequency / rate;
            let turned = atan2(imaginary, real) - expected;
            let off = turned - 2.0 * PI * libm::round(turned / (2.0 * PI));
            let cents = 1200.0 * off.abs() / expected / std::f64::consts::LN_2;
            let decay = 0.5 * log(real * real + imaginary * imaginary) / 16.0;
            let percent = 100.0 * (decay / (-6.907_755_278_982_137 / (t60 * rate)) - 1.0).abs();
            cents_worst = cents_worst.max(cents);
            t60_worst = t60_worst.max(percent);
        }
        println!("at worst {cents_worst:.2e} cents, {t60_worst:.2e} % of T60");
        assert!(cents_worst < 0.001 && t60_worst < 0.001);
    }
}
