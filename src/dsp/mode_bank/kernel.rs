//! What a bank does every sample, in two forms on one state: the step in registers (`step`), and sixteen frames at a
//! time by tables, which is here with the data of both.
//!
//! Both are written once, over [`Vector`], and give the same bits on every level, because the order of every sum is
//! frozen: the register form adds modes by lane (`m mod 16`) and then the lanes by halves; the table form adds even
//! and odd modes apart, the shares of both coordinates apart, then modes and then shares. Modes at rest add `+0` and
//! can be left out without changing a bit.

use super::MAX_MODES;
use super::table::{Pairs, Table, Taps, Turn, WINDOW};
use super::vector::Vector;
use crate::dsp::CONTROL_FRAMES;

/// A number for each mode.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Row(pub(super) [f32; MAX_MODES]);

impl Row {
    pub(super) const ZERO: Row = Row([0.0; MAX_MODES]);
    pub(super) const ONE: Row = Row([1.0; MAX_MODES]);

    /// The numbers of the modes from `at` on. (Not a closure where it is used: those are not inlined, and what is not
    /// inlined into a level's function is compiled without its instructions. It costs a factor of five.)
    #[inline(always)]
    pub(super) fn at<V: Vector>(&self, at: usize) -> V {
        V::load(&self.0[at..])
    }
}

/// Displacement of each mode, and its velocity; or the displacement a quarter turn ahead (see `table`).
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub(super) x: Row,
    pub(super) v: Row,
}

impl State {
    pub(super) const REST: State = State { x: Row::ZERO, v: Row::ZERO };
}

/// What the step reads of each mode; sweeps and levels move in straight lines.
#[derive(Clone, Debug)]
pub(super) struct Modes {
    pub(super) zeta: Row,
    pub(super) omega2: Row,
    pub(super) sweep: Row,
    pub(super) sweep_step: Row,
    pub(super) level: Row,
    pub(super) level_step: Row,
    /// Level below which a mode is struck no more weakly: the one at the top of the spectrum, for those above it.
    pub(super) least: Row,
    pub(super) left: Row,
    pub(super) right: Row,
    /// Velocity per unit of pulse, displacement per unit of pulse, velocity per unit of noise.
    pub(super) push: Row,
    pub(super) pull: Row,
    pub(super) noise: Row,
}

/// What the next frames need. Multiplications by 1 and additions of 0 are left out where a flag is off,
/// which changes no bit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    /// Sweeps and levels move, or are not all 1.
    pub(super) swept: bool,
    pub(super) driven: bool,
    /// Gains are not all 1.
    pub(super) stereo: bool,
    /// Multiplications and additions are rounded once, together.
    pub(super) fused: bool,
    /// Modes that may be moving, from the first.
    pub(super) live: usize,
    /// How many, at most [`CONTROL_FRAMES`].
    pub(super) frames: usize,
}

/// Output of up to a control tick, left and right; the right side is written only in stereo.
pub(super) type Output = [[f32; CONTROL_FRAMES]; 2];

/// The output of the live modes over one control tick, by their tables; `end` becomes the state after it.
///
/// Sixteen frames of a mode are `P·x + Q·y`: lanes are frames and not modes, so neither does a frame wait for the one
/// before nor are many lanes added up. Two things double the speed, for loads are what limits it: each table is read
/// once for the two windows of a tick, and even lanes sum `P·x`, odd ones `Q·y`, so that a state is loaded once for
/// all of its frames as a pair.
#[inline(always)]
pub(super) fn ring<V: Vector>(
    form: Form,
    table: &mut Table,
    modes: &Modes,
    start: &State,
    end: &mut State,
    out: &mut Output,
) {
    let (live, stereo) = (form.live.min(MAX_MODES), form.stereo);
    let Table { taps, turn, pairs } = table;
    let mut at = 0;
    while at < live {
        let state: (V, V) = (start.x.at(at), start.v.at(at));
        let middle = turn.apply(at, state);
        let (x, y) = turn.apply(at, middle);
        x.store(&mut end.x.0[at..]);
        y.store(&mut end.v.0[at..]);
        store_pairs(&mut pairs[0], at, state, middle, stereo.then_some(&modes.left));
        if stereo {
            store_pairs(&mut pairs[1], at, state, middle, Some(&modes.right));
        }
        at += V::WIDTH;
    }
    let twos = live.div_ceil(2);
    sum_windows::<V>(taps, &pairs[0], twos, &mut out[0]);
    if stereo {
        sum_windows::<V>(taps, &pairs[1], twos, &mut out[1]);
    }
}

