//! The work on masses that turn once a block: each takes its force from a grid of frequencies, turns, and adds itself to one.
//!
//! A mass is `z ← λ (z + u)` at every frame, as in [`crate::dsp::mode_bank`], and its state `S` here is `z` at the middle of a
//! block. With `d` as the sum of the block's input times `λ^t`, the next state is `λ^B (S + λ^B d)`: the same oscillator, once
//! a block. `d` and the output `Σ gains · S λ^t` are sums at frequencies between the points of a grid: see [`super::taps`].
//!
//! The order of sums must not change: members of a group ascending in each of 16 lanes, fused; then lanes by halves; then
//! terms, taps and groups ascending, not fused.
//!
//! What did not work: weights for each mode, and taps before states, which keep one vector in flight (a third slower).

use super::taps::{FRACTIONS, MOST_TERMS, TAPS, Taps};
use crate::dsp::simd::Kernel;
use crate::dsp::simd::vector::{LANES, Partial, Vector};

/// A number for each mass of a block.
pub(super) type Row = [f32; LANES];

/// Most blocks of a group.
pub(super) const MOST_BLOCKS: usize = 8;

/// Masses whose data are contiguous, so that a body is read from memory in one stream. Numbers with two rows are complex.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Block {
    pub(super) state: [Row; 2],
    /// `λ^B`.
    pub(super) turn: [Row; 2],
    /// Distance from the centre of the group in steps of the grid. Its imaginary part is the damping.
    pub(super) distance: [Row; 2],
    /// Gains to each side. The drive is in them: the unit of a mass is its response to a sample of 1.
    pub(super) gains: [Row; 2],
}

impl Block {
    pub(super) const REST: Self = {
        let zero = [[0.0; LANES]; 2];
        Self { state: zero, turn: zero, distance: zero, gains: zero }
    };
}

/// Neighbouring blocks with the same taps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    /// The blocks, from the first to before the last.
    pub(super) start: u32,
    pub(super) end: u32,
    /// The place of the first tap on the grid, and the fraction of the centre.
    pub(super) tap: u16,
    pub(super) fraction: u8,
    /// Index of the number of terms.
    pub(super) order: u8,
}

/// Output of masses on a grid: real and imaginary parts of the left side, and of the right.
pub(super) type Spectra = [Vec<f32>; 4];

/// What the masses do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// Nothing.
    Stay,
    /// They turn.
    Turn,
    /// The input drives them, and they turn.
    Drive,
}

/// Moves the masses of some groups, and adds them to `out`.
pub(super) struct Play<'a> {
    pub(super) blocks: &'a mut [Block],
    pub(super) groups: &'a [Group],
    pub(super) tables: &'static [[Taps; FRACTIONS]; 3],
    pub(super) step: Step,
    /// The input on the grid.
    pub(super) input: &'a [Vec<f32>; 2],
    pub(super) out: &'a mut Spectra,
}

impl Kernel for Play<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, proof: V::Proof) {
        let Self { blocks, groups, tables, step, input, out } = self;
        let mut room =
            Room { rows: [Partial([0.0; LANES]); 4 * MOST_TERMS], kept: [[V::splat(proof, 0.0); 2]; MOST_BLOCKS] };
        for group in groups {
            let members = &mut blocks[group.start as usize..group.end as usize];
            let taps = &tables[usize::from(group.order)][usize::from(group.fraction)];
            let tap = usize::from(group.tap);
            match group.order {
                0 => play::<V, 6>(proof, members, taps, tap, step, input, out, &mut room),
                1 => play::<V, 7>(proof, members, taps, tap, step, input, out, &mut room),
                _ => play::<V, 8>(proof, members, taps, tap, step, input, out, &mut room),
            }
        }
    }
}

/// Room for the sums of a group, and for its masses times a power of their distance.
struct Room<V> {
    rows: [Partial; 4 * MOST_TERMS],
    kept: [[V; 2]; MOST_BLOCKS],
}

