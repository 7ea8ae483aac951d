//! Emulates `a · b + c` in single precision, rounded once, for CPUs without fused multiplication.
//!
//! A product of two single-precision numbers is exact in double precision: it has 48 bits of 53, and is never too small or
//! too large. So `a · b + c` in double precision is the exact sum `e` rounded once, to `s`. The result here is `s` rounded
//! to single precision. A *midpoint* is a number halfway between two neighbouring single-precision numbers, or the
//! number from which rounding gives infinity; midpoints are double-precision numbers. Rounding is monotone, so `s` lies
//! below a midpoint only if `e` does, and above one only if `e` does. Hence, **unless `s` is a midpoint itself, `s` and
//! `e` round to the same number.** If `s` is a midpoint, `e` may lie on either side of it, and the result depends on the side.
//!
//! Midpoints are recognised by their bits. From 2⁻¹²⁶ on, a single-precision number has 23 of the 52 bits of the
//! fraction, so the 29 lowest bits of a midpoint are 100…0. Below 2⁻¹²⁶, where single precision has a fixed step, every
//! sum but zero is treated as a midpoint. Infinities and NaN are never treated as midpoints: their lowest bits are
//! zeros. Only one random sum in 2²⁹ is a midpoint, so it costs little to look for midpoints in a whole vector and to
//! repair the few that are found. Zeros, which are frequent in banks, cost no more than other numbers.
//!
//! The former emulation rounded every sum to odd. It took 39 instructions per mode and frame for ringing modes, 85 for
//! modulated and 81 for driven ones; now it is 20, 44 and 41, and in scalar code 27, 57 and 53 (`cargo xtask
//! callgrind`). With 64 modes, this is 1.3 times as fast in scalar code, 2.5 times on SSE2 and in WebAssembly with vectors
//! (measured once). JavaScript engines create a vector constant anew wherever it is used; so the simd128 kernel tests for
//! midpoints with 0 and −1 only, which cost nothing.
//!
//! Not fusing at all was slower on CPUs with the instruction, with 16 × 64 modes: 12.9 instead of 15.9 G ringing and
//! 5.1 instead of 6.8 G modulated on AVX2; 16.7 instead of 21.1 and 8.0 instead of 11.1 G on AVX-512 (10⁹ modes ×
//! frames per second, measured once). x86 CPUs made before 2013 pay the price: SSE2 without fusing does 6.9 G.

/// The lowest bits of a double that do not fit into single precision, and their value in a midpoint.
pub(super) const LOST: u64 = (1 << 29) - 1;
pub(super) const HALF: u64 = 1 << 28;

/// The bits of 2⁻¹²⁶, the smallest normal number of single precision.
pub(super) const LEAST_NORMAL: u64 = (1023 - 126) << 52;

/// Whether the target has an instruction for fused multiplication, which is then used.
const HAS_INSTRUCTION: bool =
    cfg!(any(target_feature = "fma", target_arch = "aarch64", all(target_arch = "riscv64", target_feature = "f")));

/// `a · b + c` rounded once, number by number.
#[inline(always)]
pub(super) fn fused(a: [f32; 4], b: [f32; 4], c: [f32; 4]) -> [f32; 4] {
    let mut result = c;
    if HAS_INSTRUCTION {
        for l in 0..4 {
            result[l] = a[l].mul_add(b[l], c[l]);
        }
        return result;
    }
    let mut midpoint = false;
    for l in 0..4 {
        let sum = f64::from(a[l]) * f64::from(b[l]) + f64::from(c[l]);
        midpoint |= may_be_midpoint(sum);
        result[l] = sum as f32;
    }
    if midpoint { repaired(a, b, c) } else { result }
}

/// Whether a sum may be a midpoint.
#[inline(always)]
fn may_be_midpoint(sum: f64) -> bool {
    // Computed with two numbers of 32 bits, which every CPU can compare.
    let (low, high) = (sum.to_bits() as u32, (sum.to_bits() >> 32) as u32);
    let shift = LOST.count_ones();
    let (half, magnitude) = (low << (32 - shift), high << 1);
    // After subtracting 1, zero becomes the largest number.
    (half == (HALF as u32) << (32 - shift)) | (magnitude.wrapping_sub(1) < ((LEAST_NORMAL >> 32) as u32 * 2) - 1)
}

