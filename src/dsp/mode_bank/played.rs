//! The bank under a bow or a breath, stepped frame by frame.
//!
//! The force of each frame depends on the state after the previous one. It acts on `x`, the audible coordinate, by a mode's
//! *take*, and the sum of *give* times `x` is what the player feels: the speed of the point under a bow, the pressure behind a
//! valve. What is heard of a bow and a breath is `x` in the middle of two pushes, where a constant force, as of a bow that only
//! pulls, has hardly moved it; what a hammer has pushed by the end of a frame is heard then. One pass over the bank turns all modes and adds up what they
//! give for the next frame, first by lane (`m mod 16`) and then by halves of the lanes, as in `step`. Bow and breath play only the first
//! bank of a body; a hammer feels all of them in every frame.
//!
//! **Bow.** Take and give are the same weights, whose squares add up to 1. So a force `F` changes the sum of the squared
//! amplitudes by `2 F (v + F/2)`, where `v` is the speed of the point. Friction brings the point towards the bow's speed and
//! never past it, so a frame adds at most `2 · force · speed`. `played_tests` tries 10,000 random bows and bodies, frame by
//! frame. Force is counted in bow speeds per radian of the note, so the same pressure suits all keys.
//!
//! **Breath.** A mode's level says how much of its pressure is heard. So it gives the reciprocal of its level, and takes its
//! share of the flow times its level: the breath feels the same tube, whatever is heard of it. Of a jet, flow and pressure
//! change places. See `exciter/valve` and `exciter/jet` for their energies.
//!
//! **Hammer.** Its force is constant within a frame, so that it acts on both coordinates, by what the mode has turned at the end
//! of that frame. The force is known only then, and acts at the start of the next one. See [`Hammer`] for the energy.
//!
//! [`Hammer`]: crate::dsp::exciter::Hammer

use super::MAX_MODES;
use super::rows::{Form, Modes, Output, State};
use super::tuning::stair;
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::exciter::{Drive, Player};
use crate::dsp::simd::vector::{LANES, Partial, Vector};
use crate::dsp::simd::{Instructions, Kernel};

/// A bank for some frames under a player.
pub(crate) struct Part<'a> {
    pub(super) instructions: Instructions,
    pub(super) form: Form,
    pub(super) modes: &'a Modes,
    pub(super) state: &'a mut State,
}

/// Steps the banks of a body through some frames, under a player who feels all of them and any other forces, and writes the sum of what is
/// heard. Returns the player's forces.
pub(crate) fn play(
    parts: &mut [Option<Part>],
    frames: usize,
    drive: &Drive,
    player: &mut Player,
    out: &mut Output,
) -> [f32; CONTROL_FRAMES] {
    let instructions = parts.iter().flatten().next().map_or_else(Instructions::current, |part| part.instructions);
    instructions.run(Played { parts, frames: frames.min(CONTROL_FRAMES), drive, player, out })
}

/// See [`play`].
struct Played<'a, 'b, 'c> {
    parts: &'a mut [Option<Part<'c>>],
    frames: usize,
    drive: &'a Drive,
    player: &'a mut Player<'b>,
    out: &'a mut Output,
}

/// Sums of a frame: left output, right output, and what the modes give the player.
type Sums = [f32; 3];

impl Kernel for Played<'_, '_, '_> {
    type Output = [f32; CONTROL_FRAMES];

    #[inline(always)]
    fn run<V: Vector>(self, proof: V::Proof) -> Self::Output {
        let Self { parts, frames, drive, player, out } = self;
        let ahead = player.heard_ahead();
        let mut forces = [0.0; CONTROL_FRAMES];
        let mut motion = 0.0;
        for Part { form, modes, state, .. } in parts.iter().flatten() {
            motion += given::<V>(proof, modes, state, form.live.min(MAX_MODES));
        }
        for i in 0..frames {
            let force = player.force_on(i, motion);
            forces[i] = force;
            let all = [force, ahead * force, drive.push[i], drive.pull[i], drive.noise[i]];
            let mut sums = [0.0; 3];
            for Part { form, modes, state, .. } in parts.iter_mut().flatten() {
                let own = turn::<V>(proof, form, modes, state, i, all);
                sums = [sums[0] + own[0], sums[1] + own[1], sums[2] + own[2]];
            }
            (out[0][i], out[1][i], motion) = (sums[0], sums[1], sums[2]);
        }
        forces
    }
}

