//! The operations that kernels may use: on vectors of single-precision numbers, each correctly rounded.

use super::fused::fused;

/// Number of partial sums of modes. Must not change, since the order of summation depends on it.
pub(in crate::dsp) const LANES: usize = 16;

/// The partial sums of one frame: lane `l` sums the modes `m` with `m mod 16 = l`.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(in crate::dsp) struct Partial(pub(in crate::dsp) [f32; LANES]);

/// The partial sums of one frame, folded once: place `l` has the sum of lanes `l` and `l + 8`. It takes half the memory of a
/// [`Partial`], and the lanes that are added are often still in registers.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(in crate::dsp) struct Folded(pub(in crate::dsp) [f32; LANES / 2]);

impl Folded {
    /// All sums 0.
    pub(in crate::dsp) const ZERO: Self = Self([0.0; LANES / 2]);
}

/// A vector of 1 to [`LANES`] single-precision numbers.
///
/// IEEE 754 defines the result of every operation exactly, so all implementations give the same bits.
///
/// The functions that create a vector take a proof that this CPU has the instructions. Only detection creates proofs, so
/// code that holds a vector or a proof may execute the instructions, and the operations are safe.
pub(in crate::dsp) trait Vector: Copy {
    /// A value of this type exists only if the CPU has the instructions.
    type Proof: Copy;
    /// Number of lanes.
    const WIDTH: usize;
    /// Number of vectors of each group of modes that are stepped at once under a force: 1, or as many as fill all [`LANES`].
    const SIDE_BY_SIDE: usize = 1;
    /// Whether every CPU that the program is compiled for has the instructions. Then functions need not be inlined.
    const ON_EVERY_CPU: bool = true;

    /// `value` in every lane.
    fn splat(proof: Self::Proof, value: f32) -> Self;
    /// The first numbers of `from`.
    fn load(proof: Self::Proof, from: &[f32]) -> Self;
    /// `pair`, repeated to fill the vector.
    fn splat_pair(proof: Self::Proof, pair: &[f32; 2]) -> Self;
    /// Writes to the first numbers of `to`.
    fn store(self, to: &mut [f32]);
    /// Writes the lanes of `self` and `other` alternately: twice as many numbers.
    fn store_pairs(self, other: Self, to: &mut [f32]);
    /// The sums of neighbouring lanes, first of `self`, then of `other`.
    fn add_pairs(self, other: Self) -> Self;
    /// `self + other`.
    fn add(self, other: Self) -> Self;
    /// `self − other`.
    fn sub(self, other: Self) -> Self;
    /// `self · other`.
    fn mul(self, other: Self) -> Self;
    /// The smaller value; neither argument may be NaN.
    fn min(self, other: Self) -> Self;
    /// The larger value; neither argument may be NaN.
    fn max(self, other: Self) -> Self;
    /// `self · factor + term`, rounded once.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// `term − self · factor`, rounded once.
    fn neg_mul_add(self, factor: Self, term: Self) -> Self;

    /// Adds the lanes from `lane` on to the row of their frame. The lower half is written; the upper half is added to the lower
    /// one, which must have been written before.
    #[inline(always)]
    fn fold(self, proof: Self::Proof, lane: usize, row: &mut Folded) {
        let place = &mut row.0[lane % (LANES / 2)..];
        if lane < LANES / 2 { self.store(place) } else { Self::load(proof, place).add(self).store(place) }
    }

    /// [`Vector::sum_lanes`] of folded sums. If the modes of the upper half are at rest, it may be missing.
    #[inline(always)]
    fn sum_folded(_: Self::Proof, frames: &[Folded], sums: &mut [f32]) {
        sum_folded_frames(frames, sums);
    }

    /// Adds up the partial sums of each frame, by halves: lanes `l` and `l + 8`, then `l + 4`, `l + 2`, `l + 1`.
    #[inline(always)]
    fn sum_lanes(_: Self::Proof, frames: &[Partial], sums: &mut [f32]) {
        sum_frames(frames, sums);
    }
}

