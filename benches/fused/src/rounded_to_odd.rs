//! The former emulation: every sum is rounded to odd in double precision, and then to single precision.

/// Four numbers, as the former scalar code had them.
#[derive(Clone, Copy)]
pub(super) struct Scalar(pub(super) [f32; 4]);

impl Scalar {
    #[inline(always)]
    pub(super) fn mul_add(self, factor: Self, term: Self) -> Self {
        let mut result = self.0;
        for (l, number) in result.iter_mut().enumerate() {
            *number = fused(self.0[l], factor.0[l], term.0[l]);
        }
        Self(result)
    }

    #[inline(always)]
    pub(super) fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        Self(self.0.map(|number| -number)).mul_add(factor, term)
    }
}

#[inline(always)]
fn fused(a: f32, b: f32, c: f32) -> f32 {
    let (product, c) = (f64::from(a) * f64::from(b), f64::from(c));
    let sum = product + c;
    // Knuth's TwoSum: the rounding error.
    let part = sum - product;
    let error = (product - (sum - part)) + (c - part);
    let bits = sum.to_bits();
    let towards = if (error.to_bits() ^ bits) >> 63 == 0 { bits.wrapping_add(1) } else { bits.wrapping_sub(1) };
    let odd = if error != 0.0 && bits & 1 == 0 { towards } else { bits };
    f64::from_bits(odd) as f32
}

#[cfg(target_arch = "x86_64")]
pub(super) use sse2::Sse2;

/// SAFETY, throughout: every x86-64 CPU has SSE2.
#[cfg(target_arch = "x86_64")]
mod sse2 {
    use std::arch::x86_64::*;

    /// Four numbers, as the former SSE2 code had them: in single precision, converted for each sum.
    #[derive(Clone, Copy)]
    pub(in super::super) struct Sse2(pub(in super::super) __m128);

    impl Sse2 {
        #[inline(always)]
        pub(in super::super) fn mul_add(self, factor: Self, term: Self) -> Self {
            // SAFETY: see above.
            unsafe {
                let lower = _mm_cvtpd_ps(fused(_mm_cvtps_pd(self.0), _mm_cvtps_pd(factor.0), _mm_cvtps_pd(term.0)));
                let upper = _mm_cvtpd_ps(fused(upper(self.0), upper(factor.0), upper(term.0)));
                Self(_mm_movelh_ps(lower, upper))
            }
        }

        #[inline(always)]
        pub(in super::super) fn neg_mul_add(self, factor: Self, term: Self) -> Self {
            // SAFETY: see above.
            Self(unsafe { _mm_xor_ps(self.0, _mm_set1_ps(-0.0)) }).mul_add(factor, term)
        }
    }

    #[inline(always)]
    fn upper(v: __m128) -> __m128d {
        // SAFETY: see above.
        unsafe { _mm_cvtps_pd(_mm_movehl_ps(v, v)) }
    }

    /// Two lanes of [`super::fused`], before its last rounding.
    #[inline(always)]
    fn fused(a: __m128d, b: __m128d, c: __m128d) -> __m128d {
        // SAFETY: see above.
        unsafe {
            let product = _mm_mul_pd(a, b);
            let sum = _mm_add_pd(product, c);
            let part = _mm_sub_pd(sum, product);
            let error = _mm_add_pd(_mm_sub_pd(product, _mm_sub_pd(sum, part)), _mm_sub_pd(c, part));
            let (bits, one) = (_mm_castpd_si128(sum), _mm_set1_epi64x(1));
            let opposite = _mm_srli_epi64::<63>(_mm_xor_si128(_mm_castpd_si128(error), bits));
            let towards = _mm_sub_epi64(one, _mm_add_epi64(opposite, opposite));
            let even = _mm_sub_epi64(_mm_and_si128(bits, one), one);
            let inexact = _mm_castpd_si128(_mm_cmpneq_pd(error, _mm_setzero_pd()));
            _mm_castsi128_pd(_mm_add_epi64(bits, _mm_and_si128(towards, _mm_and_si128(even, inexact))))
        }
    }
}
