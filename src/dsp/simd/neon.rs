//! Vectors for AArch64: four numbers, with fused multiplication.

use super::vector::Vector;
use std::arch::aarch64::*;

/// Four numbers.
#[derive(Clone, Copy)]
pub(super) struct Neon(float32x4_t);

/// Operations of two vectors that are one instruction each.
macro_rules! binary {
    ($($name:ident: $intrinsic:ident),*) => {
        $(#[inline(always)]
        fn $name(self, other: Self) -> Self {
            // SAFETY: every AArch64 CPU has NEON.
            Self(unsafe { $intrinsic(self.0, other.0) })
        })*
    };
}

impl Vector for Neon {
    // Every AArch64 CPU has NEON, so no proof is needed.
    type Proof = ();
    const WIDTH: usize = 4;

    #[inline(always)]
    fn splat((): (), value: f32) -> Self {
        // SAFETY: every AArch64 CPU has NEON.
        Self(unsafe { vdupq_n_f32(value) })
    }
    #[inline(always)]
    fn load((): (), from: &[f32]) -> Self {
        let from = &from[..4];
        // SAFETY: every AArch64 CPU has NEON; the slice has the four numbers that are read.
        Self(unsafe { vld1q_f32(from.as_ptr()) })
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..4];
        // SAFETY: every AArch64 CPU has NEON; the slice has the four numbers that are written.
        unsafe { vst1q_f32(to.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn splat_pair((): (), pair: &[f32; 2]) -> Self {
        // SAFETY: every AArch64 CPU has NEON; the array has the two numbers that are read.
        unsafe {
            let pair = vld1_f32(pair.as_ptr());
            Self(vcombine_f32(pair, pair))
        }
    }
    #[inline(always)]
    fn store_pairs(self, other: Self, to: &mut [f32]) {
        let to = &mut to[..8];
        // SAFETY: every AArch64 CPU has NEON; the slice has the eight numbers that are written.
        unsafe {
            vst1q_f32(to.as_mut_ptr(), vzip1q_f32(self.0, other.0));
            vst1q_f32(to[4..].as_mut_ptr(), vzip2q_f32(self.0, other.0));
        }
    }
    binary!(add_pairs: vpaddq_f32, add: vaddq_f32, sub: vsubq_f32, mul: vmulq_f32, min: vminq_f32, max: vmaxq_f32);
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: every AArch64 CPU has NEON.
        Self(unsafe { vfmaq_f32(term.0, self.0, factor.0) })
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: every AArch64 CPU has NEON.
        Self(unsafe { vfmsq_f32(term.0, self.0, factor.0) })
    }
}
