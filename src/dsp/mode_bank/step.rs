//! Renders sample by sample: all modes are stepped, with their state in registers.
//!
//! A frame turns each mode's state: `x ← x − αx + βy`, `y ← y − αy − βx`, both from the old state. Modes are added up
//! by lane (`m mod 16`) and then by halves of the lanes: this order must not change. Modes at rest add `+0`, so leaving
//! them out changes no bit. While pitches move, the coefficients change every [`super::tuning::STAIR`] frames, to their
//! values in the middle of these frames.

use super::MAX_MODES;
use super::rows::{Form, Modes, Moving, Output, Row, State};
use super::tuning::stair;
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::exciter::Drive;
use crate::dsp::simd::Kernel;
use crate::dsp::simd::vector::{Folded, LANES, Vector};

/// The parts of a [`Drive`] that are read: none; one force that acts on `y`; noise and one force that acts on both
/// coordinates; all forces; all forces, with noise that acts on both coordinates.
const FREE: u8 = 0;
const PUSHED: u8 = 1;
const DRIVEN: u8 = 2;
const ALL: u8 = 3;
const TURNED: u8 = 4;

/// The quantities that change while frames are rendered, see [`Moving`].
const NOTHING: u8 = 0;
const PITCH: u8 = 1;
const PITCH_AND_GAIN: u8 = 2;

/// Length of the right output in frames in stereo. In mono it is 0.
const STEREO: usize = CONTROL_FRAMES;

/// Steps the live modes through a number of frames.
pub(super) struct Step<'a> {
    pub(super) form: Form,
    pub(super) modes: &'a Modes,
    pub(super) state: &'a mut State,
    pub(super) drive: &'a Drive,
    pub(super) out: &'a mut Output,
}

impl Kernel for Step<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self, proof: V::Proof) {
        let force = if self.form.driven { self.force() } else { FREE };
        // There are fewer functions than cases, because each is compiled for every level.
        match (self.form.moving, force, self.form.stereo) {
            (_, TURNED, _) => self.all::<V, PITCH_AND_GAIN, TURNED, STEREO>(proof),
            (_, ALL, _) => self.all::<V, PITCH_AND_GAIN, ALL, STEREO>(proof),
            (Moving::Nothing, FREE, false) => self.all::<V, NOTHING, FREE, 0>(proof),
            (Moving::Nothing, FREE, true) => self.all::<V, NOTHING, FREE, STEREO>(proof),
            (Moving::Nothing, PUSHED, false) => self.all::<V, NOTHING, PUSHED, 0>(proof),
            (Moving::Nothing, PUSHED, true) => self.all::<V, NOTHING, PUSHED, STEREO>(proof),
            (Moving::Nothing, ..) => self.all::<V, NOTHING, DRIVEN, STEREO>(proof),
            (Moving::Pitch, FREE, false) => self.all::<V, PITCH, FREE, 0>(proof),
            (Moving::Pitch, FREE, true) => self.all::<V, PITCH, FREE, STEREO>(proof),
            (Moving::Pitch, PUSHED, _) => self.all::<V, PITCH, PUSHED, STEREO>(proof),
            (Moving::Pitch, ..) => self.all::<V, PITCH, DRIVEN, STEREO>(proof),
            (Moving::PitchAndGain, ..) => self.all::<V, PITCH_AND_GAIN, ALL, STEREO>(proof),
        }
    }
}