#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "a kernel: a structure would have to be taken apart in every group")]
fn play<V: Vector, const P: usize>(
    proof: V::Proof,
    members: &mut [Block],
    taps: &Taps,
    tap: usize,
    step: Step,
    input: &[Vec<f32>; 2],
    out: &mut Spectra,
    room: &mut Room<V>,
) {
    match step {
        Step::Drive => {
            let force = [force(taps, &input[0][tap..tap + TAPS]), force(taps, &input[1][tap..tap + TAPS])];
            turn::<V, P, true>(proof, members, &force);
        }
        Step::Turn => turn::<V, P, false>(proof, members, &[[0.0; MOST_TERMS]; 2]),
        Step::Stay => {}
    }
    let mut lane = 0;
    while lane < LANES {
        // Three powers at a time fill the registers.
        moments::<V, P, 0, 3>(proof, members, lane, room);
        moments::<V, P, 3, 3>(proof, members, lane, room);
        match P {
            7 => moments::<V, P, 6, 1>(proof, members, lane, room),
            8 => moments::<V, P, 6, 2>(proof, members, lane, room),
            _ => {}
        }
        lane += V::WIDTH;
    }
    let mut sums = [0.0; 4 * MOST_TERMS];
    V::sum_lanes(proof, &room.rows[..4 * P], &mut sums);
    for part in 0..4 {
        let to = &mut out[part][tap..tap + TAPS];
        let mut values = [0.0; TAPS];
        values.copy_from_slice(to);
        for p in 0..P {
            for t in 0..TAPS {
                values[t] += taps.by_term[p][t] * sums[4 * p + part];
            }
        }
        to.copy_from_slice(&values);
    }
}

/// The input at the centre of a group, as a polynomial of the distance from it.
#[inline(always)]
fn force(taps: &Taps, input: &[f32]) -> [f32; MOST_TERMS] {
    let mut force = [0.0; MOST_TERMS];
    for t in 0..TAPS {
        for p in 0..MOST_TERMS {
            force[p] += taps.by_tap[t][p] * input[t];
        }
    }
    force
}

/// Turns the masses of a group through a block.
#[inline(always)]
fn turn<V: Vector, const P: usize, const DRIVEN: bool>(
    proof: V::Proof,
    members: &mut [Block],
    force: &[[f32; MOST_TERMS]; 2],
) {
    for block in members {
        let mut lane = 0;
        while lane < LANES {
            macro_rules! load {
                ($row:ident) => {
                    (V::load(proof, &block.$row[0][lane..]), V::load(proof, &block.$row[1][lane..]))
                };
            }
            let (mut re, mut im) = load!(state);
            let (turn_re, turn_im) = load!(turn);
            if DRIVEN {
                let (x, y) = load!(distance);
                let (mut sum_re, mut sum_im) = (V::splat(proof, force[0][P - 1]), V::splat(proof, force[1][P - 1]));
                for p in (0..P - 1).rev() {
                    let (next_re, next_im) = (V::splat(proof, force[0][p]), V::splat(proof, force[1][p]));
                    (sum_re, sum_im) = (
                        sum_im.neg_mul_add(y, sum_re.mul_add(x, next_re)),
                        sum_im.mul_add(x, sum_re.mul_add(y, next_im)),
                    );
                }
                (re, im) = (
                    sum_im.neg_mul_add(turn_im, sum_re.mul_add(turn_re, re)),
                    sum_im.mul_add(turn_re, sum_re.mul_add(turn_im, im)),
                );
            }
            im.neg_mul_add(turn_im, re.mul(turn_re)).store(&mut block.state[0][lane..]);
            im.mul_add(turn_re, re.mul(turn_im)).store(&mut block.state[1][lane..]);
            lane += V::WIDTH;
        }
    }
}

/// Sums the masses of a group times `COUNT` powers of their distance, from the power `FROM` on, and times each gain.
#[inline(always)]
fn moments<V: Vector, const P: usize, const FROM: usize, const COUNT: usize>(
    proof: V::Proof,
    members: &[Block],
    lane: usize,
    room: &mut Room<V>,
) {
    let mut sums = [[V::splat(proof, 0.0); 4]; COUNT];
    for m in 0..members.len().min(MOST_BLOCKS) {
        let block = &members[m];
        let (x, y) = (V::load(proof, &block.distance[0][lane..]), V::load(proof, &block.distance[1][lane..]));
        let (left, right) = (V::load(proof, &block.gains[0][lane..]), V::load(proof, &block.gains[1][lane..]));
        let [mut re, mut im] = match FROM {
            0 => [V::load(proof, &block.state[0][lane..]), V::load(proof, &block.state[1][lane..])],
            _ => room.kept[m],
        };
        for p in 0..COUNT {
            sums[p][0] = re.mul_add(left, sums[p][0]);
            sums[p][1] = im.mul_add(left, sums[p][1]);
            sums[p][2] = re.mul_add(right, sums[p][2]);
            sums[p][3] = im.mul_add(right, sums[p][3]);
            if FROM + p + 1 < P {
                (re, im) = (im.neg_mul_add(y, re.mul(x)), im.mul_add(x, re.mul(y)));
            }
        }
        if FROM + COUNT < P {
            room.kept[m] = [re, im];
        }
    }
    for p in 0..COUNT {
        for part in 0..4 {
            sums[p][part].store(&mut room.rows[4 * (FROM + p) + part].0[lane..]);
        }
    }
}
