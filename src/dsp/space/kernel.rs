//! The work on a body's masses at every sample, and their measurement and damping from time to time.
//!
//! The masses are those of [`crate::dsp::mode_bank`]: a frame adds the input to `y` and turns the state,
//! `x ← x − αx + βy`, `y ← y − αy − βx`, both from the old state. Moving pitch is left out, since it is not needed here.
//! The order of sums must not change: each of the 16 lanes of a block adds up its masses block by block, fused, and then
//! lanes are added by halves.

use super::decay::height_of_way;
use crate::dsp::power_of_two;
use crate::dsp::simd::Kernel;
use crate::dsp::simd::vector::{LANES, Partial, Vector};

/// Maximum number of frames of a call, and the control tick of a body. It is so large that reading a body from the
/// second-level cache takes little of the time.
pub(super) const FRAMES: usize = 64;

/// Blocks that are stepped together. Bodies have a whole number of groups.
pub(super) const GROUP: usize = 4;

/// A number for each mass of a block.
pub(super) type Row = [f32; LANES];

/// Masses whose data are contiguous, so that a body is read from memory in one stream.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Block {
    pub(super) x: Row,
    pub(super) y: Row,
    /// `1 − r cos θ` and `r sin θ`.
    pub(super) alpha: Row,
    pub(super) beta: Row,
    /// Gains from the input to each side. All masses have the same drive, since each amplitude is in units of the mass's response
    /// to a sample of 1. So the drive is one addition and needs no row.
    pub(super) left: Row,
    pub(super) right: Row,
}

impl Block {
    pub(super) const REST: Self = {
        let zero = [0.0; LANES];
        Self { x: zero, y: zero, alpha: zero, beta: zero, left: zero, right: zero }
    };
}

/// The data from which the coefficients of a block are computed when its pitch or its decay changes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Turn {
    /// The angle per frame, and the position between low and high frequencies, at the body's reference pitch.
    pub(super) angle: Row,
    pub(super) way: Row,
    /// `1 − cos θ`, `cos θ` and `sin θ`.
    pub(super) versine: Row,
    pub(super) cosine: Row,
    pub(super) sine: Row,
    /// Weight of the high decay for the mode; see [`height_of_way`].
    pub(super) height: Row,
}

impl Turn {
    /// For the blocks that fill up the last group.
    pub(super) const NONE: Self = {
        let zero = [0.0; LANES];
        // The angle is above all frequencies, and the radius is 0: at rest after every frame.
        let (angle, versine) = ([f32::MAX; LANES], [1.0; LANES]);
        Self { angle, way: zero, versine, cosine: zero, sine: zero, height: zero }
    };

    /// Sets the angles of the modes to `ratio` times their own. Modes above `highest` radians per frame are silent.
    /// `shift` is the change of the position between low and high frequencies.
    pub(super) fn tune(&mut self, ratio: f64, shift: f32, highest: f64) {
        for lane in 0..LANES {
            let angle = f64::from(self.angle[lane]) * ratio;
            let is_heard = angle < highest;
            let [half_sine, half_cosine] = sine_and_cosine(if is_heard { 0.5 * angle } else { 0.0 });
            let versine = 2.0 * half_sine * half_sine;
            self.versine[lane] = if is_heard { versine as f32 } else { 1.0 };
            self.cosine[lane] = if is_heard { (1.0 - versine) as f32 } else { 0.0 };
            self.sine[lane] = (2.0 * half_sine * half_cosine) as f32;
            self.height[lane] = height_of_way(self.way[lane] + shift);
        }
    }
}

/// Sine and cosine of an angle up to a quarter turn, by their series: within 1e−11, and without branches, so that a whole body
/// takes at most a tenth of a millisecond.
fn sine_and_cosine(angle: f64) -> [f64; 2] {
    let square = angle * angle;
    let series = |factors: [f64; 7]| factors.iter().rev().fold(1.0, |sum, factor| 1.0 - sum * square * factor);
    let sine =
        series([2.0 * 3.0, 4.0 * 5.0, 6.0 * 7.0, 8.0 * 9.0, 10.0 * 11.0, 12.0 * 13.0, 14.0 * 15.0].map(f64::recip));
    let cosine =
        series([1.0 * 2.0, 3.0 * 4.0, 5.0 * 6.0, 7.0 * 8.0, 9.0 * 10.0, 11.0 * 12.0, 13.0 * 14.0].map(f64::recip));
    [angle * sine, cosine]
}

/// Left and right output, of up to [`FRAMES`] frames.
pub(super) type Output = [[f32; FRAMES]; 2];

/// Steps the masses through the frames of `input`.
pub(super) struct Step<'a> {
    /// A whole number of groups.
    pub(super) blocks: &'a mut [Block],
    pub(super) input: &'a [f32],
    /// Whether any of the input is not zero.
    pub(super) driven: bool,
    pub(super) out: &'a mut Output,
}

impl Kernel for Step<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, proof: V::Proof) {
        if self.driven { self.all::<V, true>(proof) } else { self.all::<V, false>(proof) }
    }
}

