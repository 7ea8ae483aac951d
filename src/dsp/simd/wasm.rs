//! Vectors for WebAssembly’s simd128, which has no fused multiplication: every number is stored in double precision.
//!
//! This is like `super::sse2`, which explains when sums of double precision may be rounded. A module with these instructions
//! loads only if the runtime has them, so a program that is compiled for them may use them.

use super::fused::{LOST, repaired};
use super::vector::Vector;
use std::arch::wasm32::*;

/// Four single-precision numbers, stored in double precision.
#[derive(Clone, Copy)]
pub(super) struct Simd128([v128; 2]);

/// Applies the same operation to both halves.
macro_rules! halves {
    ($half:ident => $result:expr) => {{
        let of = |$half: usize| $result;
        Self([of(0), of(1)])
    }};
}

impl Vector for Simd128 {
    type Proof = ();
    const WIDTH: usize = 4;

    #[inline(always)]
    fn splat((): (), value: f32) -> Self {
        halves!(_half => f64x2_splat(f64::from(value)))
    }
    #[inline(always)]
    fn load((): (), from: &[f32]) -> Self {
        let from = &from[..4];
        // SAFETY: the slice has the four numbers that are read.
        Self(wide(unsafe { v128_load(from.as_ptr().cast()) }))
    }
    #[inline(always)]
    fn splat_pair((): (), [a, b]: &[f32; 2]) -> Self {
        halves!(_half => f64x2(f64::from(*a), f64::from(*b)))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..4];
        // SAFETY: the slice has the four numbers that are written.
        unsafe { v128_store(to.as_mut_ptr().cast(), self.narrow()) }
    }
    #[inline(always)]
    fn store_pairs(self, other: Self, to: &mut [f32]) {
        let to = &mut to[..8];
        let (a, b) = (self.narrow(), other.narrow());
        // SAFETY: the slice has the eight numbers that are written.
        unsafe {
            v128_store(to.as_mut_ptr().cast(), i32x4_shuffle::<0, 4, 1, 5>(a, b));
            v128_store(to[4..].as_mut_ptr().cast(), i32x4_shuffle::<2, 6, 3, 7>(a, b));
        }
    }
    #[inline(always)]
    fn add_pairs(self, other: Self) -> Self {
        let of = [self.0, other.0];
        halves!(half => {
            let [a, b] = of[half];
            rounded(f64x2_add(i64x2_shuffle::<0, 2>(a, b), i64x2_shuffle::<1, 3>(a, b)))
        })
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        halves!(half => rounded(f64x2_add(self.0[half], other.0[half])))
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        halves!(half => rounded(f64x2_sub(self.0[half], other.0[half])))
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        halves!(half => rounded(f64x2_mul(self.0[half], other.0[half])))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // For −0 and +0, both return `other`, as on the other levels.
        halves!(half => f64x2_pmin(other.0[half], self.0[half]))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        halves!(half => f64x2_pmax(other.0[half], self.0[half]))
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        let sum = halves!(half => f64x2_add(f64x2_mul(self.0[half], factor.0[half]), term.0[half]));
        sum.rounded_unless_midpoint().unwrap_or_else(|| self.repaired(factor, term))
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        let sum = halves!(half => f64x2_sub(term.0[half], f64x2_mul(self.0[half], factor.0[half])));
        sum.rounded_unless_midpoint().unwrap_or_else(|| {
            let negated = halves!(half => f64x2_neg(self.0[half]));
            negated.repaired(factor, term)
        })
    }
}

impl Simd128 {
    /// Converted to single precision.
    #[inline(always)]
    fn narrow(self) -> v128 {
        let [low, high] = self.0.map(|half| f32x4_demote_f64x2_zero(half));
        i64x2_shuffle::<0, 2>(low, high)
    }

    /// Rounded to single precision; none if any of these sums may be a midpoint (`super::fused`). One branch for all four, since
    /// it is hardly ever taken.
    ///
    /// Below 2⁻¹²⁶ it looks at the rounded sum: zero needs no repair. A sum of at most 2⁻¹⁵⁰ is exact, since single precision
    /// ends at 2⁻¹⁴⁹: either the term is 0, or it is so close to the negative product that the difference has few enough bits.
    #[inline(always)]
    fn rounded_unless_midpoint(self) -> Option<Self> {
        let [a, b] = self.0;
        let [low_half, high_half] = [f32x4_demote_f64x2_zero(a), f32x4_demote_f64x2_zero(b)];
        // Shifted left, a midpoint's lowest bits become the smallest number, the only one whose absolute value is negative.
        let low = i32x4_shuffle::<0, 2, 4, 6>(a, b);
        let is_half = i32x4_abs(i32x4_shl(low, LOST.leading_zeros() - 32));
        // Without the sign, minus 1: of all numbers up to 2⁻¹²⁶, only zero then has any of the eight highest bits set.
        let results = i64x2_shuffle::<0, 2>(low_half, high_half);
        let exponent = u32x4_shr(i32x4_add(i32x4_shl(results, 1), i32x4_splat(-1)), 24);
        let is_small = i32x4_eq(exponent, i32x4_splat(0));
        let may_be_midpoint = i32x4_bitmask(v128_or(is_half, is_small)) != 0;
        let rounded = || Self([f64x2_promote_low_f32x4(low_half), f64x2_promote_low_f32x4(high_half)]);
        (!may_be_midpoint).then(rounded)
    }

    /// `self · factor + term`, correct for all sums, midpoints included.
    #[cold]
    #[inline(always)]
    fn repaired(self, factor: Self, term: Self) -> Self {
        let [mut a, mut b, mut c] = [[0.0; 4]; 3];
        self.store(&mut a);
        factor.store(&mut b);
        term.store(&mut c);
        Self::load((), &repaired(a, b, c))
    }
}

/// Converted to double precision.
#[inline(always)]
fn wide(four: v128) -> [v128; 2] {
    [f64x2_promote_low_f32x4(four), f64x2_promote_low_f32x4(i64x2_shuffle::<1, 1>(four, four))]
}

/// Rounded to single precision, but stored in double precision.
#[inline(always)]
fn rounded(two: v128) -> v128 {
    f64x2_promote_low_f32x4(f32x4_demote_f64x2_zero(two))
}
