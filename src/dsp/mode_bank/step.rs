//! The register form of a bank: all modes stepped, sample by sample, with their state in registers.

use super::MAX_MODES;
use super::kernel::{Form, Modes, Output, Row, State};
use super::vector::{LANES, Partial, Vector};
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::exciter::Drive;

/// How much of a [`Drive`] a kernel reads: nothing, one force that pushes, or all that there is.
const FREE: u8 = 0;
const PUSHED: u8 = 1;
const DRIVEN: u8 = 2;

/// Steps all modes through all frames.
#[inline(always)]
pub(super) fn step<V: Vector>(form: Form, modes: &mut Modes, state: &mut State, drive: &Drive, out: &mut Output) {
    macro_rules! run {
        ($swept:literal, $force:expr, $right:expr, $fused:literal) => {
            step_all::<V, $swept, { $force }, { $right }, $fused>(form, modes, state, drive, out)
        };
    }
    const STEREO: usize = CONTROL_FRAMES;
    let force = if form.driven { force(form, modes, drive) } else { FREE };
    match (form.fused, form.swept, force, form.stereo) {
        (true, false, FREE, false) => run!(false, FREE, 0, true),
        (true, false, FREE, true) => run!(false, FREE, STEREO, true),
        (true, false, PUSHED, false) => run!(false, PUSHED, 0, true),
        (true, false, PUSHED, true) => run!(false, PUSHED, STEREO, true),
        (true, false, _, false) => run!(false, DRIVEN, 0, true),
        (true, false, _, true) => run!(false, DRIVEN, STEREO, true),
        (true, true, FREE, false) => run!(true, FREE, 0, true),
        (true, true, FREE, true) => run!(true, FREE, STEREO, true),
        (true, true, PUSHED, false) => run!(true, PUSHED, 0, true),
        (true, true, PUSHED, true) => run!(true, PUSHED, STEREO, true),
        (true, true, _, false) => run!(true, DRIVEN, 0, true),
        (true, true, _, true) => run!(true, DRIVEN, STEREO, true),
        (false, ..) => run!(true, DRIVEN, STEREO, false),
    }
}

/// How much of the force of these frames has to be read. What is left out would have added zeros.
#[inline(always)]
fn force(form: Form, modes: &Modes, drive: &Drive) -> u8 {
    let (live, frames) = (form.live.min(MAX_MODES), form.frames.min(CONTROL_FRAMES));
    match (is_zero(&drive.pulse[..frames]), is_zero(&drive.noise[..frames])) {
        (true, true) => FREE,
        (true, false) => PUSHED,
        (false, true) if is_zero(&modes.pull.0[..live]) => PUSHED,
        _ => DRIVEN,
    }
}

/// Whether all numbers are zero. Looks at all of them: with vectors that is sooner done than leaving early.
#[inline(always)]
fn is_zero(numbers: &[f32]) -> bool {
    let mut bits = 0;
    for number in numbers {
        bits |= number.to_bits() << 1;
    }
    bits == 0
}

/// `RIGHT` is how many frames there are to the right: none but in stereo.
#[inline(always)]
fn step_all<V: Vector, const SWEPT: bool, const FORCE: u8, const RIGHT: usize, const FUSED: bool>(
    form: Form,
    modes: &mut Modes,
    state: &mut State,
    drive: &Drive,
    out: &mut Output,
) {
    let (live, frames) = (form.live.min(MAX_MODES), form.frames.min(CONTROL_FRAMES));
    let (mut left, mut right) = ([Partial([0.0; LANES]); CONTROL_FRAMES], [Partial([0.0; LANES]); RIGHT]);
    macro_rules! run {
        ($groups:literal, $vectors:literal, $at:expr) => {
            step_some::<V, $groups, $vectors, SWEPT, FORCE, RIGHT, FUSED>(
                modes, state, $at, drive, frames, &mut left, &mut right,
            )
        };
    }
    let mut group = 0;
    while group * LANES < live {
        let at = group * LANES;
        let groups = match live.div_ceil(LANES) - group {
            4.. if V::INTERLEAVE >= 4 => 4,
            2.. if V::INTERLEAVE >= 2 => 2,
            _ => 1,
        };
        let mut lane = 0;
        while lane < LANES && at + lane < live {
            // Sweeps and levels that move take twice the registers.
            let vectors = if V::INTERLEAVE >= 8 && groups == 4 && !SWEPT { 2 } else { 1 };
            match (groups, vectors) {
                (4, 2) => run!(4, 2, at + lane),
                (4, _) => run!(4, 1, at + lane),
                (2, _) => run!(2, 1, at + lane),
                _ => run!(1, 1, at + lane),
            }
            lane += vectors * V::WIDTH;
        }
        group += groups;
    }
    V::sum_lanes(&left[..frames], &mut out[0]);
    if RIGHT > 0 {
        V::sum_lanes(&right[..frames.min(RIGHT)], &mut out[1]);
    }
}

/// A number for each of the modes that are stepped together: of `G` groups of [`LANES`], `N` vectors side by side.
#[inline(always)]
fn load<V: Vector, const G: usize, const N: usize>(row: &Row, at: usize) -> [[V; G]; N] {
    let mut vectors = [[V::splat(0.0); G]; N];
    for n in 0..N {
        for g in 0..G {
            vectors[n][g] = row.at(at + g * LANES + n * V::WIDTH);
        }
    }
    vectors
}

