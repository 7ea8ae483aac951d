//! Vectors for x86-64 CPUs with fused multiplication: AVX2 with FMA, and AVX-512.
//!
//! SAFETY, throughout: creating a vector requires a proof, and a proof exists only if the CPU was found to have the
//! instructions. So an operation on a vector, or with a proof, may execute them.

use super::vector::{Folded, LANES, Partial, Vector, sum_folded_frames, sum_frames};
use std::arch::x86_64::*;

/// Proof that this CPU has AVX2 and FMA.
#[derive(Clone, Copy, Debug)]
pub(in crate::dsp) struct HasAvx2(());

impl HasAvx2 {
    /// Returns the proof if the CPU has AVX2 and FMA.
    pub(super) fn detect() -> Option<Self> {
        (is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")).then_some(Self(()))
    }
}

/// Proof that this CPU has AVX-512F, and also AVX2 and FMA.
#[derive(Clone, Copy, Debug)]
pub(in crate::dsp) struct HasAvx512(HasAvx2);

impl HasAvx512 {
    /// Returns the proof if the CPU has AVX-512F, AVX2 and FMA.
    pub(super) fn detect() -> Option<Self> {
        HasAvx2::detect().filter(|_| is_x86_feature_detected!("avx512f")).map(Self)
    }
}

/// The operations that are a single instruction of the same form on both levels.
macro_rules! common {
    ($proof:ty, $width:literal, $load:ident, $store:ident, $splat:ident, $add:ident, $sub:ident, $mul:ident, $min:ident,
     $max:ident) => {
        type Proof = $proof;
        const WIDTH: usize = $width;
        const ON_EVERY_CPU: bool = false;

        #[inline(always)]
        fn splat(_: $proof, value: f32) -> Self {
            // SAFETY: see the top of the file.
            Self(unsafe { $splat(value) })
        }
        #[inline(always)]
        fn load(_: $proof, from: &[f32]) -> Self {
            let from = &from[..$width];
            // SAFETY: see the top of the file; the slice has as many numbers as are read; no alignment is required.
            Self(unsafe { $load(from.as_ptr()) })
        }
        #[inline(always)]
        fn store(self, to: &mut [f32]) {
            let to = &mut to[..$width];
            // SAFETY: see the top of the file; the slice has as many numbers as are written; no alignment is required.
            unsafe { $store(to.as_mut_ptr(), self.0) }
        }
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            // SAFETY: see the top of the file.
            Self(unsafe { $add(self.0, other.0) })
        }
        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            // SAFETY: see the top of the file.
            Self(unsafe { $sub(self.0, other.0) })
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            // SAFETY: see the top of the file.
            Self(unsafe { $mul(self.0, other.0) })
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            // SAFETY: see the top of the file.
            Self(unsafe { $min(self.0, other.0) })
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            // SAFETY: see the top of the file.
            Self(unsafe { $max(self.0, other.0) })
        }
    };
}

/// Eight numbers.
#[derive(Clone, Copy)]
pub(super) struct Avx2(__m256);

impl Vector for Avx2 {
    // Eight vectors in sixteen registers: with a force, waiting for results takes longer than reading constants from memory.
    const SIDE_BY_SIDE: usize = 2;
    common!(
        HasAvx2,
        8,
        _mm256_loadu_ps,
        _mm256_storeu_ps,
        _mm256_set1_ps,
        _mm256_add_ps,
        _mm256_sub_ps,
        _mm256_mul_ps,
        _mm256_min_ps,
        _mm256_max_ps
    );

