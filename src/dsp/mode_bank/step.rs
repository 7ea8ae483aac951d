//! The register form of a bank: all modes stepped, sample by sample, with their state in registers.
//!
//! A frame turns each mode's state: `x ← x − αx + βy`, `y ← y − αy − βx`, both from the old state. Modes are added up
//! by lane (`m mod 16`) and then the lanes by halves: that order is frozen. Modes at rest add `+0` and can be left out
//! without changing a bit.

use super::MAX_MODES;
use super::levels::Kernel;
use super::rows::{Form, Modes, Moving, Output, Row, State};
use super::vector::{LANES, Partial, Vector};
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::exciter::Drive;

/// How much of a [`Drive`] is read: nothing, one force that acts on `y`, or all that there is.
const FREE: u8 = 0;
const PUSHED: u8 = 1;
const DRIVEN: u8 = 2;

/// What moves while frames are rendered, as [`Moving`] has it.
const NOTHING: u8 = 0;
const PITCH: u8 = 1;
const PITCH_AND_GAIN: u8 = 2;

/// Frames to the right: none but in stereo.
const STEREO: usize = CONTROL_FRAMES;

/// Steps the live modes through some frames.
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
        match (self.form.moving, force, self.form.stereo) {
            (Moving::Nothing, FREE, false) => self.all::<V, NOTHING, FREE, 0>(proof),
            (Moving::Nothing, FREE, true) => self.all::<V, NOTHING, FREE, STEREO>(proof),
            (Moving::Nothing, PUSHED, false) => self.all::<V, NOTHING, PUSHED, 0>(proof),
            (Moving::Nothing, PUSHED, true) => self.all::<V, NOTHING, PUSHED, STEREO>(proof),
            (Moving::Nothing, _, false) => self.all::<V, NOTHING, DRIVEN, 0>(proof),
            (Moving::Nothing, _, true) => self.all::<V, NOTHING, DRIVEN, STEREO>(proof),
            (Moving::Pitch, FREE, false) => self.all::<V, PITCH, FREE, 0>(proof),
            (Moving::Pitch, FREE, true) => self.all::<V, PITCH, FREE, STEREO>(proof),
            (Moving::Pitch, PUSHED, false) => self.all::<V, PITCH, PUSHED, 0>(proof),
            (Moving::Pitch, PUSHED, true) => self.all::<V, PITCH, PUSHED, STEREO>(proof),
            (Moving::Pitch, _, false) => self.all::<V, PITCH, DRIVEN, 0>(proof),
            (Moving::Pitch, _, true) => self.all::<V, PITCH, DRIVEN, STEREO>(proof),
            // Seldom: one function for all of it.
            (Moving::PitchAndGain, ..) => self.all::<V, PITCH_AND_GAIN, DRIVEN, STEREO>(proof),
        }
    }
}