impl Step<'_> {
    #[inline(always)]
    fn all<V: Vector, const DRIVEN: bool>(self, proof: V::Proof) {
        let Self { blocks, input, out, .. } = self;
        let frames = input.len().min(FRAMES);
        let (mut left, mut right) = ([Partial([0.0; LANES]); FRAMES], [Partial([0.0; LANES]); FRAMES]);
        for group in blocks.as_chunks_mut::<GROUP>().0 {
            let mut lane = 0;
            while lane < LANES {
                step::<V, DRIVEN>(proof, group, lane, &input[..frames], &mut left, &mut right);
                lane += V::WIDTH;
            }
        }
        V::sum_lanes(proof, &left[..frames], &mut out[0]);
        V::sum_lanes(proof, &right[..frames], &mut out[1]);
    }
}

/// Steps one vector of each block of a group, from a lane on. Stepping them together uses the time in which each step has to
/// wait for the previous one. (Two of each on AVX2, as in the mode bank, were slower: 0.85 instead of 0.89 of the bank's rate.)
#[inline(always)]
fn step<V: Vector, const DRIVEN: bool>(
    proof: V::Proof,
    group: &mut [Block; GROUP],
    lane: usize,
    input: &[f32],
    left: &mut [Partial; FRAMES],
    right: &mut [Partial; FRAMES],
) {
    macro_rules! load {
        ($($row:ident),*) => { ($({
            let mut vectors = [V::splat(proof, 0.0); GROUP];
            for g in 0..GROUP {
                vectors[g] = V::load(proof, &group[g].$row[lane..]);
            }
            vectors
        }),*) };
    }
    let (mut x, mut y) = load!(x, y);
    let (alpha, beta, to_left, to_right) = load!(alpha, beta, left, right);
    for i in 0..input.len().min(FRAMES) {
        let force = V::splat(proof, input[i]);
        let mut sum_left = V::load(proof, &left[i].0[lane..]);
        let mut sum_right = V::load(proof, &right[i].0[lane..]);
        for g in 0..GROUP {
            let (x_now, mut y_now) = (x[g], y[g]);
            if DRIVEN {
                y_now = y_now.add(force);
            }
            // The values that change every frame are negated, since negated coefficients would need additional registers.
            let (to_x, to_y) = (y_now.mul_add(beta[g], x_now), x_now.neg_mul_add(beta[g], y_now));
            (x[g], y[g]) = (x_now.neg_mul_add(alpha[g], to_x), y_now.neg_mul_add(alpha[g], to_y));
            sum_left = x[g].mul_add(to_left[g], sum_left);
            sum_right = x[g].mul_add(to_right[g], sum_right);
        }
        sum_left.store(&mut left[i].0[lane..]);
        sum_right.store(&mut right[i].0[lane..]);
    }
    for g in 0..GROUP {
        x[g].store(&mut group[g].x[lane..]);
        y[g].store(&mut group[g].y[lane..]);
    }
}

/// States with a smaller amplitude, whose square is still a normal number, are set to rest: calculations with subnormal numbers
/// take a hundred times as long.
const REST: f32 = 1e-18;

/// Sum of the squared amplitudes of some blocks. Sets masses that have nearly stopped to rest.
pub(super) struct Measure<'a> {
    pub(super) blocks: &'a mut [Block],
}

impl Kernel for Measure<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<V: Vector>(self, _: V::Proof) -> f64 {
        let mut sums = [0.0; LANES];
        for Block { x, y, .. } in self.blocks {
            for lane in 0..LANES {
                let energy = x[lane] * x[lane] + y[lane] * y[lane];
                let kept = if energy < REST * REST { 0.0 } else { 1.0 };
                (x[lane], y[lane]) = (x[lane] * kept, y[lane] * kept);
                sums[lane] += energy;
            }
        }
        sums.iter().map(|sum| f64::from(*sum)).sum()
    }
}

/// Sets the coefficients of blocks to another decay. The state of the masses does not change, so there is no click.
pub(super) struct Damp<'a> {
    pub(super) blocks: &'a mut [Block],
    pub(super) turns: &'a [Turn],
    /// Base-2 logarithm of the decay rate per frame at low frequencies, and its increase at high frequencies.
    pub(super) low: f32,
    pub(super) span: f32,
}

impl Kernel for Damp<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, _: V::Proof) {
        for (block, turn) in self.blocks.iter_mut().zip(self.turns) {
            for lane in 0..LANES {
                let rate = power_of_two(self.low + self.span * turn.height[lane]);
                // 1 − e^(−rate), by its series, since rates are small.
                let loss = rate * (1.0 - rate * (0.5 - rate * (1.0 / 6.0 - rate * (1.0 / 24.0))));
                block.alpha[lane] = turn.versine[lane] + loss * turn.cosine[lane];
                block.beta[lane] = turn.sine[lane] - loss * turn.sine[lane];
            }
        }
    }
}