    #[inline(always)]
    fn splat_pair(_: HasAvx2, pair: &[f32; 2]) -> Self {
        // SAFETY: see the top of the file.
        unsafe {
            let both = f64::from_bits(u64::from(pair[0].to_bits()) | u64::from(pair[1].to_bits()) << 32);
            Self(_mm256_castpd_ps(_mm256_set1_pd(both)))
        }
    }
    #[inline(always)]
    fn store_pairs(self, other: Self, to: &mut [f32]) {
        let to = &mut to[..2 * Self::WIDTH];
        // SAFETY: see the top of the file; the slice has as many numbers as are written.
        unsafe {
            let (low, high) = (_mm256_unpacklo_ps(self.0, other.0), _mm256_unpackhi_ps(self.0, other.0));
            _mm256_storeu_ps(to.as_mut_ptr(), _mm256_permute2f128_ps::<0x20>(low, high));
            _mm256_storeu_ps(to[8..].as_mut_ptr(), _mm256_permute2f128_ps::<0x31>(low, high));
        }
    }
    #[inline(always)]
    fn add_pairs(self, other: Self) -> Self {
        // SAFETY: see the top of the file.
        unsafe {
            let (low, high) =
                (_mm256_permute2f128_ps::<0x20>(self.0, other.0), _mm256_permute2f128_ps::<0x31>(self.0, other.0));
            Self(_mm256_add_ps(
                _mm256_shuffle_ps::<0b10_00_10_00>(low, high),
                _mm256_shuffle_ps::<0b11_01_11_01>(low, high),
            ))
        }
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: see the top of the file.
        Self(unsafe { _mm256_fmadd_ps(self.0, factor.0, term.0) })
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: see the top of the file.
        Self(unsafe { _mm256_fnmadd_ps(self.0, factor.0, term.0) })
    }
    #[inline(always)]
    fn sum_lanes(proof: HasAvx2, frames: &[Partial], sums: &mut [f32]) {
        sum_partials(proof, frames, sums);
    }
    #[inline(always)]
    fn sum_folded(proof: HasAvx2, frames: &[Folded], sums: &mut [f32]) {
        sum_folded(proof, frames, sums);
    }
}

/// Sixteen numbers.
#[derive(Clone, Copy)]
pub(super) struct Avx512(__m512);

impl Vector for Avx512 {
    common!(
        HasAvx512,
        16,
        _mm512_loadu_ps,
        _mm512_storeu_ps,
        _mm512_set1_ps,
        _mm512_add_ps,
        _mm512_sub_ps,
        _mm512_mul_ps,
        _mm512_min_ps,
        _mm512_max_ps
    );