impl Step<'_> {
    /// How much of the force of these frames has to be read. What is left out would have added zeros.
    #[inline(always)]
    fn force(&self) -> u8 {
        let (live, frames) = (self.form.live.min(MAX_MODES), self.form.frames.min(CONTROL_FRAMES));
        match (is_zero(&self.drive.pulse[..frames]), is_zero(&self.drive.noise[..frames])) {
            (true, true) => FREE,
            (true, false) => PUSHED,
            (false, true) if is_zero(&self.modes.pulse_x.0[..live]) => PUSHED,
            _ => DRIVEN,
        }
    }

    #[inline(always)]
    fn all<V: Vector, const MOVING: u8, const FORCE: u8, const RIGHT: usize>(self, proof: V::Proof) {
        let Self { form, modes, state, drive, out } = self;
        let (live, frames) = (form.live.min(MAX_MODES), form.frames.min(CONTROL_FRAMES));
        let line: [f32; CONTROL_FRAMES] = std::array::from_fn(|i| (form.passed + i + 1) as f32);
        let (mut left, mut right) = ([Partial([0.0; LANES]); CONTROL_FRAMES], [Partial([0.0; LANES]); RIGHT]);
        macro_rules! run {
            ($groups:literal, $vectors:literal, $at:expr) => {
                step_some::<V, $groups, $vectors, MOVING, FORCE, RIGHT>(
                    proof,
                    modes,
                    state,
                    $at,
                    drive,
                    &line[..frames],
                    &mut left,
                    &mut right,
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
                // Coefficients that move take twice the registers.
                let vectors = if V::INTERLEAVE >= 8 && groups == 4 && MOVING == NOTHING { 2 } else { 1 };
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
        V::sum_lanes(proof, &left[..frames], &mut out[0]);
        if RIGHT > 0 {
            V::sum_lanes(proof, &right[..frames.min(RIGHT)], &mut out[1]);
        }
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

/// A number for each of the modes that are stepped together: of `G` groups of [`LANES`], `N` vectors side by side.
#[inline(always)]
fn load<V: Vector, const G: usize, const N: usize>(proof: V::Proof, row: &Row, at: usize) -> [[V; G]; N] {
    let mut vectors = [[V::splat(proof, 0.0); G]; N];
    for n in 0..N {
        for g in 0..G {
            vectors[n][g] = row.at(proof, at + g * LANES + n * V::WIDTH);
        }
    }
    vectors
}

/// Steps `G·N` vectors of modes, from mode `at`: enough of them to fill the time that one step has to wait for the
/// one before, few enough that most of their state stays in registers.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "a kernel: everything in registers")]
fn step_some<V: Vector, const G: usize, const N: usize, const MOVING: u8, const FORCE: u8, const RIGHT: usize>(
    proof: V::Proof,
    modes: &Modes,
    state: &mut State,
    at: usize,
    drive: &Drive,
    line: &[f32],
    partial_left: &mut [Partial; CONTROL_FRAMES],
    partial_right: &mut [Partial; RIGHT],
) {
    let (stereo, frames) = (RIGHT > 0, line.len());
    macro_rules! rows {
        ($($row:expr),*) => { ($(load::<V, G, N>(proof, &$row, at)),*) };
    }
    let (mut x, mut y) = rows!(state.x, state.y);
    let (alpha, alpha_step, beta, beta_step) = rows!(modes.alpha, modes.alpha_step, modes.beta, modes.beta_step);
    let (left, left_step, right, right_step) = rows!(modes.left, modes.left_step, modes.right, modes.right_step);
    let (pulse_x, pulse_y, noise) = rows!(modes.pulse_x, modes.pulse_y, modes.noise);
    // The one force that acts on y, if there is but one.
    let by_noise = FORCE == PUSHED && is_zero(&drive.pulse[..frames]);
    let (force, pushed) = if by_noise { (&drive.noise, noise) } else { (&drive.pulse, pulse_y) };
    for i in 0..frames {
        let on_line = V::splat(proof, line[i]);
        for n in 0..N {
            let lane = at % LANES + n * V::WIDTH;
            let mut sum_left = V::load(proof, &partial_left[i].0[lane..]);
            let mut sum_right = if stereo { V::load(proof, &partial_right[i].0[lane..]) } else { sum_left };
            for g in 0..G {
                let (mut x_now, mut y_now) = (x[n][g], y[n][g]);
                let (mut alpha, mut beta) = (alpha[n][g], beta[n][g]);
                if MOVING != NOTHING {
                    alpha = on_line.mul_add(alpha_step[n][g], alpha);
                    beta = on_line.mul_add(beta_step[n][g], beta);
                }
                if FORCE == PUSHED {
                    y_now = V::splat(proof, force[i]).mul_add(pushed[n][g], y_now);
                } else if FORCE == DRIVEN {
                    let (pulse, burst) = (V::splat(proof, drive.pulse[i]), V::splat(proof, drive.noise[i]));
                    y_now = burst.mul_add(noise[n][g], pulse.mul_add(pulse_y[n][g], y_now));
                    x_now = pulse.mul_add(pulse_x[n][g], x_now);
                }
                let (to_x, to_y) = (beta.mul_add(y_now, x_now), beta.neg_mul_add(x_now, y_now));
                (x_now, y_now) = (alpha.neg_mul_add(x_now, to_x), alpha.neg_mul_add(y_now, to_y));
                if stereo {
                    let (mut left, mut right) = (left[n][g], right[n][g]);
                    if MOVING == PITCH_AND_GAIN {
                        left = on_line.mul_add(left_step[n][g], left);
                        right = on_line.mul_add(right_step[n][g], right);
                    }
                    sum_left = x_now.mul_add(left, sum_left);
                    sum_right = x_now.mul_add(right, sum_right);
                } else {
                    sum_left = sum_left.add(x_now);
                }
                (x[n][g], y[n][g]) = (x_now, y_now);
            }
            sum_left.store(&mut partial_left[i].0[lane..]);
            if stereo {
                sum_right.store(&mut partial_right[i].0[lane..]);
            }
        }
    }
    // Vector by vector. Row by row, the compiler keeps a displacement in memory all through the loop over frames.
    for n in 0..N {
        for g in 0..G {
            let at = at + g * LANES + n * V::WIDTH;
            x[n][g].store(&mut state.x.0[at..]);
            y[n][g].store(&mut state.y.0[at..]);
        }
    }
}