/// What the modes give the player.
#[inline(always)]
fn given<V: Vector>(proof: V::Proof, modes: &Modes, state: &State, live: usize) -> f32 {
    let mut total = [Partial([0.0; LANES])];
    let mut at = 0;
    while at < live {
        let (x, give): (V, V) = (state.x.at(proof, at), modes.give.at(proof, at));
        let lane = &mut total[0].0[at % LANES..];
        x.mul_add(give, V::load(proof, lane)).store(lane);
        at += V::WIDTH;
    }
    let mut sum = [0.0];
    V::sum_lanes(proof, &total, &mut sum);
    sum[0]
}

/// Applies the forces (player, what of it is heard ahead, push, pull, noise) of a frame, and turns all modes.
#[inline(always)]
fn turn<V: Vector>(
    proof: V::Proof,
    form: &Form,
    modes: &Modes,
    state: &mut State,
    frame: usize,
    forces: [f32; 5],
) -> Sums {
    let (live, passed) = (form.live.min(MAX_MODES), form.passed + frame);
    let (middle, _) = stair(passed, form.line.max(1));
    let (middle, passed) = (V::splat(proof, middle), V::splat(proof, (passed + 1) as f32));
    let mut totals = [Partial([0.0; LANES]); 3];
    // One by one: a closure would be compiled without the level's instructions.
    let [played, ahead, push, pull, noise] = forces;
    let (played, ahead, push) = (V::splat(proof, played), V::splat(proof, ahead), V::splat(proof, push));
    let (pull, noise) = (V::splat(proof, pull), V::splat(proof, noise));
    let mut at = 0;
    while at < live {
        let (take, give): (V, V) = (modes.take.at(proof, at), modes.give.at(proof, at));
        let (mut x, mut y): (V, V) = (state.x.at(proof, at), state.y.at(proof, at));
        x = pull.mul_add(modes.pull_x.at(proof, at), played.mul_add(take, x));
        x = push.mul_add(modes.push_x.at(proof, at), x);
        y = push.mul_add(modes.push_y.at(proof, at), pull.mul_add(modes.pull_y.at(proof, at), y));
        y = noise.mul_add(modes.noise.at(proof, at), y);
        y = played.mul_add(modes.take_y.at(proof, at), y);
        if form.turned_noise {
            x = noise.mul_add(modes.noise_x.at(proof, at), x);
        }
        let alpha: V = middle.mul_add(modes.alpha_step.at(proof, at), modes.alpha.at(proof, at));
        let beta: V = middle.mul_add(modes.beta_step.at(proof, at), modes.beta.at(proof, at));
        let (to_x, to_y) = (y.mul_add(beta, x), x.neg_mul_add(beta, y));
        let (x, y) = (x.neg_mul_add(alpha, to_x), y.neg_mul_add(alpha, to_y));
        x.store(&mut state.x.0[at..]);
        y.store(&mut state.y.0[at..]);
        let left = passed.mul_add(modes.left_step.at(proof, at), modes.left.at(proof, at));
        let right = passed.mul_add(modes.right_step.at(proof, at), modes.right.at(proof, at));
        let [to_left, to_right, to_motion] = &mut totals;
        let lane = at % LANES;
        let heard = ahead.mul_add(take, x);
        heard.mul_add(left, V::load(proof, &to_left.0[lane..])).store(&mut to_left.0[lane..]);
        heard.mul_add(right, V::load(proof, &to_right.0[lane..])).store(&mut to_right.0[lane..]);
        x.mul_add(give, V::load(proof, &to_motion.0[lane..])).store(&mut to_motion.0[lane..]);
        at += V::WIDTH;
    }
    let mut sums = [0.0; 3];
    V::sum_lanes(proof, &totals, &mut sums);
    sums
}

#[cfg(test)]
#[path = "hammer_tests.rs"]
mod hammer_tests;
#[cfg(test)]
#[path = "played_tests.rs"]
mod tests;