impl Step<'_> {
    /// The parts of the drive that must be read for these frames. The others would only add zeros.
    #[inline(always)]
    fn force(&self) -> u8 {
        let (live, frames) = (self.form.live.min(MAX_MODES), self.form.frames.min(CONTROL_FRAMES));
        let Drive { push, pull, noise } = self.drive;
        let acts = [push, pull, noise].map(|force| !is_zero(&force[..frames]));
        match acts {
            [_, _, true] if self.form.turned_noise => TURNED,
            [false, false, false] => FREE,
            [false, false, true] => PUSHED,
            [true, false, false] if is_zero(&self.modes.push_x.0[..live]) => PUSHED,
            [true, true, _] => ALL,
            _ => DRIVEN,
        }
    }

    #[inline(always)]
    fn all<V: Vector, const MOVING: u8, const FORCE: u8, const RIGHT: usize>(self, proof: V::Proof) {
        let Self { form, modes, state, drive, out } = self;
        let (live, frames) = (form.live.min(MAX_MODES), form.frames.min(CONTROL_FRAMES));
        let (mut left, mut right) = ([Folded::ZERO; CONTROL_FRAMES], [Folded::ZERO; RIGHT]);
        macro_rules! run {
            ($groups:literal, $vectors:literal, $lane:expr) => {
                if const { V::ON_EVERY_CPU } {
                    run!(step_apart, $groups, $vectors, $lane)
                } else {
                    run!(step_some, $groups, $vectors, $lane)
                }
            };
            ($step:ident, $groups:literal, $vectors:literal, $lane:expr) => {
                $step::<V, $groups, $vectors, MOVING, FORCE, RIGHT>(
                    proof, form, modes, state, $lane, drive, &mut left, &mut right,
                )
            };
        }
        // Modes beyond the live ones are at rest, so three groups may be stepped as four.
        let groups = live.div_ceil(LANES);
        if const { V::SIDE_BY_SIDE == 2 && FORCE != FREE } {
            match groups {
                1 => run!(1, 2, 0),
                2 => run!(2, 2, 0),
                _ => run!(4, 2, 0),
            }
        } else {
            let mut lane = 0;
            while lane < live.min(LANES) {
                match groups {
                    1 => run!(1, 1, lane),
                    2 => run!(2, 1, lane),
                    _ => run!(4, 1, lane),
                }
                lane += V::WIDTH;
            }
        }
        V::sum_folded(proof, &left[..frames], &mut out[0]);
        if RIGHT > 0 {
            V::sum_folded(proof, &right[..frames.min(RIGHT)], &mut out[1]);
        }
    }
}

/// Whether all numbers are zero. Always reads all of them: with vectors this is faster than leaving early.
#[inline(always)]
fn is_zero(numbers: &[f32]) -> bool {
    let mut bits = 0;
    for number in numbers {
        bits |= number.to_bits() << 1;
    }
    bits == 0
}

/// One number for each of the modes that are stepped together: `N` vectors of each of `G` groups of [`LANES`].
#[inline(always)]
fn load<V: Vector, const G: usize, const N: usize>(proof: V::Proof, row: &Row, lane: usize) -> [[V; G]; N] {
    let mut vectors = [[V::splat(proof, 0.0); G]; N];
    for n in 0..N {
        for g in 0..G {
            vectors[n][g] = row.at(proof, lane + g * LANES + n * V::WIDTH);
        }
    }
    vectors
}

/// [`step_some`] as a separate function. With all variants in one function, compilation takes several times longer.
#[inline(never)]
#[allow(clippy::too_many_arguments, reason = "as step_some")]
fn step_apart<V: Vector, const G: usize, const N: usize, const MOVING: u8, const FORCE: u8, const RIGHT: usize>(
    proof: V::Proof,
    form: Form,
    modes: &Modes,
    state: &mut State,
    lane: usize,
    drive: &Drive,
    left: &mut [Folded; CONTROL_FRAMES],
    right: &mut [Folded; RIGHT],
) {
    step_some::<V, G, N, MOVING, FORCE, RIGHT>(proof, form, modes, state, lane, drive, left, right);
}

