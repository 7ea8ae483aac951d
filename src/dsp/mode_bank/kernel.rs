//! What a bank does every sample, in two forms on one state: the step in registers, and sixteen frames at a time.
//!
//! Both are written once, over [`Vector`], and give the same bits on every level, because the order of every sum is
//! frozen: the register form adds modes by lane (`m mod 16`) and then the lanes by halves; the table form adds even
//! and odd modes apart, the shares of both coordinates apart, then modes and then shares. Modes at rest add `+0` and can be left out without changing a bit.

use super::MAX_MODES;
use super::table::{Pairs, Table, Taps, Turn, WINDOW};
use super::vector::{LANES, Partial, Vector};
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::exciter::Drive;

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

    /// `N` vectors, [`LANES`] modes apart.
    #[inline(always)]
    fn every<V: Vector, const N: usize>(&self, at: usize) -> [V; N] {
        let mut vectors = [V::splat(0.0); N];
        for n in 0..N {
            vectors[n] = self.at(at + n * LANES);
        }
        vectors
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

/// Steps all modes through all frames.
#[inline(always)]
pub(super) fn step<V: Vector>(form: Form, modes: &mut Modes, state: &mut State, drive: &Drive, out: &mut Output) {
    macro_rules! run {
        ($swept:literal, $driven:literal, $stereo:literal, $fused:literal) => {
            step_all::<V, $swept, $driven, $stereo, $fused>(form, modes, state, drive, out)
        };
    }
    match (form.fused, form.swept, form.driven, form.stereo) {
        (true, false, false, false) => run!(false, false, false, true),
        (true, false, false, true) => run!(false, false, true, true),
        (true, false, true, false) => run!(false, true, false, true),
        (true, false, true, true) => run!(false, true, true, true),
        (true, true, false, false) => run!(true, false, false, true),
        (true, true, false, true) => run!(true, false, true, true),
        (true, true, true, false) => run!(true, true, false, true),
        (true, true, true, true) => run!(true, true, true, true),
        (false, ..) => run!(true, true, true, false),
    }
}

#[inline(always)]
fn step_all<V: Vector, const SWEPT: bool, const DRIVEN: bool, const STEREO: bool, const FUSED: bool>(
    form: Form,
    modes: &mut Modes,
    state: &mut State,
    drive: &Drive,
    out: &mut Output,
) {
    let (live, frames) = (form.live.min(MAX_MODES), form.frames.min(CONTROL_FRAMES));
    let (mut left, mut right) = ([Partial([0.0; LANES]); CONTROL_FRAMES], [Partial([0.0; LANES]); CONTROL_FRAMES]);
    let groups = live.div_ceil(LANES);
    let mut group = 0;
    while group < groups {
        let remaining = groups - group;
        let interleave = if V::INTERLEAVE >= 4 && remaining >= 4 {
            4
        } else if V::INTERLEAVE >= 2 && remaining >= 2 {
            2
        } else {
            1
        };
        let mut lane = 0;
        while lane < LANES && group * LANES + lane < live {
            let at = group * LANES + lane;
            match interleave {
                4 => step_some::<V, 4, SWEPT, DRIVEN, STEREO, FUSED>(
                    modes, state, at, drive, frames, &mut left, &mut right,
                ),
                2 => step_some::<V, 2, SWEPT, DRIVEN, STEREO, FUSED>(
                    modes, state, at, drive, frames, &mut left, &mut right,
                ),
                _ => step_some::<V, 1, SWEPT, DRIVEN, STEREO, FUSED>(
                    modes, state, at, drive, frames, &mut left, &mut right,
                ),
            }
            lane += V::WIDTH;
        }
        group += interleave;
    }
    V::sum_lanes(&left[..frames], &mut out[0]);
    if STEREO {
        V::sum_lanes(&right[..frames], &mut out[1]);
    }
}

/// Steps `N` vectors of modes, sixteen modes apart, from mode `at`: enough of them to fill the time that one step
/// has to wait for the one before, few enough that their state stays in registers.
#[inline(always)]
fn step_some<
    V: Vector,
    const N: usize,
    const SWEPT: bool,
    const DRIVEN: bool,
    const STEREO: bool,
    const FUSED: bool,
>(
    modes: &mut Modes,
    state: &mut State,
    at: usize,
    drive: &Drive,
    frames: usize,
    partial_left: &mut [Partial; CONTROL_FRAMES],
    partial_right: &mut [Partial; CONTROL_FRAMES],
) {
    let lane = at % LANES;
    let (mut x, mut v): ([V; N], [V; N]) = (state.x.every(at), state.v.every(at));
    let (zeta, omega2): ([V; N], [V; N]) = (modes.zeta.every(at), modes.omega2.every(at));
    let (mut sweep, sweep_step): ([V; N], [V; N]) = (modes.sweep.every(at), modes.sweep_step.every(at));
    let (mut level, level_step): ([V; N], [V; N]) = (modes.level.every(at), modes.level_step.every(at));
    let (left, right): ([V; N], [V; N]) = (modes.left.every(at), modes.right.every(at));
    let (push, pull): ([V; N], [V; N]) = (modes.push.every(at), modes.pull.every(at));
    let (noise, least): ([V; N], [V; N]) = (modes.noise.every(at), modes.least.every(at));
    for i in 0..frames {
        let mut sum_left = V::load(&partial_left[i].0[lane..]);
        let mut sum_right = if STEREO { V::load(&partial_right[i].0[lane..]) } else { sum_left };
        for n in 0..N {
            if SWEPT {
                sweep[n] = sweep[n].add(sweep_step[n]);
                level[n] = level[n].add(level_step[n]);
            }
            if DRIVEN {
                let (pulse, burst) = (V::splat(drive.pulse[i]), V::splat(drive.noise[i]));
                if FUSED {
                    if SWEPT {
                        let struck = level[n].max(least[n]);
                        v[n] = burst.mul_add(noise[n], pulse.mul(push[n])).mul_add(struck, v[n]);
                        x[n] = pulse.mul(pull[n]).mul_add(struck, x[n]);
                    } else {
                        v[n] = burst.mul_add(noise[n], pulse.mul_add(push[n], v[n]));
                        x[n] = pulse.mul_add(pull[n], x[n]);
                    }
                } else {
                    v[n] = v[n].add(pulse.mul(push[n]).add(burst.mul(noise[n])).mul(level[n]));
                    x[n] = x[n].add(pulse.mul(pull[n]).mul(level[n]));
                }
            }
            if FUSED {
                let stiffness = if SWEPT { omega2[n].mul(sweep[n]) } else { omega2[n] };
                v[n] = x[n].neg_mul_add(stiffness, v[n].neg_mul_add(zeta[n], v[n]));
                x[n] = if SWEPT { v[n].mul_add(sweep[n], x[n]) } else { x[n].add(v[n]) };
                match (SWEPT, STEREO) {
                    (false, false) => sum_left = sum_left.add(x[n]),
                    (true, false) => sum_left = x[n].mul_add(level[n], sum_left),
                    (_, true) => {
                        let heard = if SWEPT { x[n].mul(level[n]) } else { x[n] };
                        sum_left = heard.mul_add(left[n], sum_left);
                        sum_right = heard.mul_add(right[n], sum_right);
                    }
                }
            } else {
                // The original listing, operation for operation.
                v[n] = v[n].sub(v[n].mul(zeta[n]).add(x[n].mul(omega2[n]).mul(sweep[n])));
                x[n] = x[n].add(v[n].mul(sweep[n]));
                let heard = x[n].mul(level[n]);
                sum_left = sum_left.add(heard.mul(left[n]));
                sum_right = sum_right.add(heard.mul(right[n]));
            }
        }
        sum_left.store(&mut partial_left[i].0[lane..]);
        if STEREO {
            sum_right.store(&mut partial_right[i].0[lane..]);
        }
    }
    for n in 0..N {
        let at = at + n * LANES;
        x[n].store(&mut state.x.0[at..]);
        v[n].store(&mut state.v.0[at..]);
        if SWEPT {
            sweep[n].store(&mut modes.sweep.0[at..]);
            level[n].store(&mut modes.level.0[at..]);
        }
    }
}

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