/// Steps `G·N` vectors of modes, from mode `at`: enough of them to fill the time that one step has to wait for the
/// one before, few enough that most of their state stays in registers.
#[inline(always)]
fn step_some<
    V: Vector,
    const G: usize,
    const N: usize,
    const SWEPT: bool,
    const FORCE: u8,
    const RIGHT: usize,
    const FUSED: bool,
>(
    modes: &mut Modes,
    state: &mut State,
    at: usize,
    drive: &Drive,
    frames: usize,
    partial_left: &mut [Partial; CONTROL_FRAMES],
    partial_right: &mut [Partial; RIGHT],
) {
    let stereo = RIGHT > 0;
    let (mut x, mut v): ([[V; G]; N], [[V; G]; N]) = (load(&state.x, at), load(&state.v, at));
    let (zeta, omega2): ([[V; G]; N], [[V; G]; N]) = (load(&modes.zeta, at), load(&modes.omega2, at));
    let (mut sweep, sweep_step): ([[V; G]; N], [[V; G]; N]) = (load(&modes.sweep, at), load(&modes.sweep_step, at));
    let (mut level, level_step): ([[V; G]; N], [[V; G]; N]) = (load(&modes.level, at), load(&modes.level_step, at));
    let (left, right): ([[V; G]; N], [[V; G]; N]) = (load(&modes.left, at), load(&modes.right, at));
    let (push, pull): ([[V; G]; N], [[V; G]; N]) = (load(&modes.push, at), load(&modes.pull, at));
    let (noise, least): ([[V; G]; N], [[V; G]; N]) = (load(&modes.noise, at), load(&modes.least, at));
    // The one force that pushes, if there is but one.
    let by_noise = FORCE == PUSHED && is_zero(&drive.pulse[..frames]);
    let (force, pushed) = if by_noise { (&drive.noise, noise) } else { (&drive.pulse, push) };
    for i in 0..frames {
        for n in 0..N {
            let lane = at % LANES + n * V::WIDTH;
            let mut sum_left = V::load(&partial_left[i].0[lane..]);
            let mut sum_right = if stereo { V::load(&partial_right[i].0[lane..]) } else { sum_left };
            for g in 0..G {
                let (mut x_now, mut v_now) = (x[n][g], v[n][g]);
                if SWEPT {
                    sweep[n][g] = sweep[n][g].add(sweep_step[n][g]);
                    level[n][g] = level[n][g].add(level_step[n][g]);
                }
                let (sweep, level) = (sweep[n][g], level[n][g]);
                if FORCE == PUSHED {
                    let force = V::splat(force[i]);
                    v_now = if SWEPT {
                        force.mul(pushed[n][g]).mul_add(level.max(least[n][g]), v_now)
                    } else {
                        force.mul_add(pushed[n][g], v_now)
                    };
                } else if FORCE == DRIVEN {
                    let (pulse, burst) = (V::splat(drive.pulse[i]), V::splat(drive.noise[i]));
                    if !FUSED {
                        v_now = v_now.add(pulse.mul(push[n][g]).add(burst.mul(noise[n][g])).mul(level));
                        x_now = x_now.add(pulse.mul(pull[n][g]).mul(level));
                    } else if SWEPT {
                        let struck = level.max(least[n][g]);
                        v_now = burst.mul_add(noise[n][g], pulse.mul(push[n][g])).mul_add(struck, v_now);
                        x_now = pulse.mul(pull[n][g]).mul_add(struck, x_now);
                    } else {
                        v_now = burst.mul_add(noise[n][g], pulse.mul_add(push[n][g], v_now));
                        x_now = pulse.mul_add(pull[n][g], x_now);
                    }
                }
                if FUSED {
                    let stiffness = if SWEPT { omega2[n][g].mul(sweep) } else { omega2[n][g] };
                    v_now = x_now.neg_mul_add(stiffness, v_now.neg_mul_add(zeta[n][g], v_now));
                    x_now = if SWEPT { v_now.mul_add(sweep, x_now) } else { x_now.add(v_now) };
                    match (SWEPT, stereo) {
                        (false, false) => sum_left = sum_left.add(x_now),
                        (true, false) => sum_left = x_now.mul_add(level, sum_left),
                        (_, true) => {
                            let heard = if SWEPT { x_now.mul(level) } else { x_now };
                            sum_left = heard.mul_add(left[n][g], sum_left);
                            sum_right = heard.mul_add(right[n][g], sum_right);
                        }
                    }
                } else {
                    // The original listing, operation for operation.
                    v_now = v_now.sub(v_now.mul(zeta[n][g]).add(x_now.mul(omega2[n][g]).mul(sweep)));
                    x_now = x_now.add(v_now.mul(sweep));
                    let heard = x_now.mul(level);
                    sum_left = sum_left.add(heard.mul(left[n][g]));
                    sum_right = sum_right.add(heard.mul(right[n][g]));
                }
                (x[n][g], v[n][g]) = (x_now, v_now);
            }
            sum_left.store(&mut partial_left[i].0[lane..]);
            if stereo {
                sum_right.store(&mut partial_right[i].0[lane..]);
            }
        }
    }
    // Vector by vector. Row by row, the compiler keeps a displacement in memory all through the loop over frames, which
    // costs an eighth of the speed of swept modes on AVX2.
    for n in 0..N {
        for g in 0..G {
            let at = at + g * LANES + n * V::WIDTH;
            x[n][g].store(&mut state.x.0[at..]);
            v[n][g].store(&mut state.v.0[at..]);
            if SWEPT {
                sweep[n][g].store(&mut modes.sweep.0[at..]);
                level[n][g].store(&mut modes.level.0[at..]);
            }
        }
    }
}