/// [`Vector::sum_lanes`] without vector instructions.
#[inline(always)]
pub(in crate::dsp) fn sum_frames(frames: &[Partial], sums: &mut [f32]) {
    for (Partial(p), sum) in frames.iter().zip(sums) {
        let mut eight = [0.0; LANES / 2];
        for l in 0..LANES / 2 {
            eight[l] = p[l] + p[l + LANES / 2];
        }
        *sum = sum_eight(&eight);
    }
}

/// [`Vector::sum_folded`] without vector instructions.
#[inline(always)]
pub(super) fn sum_folded_frames(frames: &[Folded], sums: &mut [f32]) {
    for (Folded(eight), sum) in frames.iter().zip(sums) {
        // Adding 0 stands for an upper half that was never added: it turns −0 into +0.
        *sum = sum_eight(&eight.map(|number| number + 0.0));
    }
}

/// Sums eight numbers by halves.
#[inline(always)]
fn sum_eight(eight: &[f32; LANES / 2]) -> f32 {
    let mut four = [0.0; LANES / 4];
    for l in 0..LANES / 4 {
        four[l] = eight[l] + eight[l + LANES / 4];
    }
    (four[0] + four[2]) + (four[1] + four[3])
}

/// Four numbers in plain Rust: for CPUs without their own implementation, and as the reference for the others.
#[derive(Clone, Copy)]
pub(in crate::dsp) struct Scalar([f32; 4]);

impl Vector for Scalar {
    type Proof = ();
    const WIDTH: usize = 4;

    #[inline(always)]
    fn splat((): (), value: f32) -> Self {
        Self([value; 4])
    }
    #[inline(always)]
    fn load((): (), from: &[f32]) -> Self {
        Self([from[0], from[1], from[2], from[3]])
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[..4].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn splat_pair((): (), [a, b]: &[f32; 2]) -> Self {
        Self([*a, *b, *a, *b])
    }
    #[inline(always)]
    fn store_pairs(self, other: Self, to: &mut [f32]) {
        for l in 0..4 {
            (to[2 * l], to[2 * l + 1]) = (self.0[l], other.0[l]);
        }
    }
    #[inline(always)]
    fn add_pairs(self, other: Self) -> Self {
        let (Self([a, b, c, d]), Self([e, f, g, h])) = (self, other);
        Self([a + b, c + d, e + f, g + h])
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let mut result = self.0;
        for l in 0..4 {
            result[l] = self.0[l] + other.0[l];
        }
        Self(result)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let mut result = self.0;
        for l in 0..4 {
            result[l] = self.0[l] - other.0[l];
        }
        Self(result)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let mut result = self.0;
        for l in 0..4 {
            result[l] = self.0[l] * other.0[l];
        }
        Self(result)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        let mut result = self.0;
        for l in 0..4 {
            result[l] = if self.0[l] < other.0[l] { self.0[l] } else { other.0[l] };
        }
        Self(result)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        let mut result = self.0;
        for l in 0..4 {
            result[l] = if self.0[l] > other.0[l] { self.0[l] } else { other.0[l] };
        }
        Self(result)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Self(fused(self.0, factor.0, term.0))
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        Self(fused(self.0.map(|number| -number), factor.0, term.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_are_summed_by_halves() {
        let frame = Partial(std::array::from_fn(|l| (l * l) as f32));
        let mut sums = [0.0; 2];
        Scalar::sum_lanes((), &[frame; 2], &mut sums);
        assert_eq!(sums, [1240.0; 2]);
    }

    #[test]
    fn folded_sums_have_the_bits_of_all_lanes() {
        for frame in [
            std::array::from_fn(|l| libm::sinf(l as f32) * 1e3),
            [-0.0; LANES],
            std::array::from_fn(|l| if l < LANES / 2 { -0.0 } else { 0.0 }),
        ] {
            let (mut row, mut folded, mut whole) = (Folded::ZERO, [0.0], [0.0]);
            for lane in (0..LANES).step_by(Scalar::WIDTH) {
                Scalar::load((), &frame[lane..]).fold((), lane, &mut row);
            }
            Scalar::sum_folded((), &[row], &mut folded);
            Scalar::sum_lanes((), &[Partial(frame)], &mut whole);
            // An upper half of zeros may be left out, and then 0 is added at the end: −0 becomes +0.
            assert_eq!(folded[0].to_bits(), (whole[0] + 0.0).to_bits());
        }
    }
}