/// Steps `N` vectors of each of the `G` live groups, from `lane` on. They are stepped side by side, because each step
/// has to wait for the result of the one before.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "a kernel: everything in registers")]
fn step_some<V: Vector, const G: usize, const N: usize, const MOVING: u8, const FORCE: u8, const RIGHT: usize>(
    proof: V::Proof,
    form: Form,
    modes: &Modes,
    state: &mut State,
    lane: usize,
    drive: &Drive,
    partial_left: &mut [Folded; CONTROL_FRAMES],
    partial_right: &mut [Folded; RIGHT],
) {
    let (stereo, frames) = (RIGHT > 0, form.frames.min(CONTROL_FRAMES));
    macro_rules! rows {
        ($($row:expr),*) => { ($(load::<V, G, N>(proof, &$row, lane)),*) };
    }
    let (mut x, mut y) = rows!(state.x, state.y);
    let (alpha_start, alpha_step, beta_start, beta_step) =
        rows!(modes.alpha, modes.alpha_step, modes.beta, modes.beta_step);
    let (left, left_step, right, right_step) = rows!(modes.left, modes.left_step, modes.right, modes.right_step);
    // The only force besides the noise, if there is only one.
    let is_pushed = !is_zero(&drive.push[..frames]);
    let (pulse, pulse_x, pulse_y) = if FORCE == DRIVEN && !is_pushed {
        (&drive.pull, &modes.pull_x, &modes.pull_y)
    } else {
        (&drive.push, &modes.push_x, &modes.push_y)
    };
    let (pulse_x, pulse_y, noise) = rows!(*pulse_x, *pulse_y, modes.noise);
    let (pull_x, pull_y, noise_x) = rows!(modes.pull_x, modes.pull_y, modes.noise_x);
    let (force, pushed) = if FORCE == PUSHED && !is_pushed { (&drive.noise, noise) } else { (pulse, pulse_y) };
    let (mut alpha, mut beta) = (alpha_start, beta_start);
    let mut start = 0;
    while start < frames {
        let mut end = frames;
        if MOVING != NOTHING {
            // A ramp of 0 frames does not move, so any position on it is the same.
            let (middle, left) = stair(form.passed + start, form.line.max(1));
            end = frames.min(start + left);
            let middle = V::splat(proof, middle);
            for n in 0..N {
                for g in 0..G {
                    alpha[n][g] = middle.mul_add(alpha_step[n][g], alpha_start[n][g]);
                    beta[n][g] = middle.mul_add(beta_step[n][g], beta_start[n][g]);
                }
            }
        }
        for i in start..end {
            for n in 0..N {
                let (mut sum_left, mut sum_right) = (V::splat(proof, 0.0), V::splat(proof, 0.0));
                for g in 0..G {
                    let (mut x_now, mut y_now) = (x[n][g], y[n][g]);
                    if FORCE == PUSHED {
                        y_now = V::splat(proof, force[i]).mul_add(pushed[n][g], y_now);
                    } else if FORCE == DRIVEN || FORCE == ALL || FORCE == TURNED {
                        let (pulse, burst) = (V::splat(proof, pulse[i]), V::splat(proof, drive.noise[i]));
                        if FORCE == ALL || FORCE == TURNED {
                            let pull = V::splat(proof, drive.pull[i]);
                            y_now = pull.mul_add(pull_y[n][g], y_now);
                            x_now = pull.mul_add(pull_x[n][g], x_now);
                        }
                        y_now = burst.mul_add(noise[n][g], pulse.mul_add(pulse_y[n][g], y_now));
                        x_now = pulse.mul_add(pulse_x[n][g], x_now);
                        if FORCE == TURNED {
                            x_now = burst.mul_add(noise_x[n][g], x_now);
                        }
                    }
                    // The values that change every frame are negated, since negated coefficients would need additional registers.
                    let (alpha, beta) = (alpha[n][g], beta[n][g]);
                    let (to_x, to_y) = (y_now.mul_add(beta, x_now), x_now.neg_mul_add(beta, y_now));
                    (x_now, y_now) = (x_now.neg_mul_add(alpha, to_x), y_now.neg_mul_add(alpha, to_y));
                    (x[n][g], y[n][g]) = (x_now, y_now);
                    if !stereo {
                        sum_left = if g == 0 { x_now } else { sum_left.add(x_now) };
                        continue;
                    }
                    let (mut left, mut right) = (left[n][g], right[n][g]);
                    if MOVING == PITCH_AND_GAIN {
                        let passed = V::splat(proof, (form.passed + i + 1) as f32);
                        left = passed.mul_add(left_step[n][g], left);
                        right = passed.mul_add(right_step[n][g], right);
                    }
                    sum_left = if g == 0 { x_now.mul(left) } else { x_now.mul_add(left, sum_left) };
                    sum_right = if g == 0 { x_now.mul(right) } else { x_now.mul_add(right, sum_right) };
                }
                let lane = lane + n * V::WIDTH;
                sum_left.fold(proof, lane, &mut partial_left[i]);
                if stereo {
                    sum_right.fold(proof, lane, &mut partial_right[i]);
                }
            }
        }
        start = end;
    }
    for n in 0..N {
        for g in 0..G {
            let at = lane + g * LANES + n * V::WIDTH;
            x[n][g].store(&mut state.x.0[at..]);
            y[n][g].store(&mut state.y.0[at..]);
        }
    }
}