/// `a · b + c` rounded once, number by number; correct for all sums, midpoints included.
#[cold]
#[inline(never)]
pub(super) fn repaired(a: [f32; 4], b: [f32; 4], c: [f32; 4]) -> [f32; 4] {
    std::array::from_fn(|l| rounded_to_odd(a[l], b[l], c[l]) as f32)
}

/// `a · b + c` rounded to odd: of the two doubles around an inexact sum, the one whose last bit is 1. No midpoint has a
/// last bit of 1, so the result lies on the same side of every midpoint as the exact sum (Boldo and Melquiond 2008,
/// "Emulation of a FMA and correctly rounded sums").
fn rounded_to_odd(a: f32, b: f32, c: f32) -> f64 {
    let (product, c) = (f64::from(a) * f64::from(b), f64::from(c));
    let sum = product + c;
    // Knuth's TwoSum: the rounding error of the sum. NaN if the sum is infinite; the sum is then correct as it is.
    let part = sum - product;
    let error = (product - (sum - part)) + (c - part);
    let bits = sum.to_bits();
    let inexact = error.abs() > 0.0;
    let away_from_zero = (error > 0.0) == (sum > 0.0);
    let odd = match (inexact && bits & 1 == 0, away_from_zero) {
        (false, _) => bits,
        (true, true) => bits + 1,
        (true, false) => bits - 1,
    };
    f64::from_bits(odd)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::random::key;
    use crate::dsp::simd::vector::{Scalar, Vector};

    /// The results of a vector type for `a · b + c` and for `c − a · b`.
    fn both<V: Vector<Proof = ()>>(a: &[f32], b: &[f32], c: &[f32]) -> [[f32; 4]; 2] {
        let mut results = [[0.0; 4]; 2];
        let load = |from| V::load((), from);
        load(a).mul_add(load(b), load(c)).store(&mut results[0]);
        load(a).neg_mul_add(load(b), load(c)).store(&mut results[1]);
        results
    }

    /// Checks four sums in every emulation.
    fn check(a: [f32; 4], b: [f32; 4], c: [f32; 4]) {
        let repaired = repaired(a, b, c);
        let vectors = [
            both::<Scalar>(&a, &b, &c),
            #[cfg(target_arch = "x86_64")]
            both::<crate::dsp::simd::sse2::Sse2>(&a, &b, &c),
        ];
        for l in 0..4 {
            let same = |expected: f32, found: f32, sign| {
                let fine = expected.to_bits() == found.to_bits() || (expected.is_nan() && found.is_nan());
                assert!(fine, "{sign}{:e} · {:e} + {:e}: {expected:e}, not {found:e}", a[l], b[l], c[l]);
            };
            // Not `f32::mul_add`, which calls the system's: that of MinGW rounds twice (mingw-w64 bug 848).
            let (plus, minus) = (libm::fmaf(a[l], b[l], c[l]), libm::fmaf(-a[l], b[l], c[l]));
            same(plus, repaired[l], "repaired, ");
            for [found_plus, found_minus] in vectors {
                same(plus, found_plus[l], "");
                same(minus, found_minus[l], "−");
            }
        }
    }

    /// A stream of random bits.
    struct Bits(u64);

    impl Bits {
        fn next(&mut self) -> u64 {
            self.0 += 1;
            key(11, self.0)
        }

        /// Any single-precision bit pattern; every fourth one has few bits, which makes midpoints likely.
        fn number(&mut self) -> f32 {
            let bits = self.next();
            let mask = if bits >> 62 == 0 { u32::MAX << (bits >> 32 & 31) } else { u32::MAX };
            f32::from_bits(bits as u32 & mask)
        }

        /// A number whose magnitude is at least 2^`low` and below 2^`high`.
        fn between(&mut self, low: i32, high: i32) -> f32 {
            let exponent = low + (self.next() % (high - low) as u64) as i32;
            let number = f32::from_bits(0x3f80_0000 | (self.next() as u32 & 0x807f_ffff));
            number * libm::exp2f(exponent as f32)
        }
    }

    /// Number of random sums; the environment variable `SPRUNG_FUSED_CASES` changes it.
    fn cases() -> u64 {
        std::env::var("SPRUNG_FUSED_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(1_000_000)
    }

    #[test]
    fn random_sums_round_once() {
        let mut bits = Bits(0);
        for n in 0..cases() / 4 {
            let mut four = |which: u64| -> [f32; 4] {
                std::array::from_fn(|_| match n % 4 {
                    // All bit patterns; similar magnitudes; the magnitudes in kernels; magnitudes around 2⁻¹²⁶.
                    0 => bits.number(),
                    1 => bits.between(-20, 20),
                    2 => bits.between(-10, 1),
                    _ if which == 2 => bits.between(-126, -122) * 0.125,
                    _ => bits.between(-70, -62),
                })
            };
            let (a, b, c) = (four(0), four(1), four(2));
            check(a, b, c);
            check(a, b, std::array::from_fn(|l| -(a[l] * b[l])));
        }
    }

    /// Exact sums on a midpoint, and sums that differ from one by less than double precision can resolve.
    #[test]
    fn sums_beside_midpoints_round_once() {
        let mut bits = Bits(1 << 40);
        for n in 0..cases() / 100 {
            // All magnitudes; every second time, magnitudes around 2⁻¹²⁶ and below.
            let mask = if n % 2 == 0 { u32::MAX } else { 0x80ff_ffff };
            let c: [f32; 4] = std::array::from_fn(|_| f32::from_bits(bits.number().to_bits() & mask));
            // Half a step, as a product of two numbers.
            let half = c.map(|c| 0.5 * (f64::from(c.abs()) - f64::from(c.abs().next_down())));
            let root = half.map(|half| libm::exp2((libm::log2(half) * 0.5).floor()));
            // Products of 1, 1 + 2⁻³³ and 1 − 2⁻³³.
            let (small, smaller) = (libm::exp2f(-11.0), libm::exp2f(-22.0));
            for (a, b) in [(1.0, 1.0), (1.0 + small, 1.0 - small + smaller), (1.0 - small, 1.0 + small + smaller)] {
                let a = root.map(|root| root as f32 * a);
                check(a, std::array::from_fn(|l| (half[l] / root[l]) as f32 * b), c);
            }
        }
        let tie = 1.0 + f32::EPSILON;
        for tiny in [1e-30_f32, -1e-30, f32::MIN_POSITIVE, 1e-44, 0.0, -0.0] {
            check(
                [tie, tiny, 16_777_217.0, 1.0 + 4_096.0 * f32::EPSILON],
                [tie, tie, 1.0, 1.0 - 4_096.0 * f32::EPSILON],
                [tiny, tie, tiny, tiny],
            );
            check([tie; 4], [tie, 1.5, 0.5, -0.5], [tiny; 4]);
        }
    }

    /// An assumption of the WebAssembly vectors: a sum that single precision rounds to zero needs no repair.
    #[test]
    fn sums_that_vanish_round_once() {
        let mut bits = Bits(1 << 41);
        let mut vanished = 0;
        for n in 0..cases() {
            let (a, b) = (bits.between(-80, -70), bits.between(-80, -70));
            let c = match n % 3 {
                0 => 0.0,
                1 => -(a * b),
                _ => f32::from_bits(bits.next() as u32 & 0x8000_0003),
            };
            let sum = (f64::from(a) * f64::from(b) + f64::from(c)) as f32;
            if sum == 0.0 {
                vanished += 1;
                assert_eq!(sum.to_bits(), libm::fmaf(a, b, c).to_bits(), "{a:e} · {b:e} + {c:e}");
            }
        }
        assert!(vanished > cases() / 10, "{vanished}");
    }

    /// All sums of numbers at the ends of the range and of their neighbours.
    #[test]
    fn sums_of_extremes_round_once() {
        let least = f32::from_bits(1);
        let positive =
            [0.0, least, f32::MIN_POSITIVE, 1.0, libm::exp2f(-75.0), libm::exp2f(-63.0), libm::exp2f(64.0), 4_097.0];
        let large = [f32::MAX, libm::exp2f(127.0), libm::exp2f(103.0), libm::exp2f(-24.0), f32::INFINITY, f32::NAN];
        let near = |number: f32| [number, number.next_up(), number.next_down()];
        let all: Vec<f32> =
            positive.into_iter().chain(large).flat_map(near).flat_map(|number| [number, -number]).collect();
        for &a in &all {
            for &b in &all {
                for c in all.chunks(4) {
                    check([a; 4], [b; 4], std::array::from_fn(|l| c[l % c.len()]));
                }
            }
        }
    }
}
