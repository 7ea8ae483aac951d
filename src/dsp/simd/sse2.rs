//! Vectors for SSE2, which has no fused multiplication: every number is stored in double precision.
//!
//! Fused multiplication is then a double-precision multiplication, an addition, and a rounding to single precision
//! (`super::fused` explains when this is correct). Its operands need no conversion. Sums, differences and products of
//! single-precision numbers may be rounded to double precision first, because double precision has more than twice as
//! many bits.
//!
//! SAFETY, throughout: every x86-64 CPU has SSE2.

use super::fused::{HALF, LEAST_NORMAL, LOST, repaired};
use super::vector::Vector;
use std::arch::x86_64::*;

/// Four single-precision numbers, stored in double precision.
#[derive(Clone, Copy)]
pub(super) struct Sse2([__m128d; 2]);

/// Applies the same operation to both halves.
macro_rules! halves {
    ($half:ident => $result:expr) => {{
        let of = |$half: usize| {
            // SAFETY: see the top of the file.
            unsafe { $result }
        };
        Self([of(0), of(1)])
    }};
}

impl Vector for Sse2 {
    type Proof = ();
    const WIDTH: usize = 4;

    #[inline(always)]
    fn splat((): (), value: f32) -> Self {
        halves!(_half => _mm_set1_pd(f64::from(value)))
    }
    #[inline(always)]
    fn load((): (), from: &[f32]) -> Self {
        let from = &from[..4];
        // SAFETY: see the top of the file; the slice has the four numbers that are read.
        let all = unsafe { _mm_loadu_ps(from.as_ptr()) };
        Self(wide(all))
    }
    #[inline(always)]
    fn splat_pair((): (), [a, b]: &[f32; 2]) -> Self {
        halves!(_half => _mm_setr_pd(f64::from(*a), f64::from(*b)))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..4];
        // SAFETY: see the top of the file; the slice has the four numbers that are written.
        unsafe { _mm_storeu_ps(to.as_mut_ptr(), self.narrow()) }
    }
    #[inline(always)]
    fn store_pairs(self, other: Self, to: &mut [f32]) {
        let to = &mut to[..8];
        let (a, b) = (self.narrow(), other.narrow());
        // SAFETY: see the top of the file; the slice has the eight numbers that are written.
        unsafe {
            _mm_storeu_ps(to.as_mut_ptr(), _mm_unpacklo_ps(a, b));
            _mm_storeu_ps(to[4..].as_mut_ptr(), _mm_unpackhi_ps(a, b));
        }
    }
    #[inline(always)]
    fn add_pairs(self, other: Self) -> Self {
        let of = [self.0, other.0];
        halves!(half => {
            let [a, b] = of[half];
            rounded(_mm_add_pd(_mm_unpacklo_pd(a, b), _mm_unpackhi_pd(a, b)))
        })
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        halves!(half => rounded(_mm_add_pd(self.0[half], other.0[half])))
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        halves!(half => rounded(_mm_sub_pd(self.0[half], other.0[half])))
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        halves!(half => rounded(_mm_mul_pd(self.0[half], other.0[half])))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        halves!(half => _mm_min_pd(self.0[half], other.0[half]))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        halves!(half => _mm_max_pd(self.0[half], other.0[half]))
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        let sum = halves!(half => _mm_add_pd(_mm_mul_pd(self.0[half], factor.0[half]), term.0[half]));
        if sum.may_be_midpoints() { self.repaired(factor, term) } else { sum.rounded() }
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        let sum = halves!(half => _mm_sub_pd(term.0[half], _mm_mul_pd(self.0[half], factor.0[half])));
        if sum.may_be_midpoints() {
            let negated = halves!(half => _mm_xor_pd(self.0[half], _mm_set1_pd(-0.0)));
            return negated.repaired(factor, term);
        }
        sum.rounded()
    }
}

impl Sse2 {
    /// Converted to single precision.
    #[inline(always)]
    fn narrow(self) -> __m128 {
        // SAFETY: see the top of the file.
        unsafe { _mm_movelh_ps(_mm_cvtpd_ps(self.0[0]), _mm_cvtpd_ps(self.0[1])) }
    }

    /// Rounded to single precision, but stored in double precision.
    #[inline(always)]
    fn rounded(self) -> Self {
        Self([rounded(self.0[0]), rounded(self.0[1])])
    }

    /// Whether any of these sums may be a midpoint (`super::fused`). One branch for all four, since it is hardly ever
    /// taken.
    #[inline(always)]
    fn may_be_midpoints(self) -> bool {
        const MAX: i32 = i32::MAX;
        // SSE2 compares signed numbers of 32 bits. In each half of a double, all bits but the sign are inverted. Then
        // the wanted values become the largest: the lowest bits of a midpoint, and everything below 2⁻¹²⁶. Zero would
        // be even larger, but there the addition overflows and makes it the smallest.
        const OFFSET: [i32; 2] = [MAX - (LOST - HALF) as i32, 1];
        const BOUND: [i32; 2] = [MAX - 1, MAX - (LEAST_NORMAL >> 32) as i32 + 1];
        // SAFETY: see the top of the file.
        unsafe {
            let both = |[low, high]: [i32; 2]| _mm_setr_epi32(low, high, low, high);
            let of = |half: usize| {
                let flipped = _mm_andnot_si128(_mm_castpd_si128(self.0[half]), both([LOST as i32, MAX]));
                _mm_cmpgt_epi32(_mm_add_epi32(flipped, both(OFFSET)), both(BOUND))
            };
            _mm_movemask_epi8(_mm_or_si128(of(0), of(1))) != 0
        }
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
fn wide(four: __m128) -> [__m128d; 2] {
    // SAFETY: see the top of the file.
    unsafe { [_mm_cvtps_pd(four), _mm_cvtps_pd(_mm_movehl_ps(four, four))] }
}

/// Rounded to single precision, but stored in double precision.
#[inline(always)]
fn rounded(two: __m128d) -> __m128d {
    // SAFETY: see the top of the file.
    unsafe { _mm_cvtps_pd(_mm_cvtpd_ps(two)) }
}