    #[inline(always)]
    fn splat_pair(_: HasAvx512, pair: &[f32; 2]) -> Self {
        // SAFETY: see the top of the file.
        unsafe {
            let both = f64::from_bits(u64::from(pair[0].to_bits()) | u64::from(pair[1].to_bits()) << 32);
            Self(_mm512_castpd_ps(_mm512_set1_pd(both)))
        }
    }
    #[inline(always)]
    fn store_pairs(self, other: Self, to: &mut [f32]) {
        let to = &mut to[..2 * Self::WIDTH];
        // SAFETY: see the top of the file; the slice has as many numbers as are written.
        unsafe {
            let low = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
            let high = _mm512_setr_epi32(8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
            _mm512_storeu_ps(to.as_mut_ptr(), _mm512_permutex2var_ps(self.0, low, other.0));
            _mm512_storeu_ps(to[16..].as_mut_ptr(), _mm512_permutex2var_ps(self.0, high, other.0));
        }
    }
    #[inline(always)]
    fn add_pairs(self, other: Self) -> Self {
        // SAFETY: see the top of the file.
        unsafe {
            let even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
            let odd = _mm512_setr_epi32(1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
            Self(_mm512_add_ps(
                _mm512_permutex2var_ps(self.0, even, other.0),
                _mm512_permutex2var_ps(self.0, odd, other.0),
            ))
        }
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: see the top of the file.
        Self(unsafe { _mm512_fmadd_ps(self.0, factor.0, term.0) })
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: see the top of the file.
        Self(unsafe { _mm512_fnmadd_ps(self.0, factor.0, term.0) })
    }
    #[inline(always)]
    fn fold(self, _: HasAvx512, _: usize, row: &mut Folded) {
        // SAFETY: see the top of the file; a row has eight numbers.
        unsafe {
            let upper = _mm256_castpd_ps(_mm512_extractf64x4_pd::<1>(_mm512_castps_pd(self.0)));
            _mm256_storeu_ps(row.0.as_mut_ptr(), _mm256_add_ps(_mm512_castps512_ps256(self.0), upper));
        }
    }
    #[inline(always)]
    fn sum_lanes(HasAvx512(proof): HasAvx512, frames: &[Partial], sums: &mut [f32]) {
        sum_partials(proof, frames, sums);
    }
    #[inline(always)]
    fn sum_folded(HasAvx512(proof): HasAvx512, frames: &[Folded], sums: &mut [f32]) {
        sum_folded(proof, frames, sums);
    }
}

/// The sums of lanes `l` and `l + 8`.
#[inline(always)]
fn halves(_: HasAvx2, row: &Partial) -> __m256 {
    // SAFETY: see the top of the file; both halves of the row have eight numbers.
    unsafe { _mm256_add_ps(_mm256_loadu_ps(row.0.as_ptr()), _mm256_loadu_ps(row.0[LANES / 2..].as_ptr())) }
}

/// The sums of lanes `l` and `l + 2` of each half of `a` and `b`.
#[inline(always)]
fn quarters(_: HasAvx2, a: __m256, b: __m256) -> __m256 {
    // SAFETY: see the top of the file.
    unsafe { _mm256_add_ps(_mm256_shuffle_ps::<0b01_00_01_00>(a, b), _mm256_shuffle_ps::<0b11_10_11_10>(a, b)) }
}

/// [`Vector::sum_lanes`].
#[inline(always)]
fn sum_partials(proof: HasAvx2, frames: &[Partial], sums: &mut [f32]) {
    let rest = sum_eights(proof, frames, sums, halves);
    sum_frames(&frames[rest..], &mut sums[rest..]);
}

/// [`Vector::sum_folded`].
#[inline(always)]
fn sum_folded(proof: HasAvx2, frames: &[Folded], sums: &mut [f32]) {
    // SAFETY: see the top of the file; a row has eight numbers.
    let whole = |_, row: &Folded| unsafe { _mm256_add_ps(_mm256_loadu_ps(row.0.as_ptr()), _mm256_setzero_ps()) };
    let rest = sum_eights(proof, frames, sums, whole);
    sum_folded_frames(&frames[rest..], &mut sums[rest..]);
}

/// Sums the lanes of eight frames at a time, which saves 4.5 shuffles per frame. `fold` makes eight sums of a frame. Returns
/// the number of frames that were summed: all but the last few, fewer than eight.
#[inline(always)]
fn sum_eights<R>(proof: HasAvx2, frames: &[R], sums: &mut [f32], fold: impl Fn(HasAvx2, &R) -> __m256) -> usize {
    let eights = frames.as_chunks::<8>().0;
    for (rows, sums) in eights.iter().zip(sums.as_chunks_mut::<8>().0) {
        // SAFETY: see the top of the file; `sums` has eight numbers.
        unsafe {
            // Pairs such as (row 0, row 4), so that the last step leaves the rows in order.
            let mut fours = [_mm256_setzero_ps(); 4];
            for i in 0..4 {
                let (a, b) = (fold(proof, &rows[i]), fold(proof, &rows[i + 4]));
                // Lanes l and l + 4 of both rows.
                let low = _mm256_permute2f128_ps::<0x20>(a, b);
                fours[i] = _mm256_add_ps(low, _mm256_permute2f128_ps::<0x31>(a, b));
            }
            let (first, second) = (quarters(proof, fours[0], fours[1]), quarters(proof, fours[2], fours[3]));
            let sum = _mm256_add_ps(
                _mm256_shuffle_ps::<0b10_00_10_00>(first, second),
                _mm256_shuffle_ps::<0b11_01_11_01>(first, second),
            );
            _mm256_storeu_ps(sums.as_mut_ptr(), sum);
        }
    }
    8 * eights.len()
}