#[inline(always)]
fn store_pairs<V: Vector>(pairs: &mut Pairs, at: usize, start: (V, V), middle: (V, V), gain: Option<&Row>) {
    let (mut start, mut middle) = (start, middle);
    if let Some(gain) = gain {
        let gain = gain.at::<V>(at);
        start = (start.0.mul(gain), start.1.mul(gain));
        middle = (middle.0.mul(gain), middle.1.mul(gain));
    }
    start.0.store_pairs(start.1, pairs.0[0][at..].as_flattened_mut());
    middle.0.store_pairs(middle.1, pairs.0[1][at..].as_flattened_mut());
}

impl Turn {
    /// A window on from the state of one vector of modes.
    #[inline(always)]
    fn apply<V: Vector>(&self, at: usize, (x, y): (V, V)) -> (V, V) {
        let (real, real_rest): (V, V) = (self.real.at(at), self.real_rest.at(at));
        let (imaginary, imaginary_rest): (V, V) = (self.imaginary.at(at), self.imaginary_rest.at(at));
        let x_rest = x.mul_add(real_rest, y.mul(imaginary_rest));
        let y_rest = x.neg_mul_add(imaginary_rest, y.mul(real_rest));
        (x.mul_add(real, y.mul_add(imaginary, x_rest)), y.mul_add(real, x.neg_mul_add(imaginary, y_rest)))
    }

    /// Turns velocities into displacements a quarter turn ahead, or back.
    #[inline(always)]
    pub(super) fn convert<V: Vector>(&self, state: &mut State, ahead: bool, live: usize) {
        let (by_second, by_x) = if ahead { (&self.from_v, &self.from_x) } else { (&self.to_v, &self.to_v_x) };
        let mut at = 0;
        while at < live {
            let (x, second) = (state.x.at::<V>(at), state.v.at::<V>(at));
            x.mul_add(by_x.at(at), second.mul(by_second.at(at))).store(&mut state.v.0[at..]);
            at += V::WIDTH;
        }
    }
}

/// The sum of the first `2 · twos` modes over two windows.
#[inline(always)]
fn sum_windows<V: Vector>(taps: &[Taps; MAX_MODES], pairs: &Pairs, twos: usize, out: &mut [f32; CONTROL_FRAMES]) {
    let (taps, twos) = (taps.as_chunks::<2>().0, twos.min(MAX_MODES / 2));
    let (first, second) = (pairs.0[0].as_chunks::<2>().0, pairs.0[1].as_chunks::<2>().0);
    // Lanes are half as many frames; two vectors at a time.
    let mut lane = 0;
    while lane < 2 * WINDOW {
        let mut sums = [[[V::splat(0.0); 2]; 2]; 2];
        for i in 0..twos {
            for k in 0..2 {
                let (state0, state1) = (V::splat_pair(&first[i][k]), V::splat_pair(&second[i][k]));
                for half in 0..2 {
                    let tap = V::load(&taps[i][k].0[lane + half * V::WIDTH..]);
                    sums[0][half][k] = tap.mul_add(state0, sums[0][half][k]);
                    sums[1][half][k] = tap.mul_add(state1, sums[1][half][k]);
                }
            }
        }
        for window in 0..2 {
            let [[a, b], [c, d]] = sums[window];
            a.add(b).add_pairs(c.add(d)).store(&mut out[window * WINDOW + lane / 2..]);
        }
        lane += 2 * V::WIDTH;
    }
}
