//! Plays a case and compares its output with the bound.

use super::bound::{Step, UNKNOWN, bound};
use super::case::Case;
use sprung::engine::{Ensemble, Event, Outputs, Snapshot, Synth};
use sprung::sound::OUTPUTS;

/// Relative tolerance for single-precision rounding over all frames of a case.
const TOLERANCE: f64 = 1e-3;
/// Absolute tolerance of a sample: far below −120 dBFS.
const FLOOR: f64 = 1e-7;
/// Minimum number of frames between checks of snapshots and tails.
const LOOK_FRAMES: usize = 256;

/// A synth or an ensemble.
enum Player {
    Synth(Box<Synth>),
    /// With the left and right samples of its other outputs.
    Outputs(Box<Synth>, Vec<[Vec<f32>; 2]>),
    Ensemble(Box<Ensemble>),
}

impl Player {
    fn new(case: &Case) -> Self {
        if case.ensemble {
            return Player::Ensemble(Box::new(Ensemble::new(case.sample_rate, case.seed, &case.patch, &case.programs)));
        }
        let mut synth = Box::new(Synth::new(case.sample_rate, case.seed));
        synth.set_patch(&case.patch);
        if case.outputs {
            return Player::Outputs(synth, vec![[0, 1].map(|_| vec![0.0; case.block]); OUTPUTS]);
        }
        Player::Synth(synth)
    }

    /// Plays a block. What other outputs have is added to the main one: together they are the sound of all strikes.
    fn process(&mut self, events: &[Event], left: &mut [f32], right: &mut [f32]) {
        match self {
            Player::Synth(synth) => synth.process(events, left, right),
            Player::Outputs(synth, others) => {
                let frames = left.len();
                let sides = others.iter_mut().map(|sides| sides.each_mut().map(|side| &mut side[..frames]));
                synth.process_with_outputs(events, &[], left, right, &mut Outputs::new(sides));
                for [other_left, other_right] in others {
                    left.iter_mut().zip(other_left).for_each(|(sum, sample)| *sum += *sample);
                    right.iter_mut().zip(other_right).for_each(|(sum, sample)| *sum += *sample);
                }
            }
            Player::Ensemble(ensemble) => ensemble.process(events, left, right),
        }
    }

    fn snapshot(&self) -> Snapshot {
        match self {
            Player::Synth(synth) | Player::Outputs(synth, _) => {
                let mut snapshot = Snapshot::default();
                synth.show(&mut snapshot);
                snapshot
            }
            Player::Ensemble(ensemble) => ensemble.snapshot(),
        }
    }
}

/// Plays the case. Returns the largest share of its bound that a sample reached, if a bound is known, or the first error.
pub(crate) fn check(case: &Case) -> Result<Option<f64>, String> {
    let steps = bound(case);
    let mut player = Player::new(case);
    let (mut left, mut right) = (vec![0.0; case.block], vec![0.0; case.block]);
    let (mut highest, mut start, mut next, mut step, mut looked) = (0.0_f64, 0, 0, 0, 0);
    while start < case.frames {
        let frames = case.block.min(case.frames - start);
        let (left, right) = (&mut left[..frames], &mut right[..frames]);
        let events: Vec<Event> = case.events[next..]
            .iter()
            .take_while(|event| (event.frame as usize) < start + frames)
            .map(|event| Event { frame: event.frame - start as u32, ..*event })
            .collect();
        next += events.len();
        player.process(&events, left, right);

        for (i, samples) in left.iter().zip(&*right).enumerate() {
            let frame = start + i;
            while steps.get(step).is_some_and(|step| step.frame as usize <= frame) {
                step += 1;
            }
            let limits = step.checked_sub(1).map_or([0.0; 2], |step| steps[step].output);
            for (side, sample, limit) in [("left", *samples.0, limits[0]), ("right", *samples.1, limits[1])] {
                let size = f64::from(sample.abs());
                // NaN must not count as within the bound.
                let within = size <= limit * (1.0 + TOLERANCE) + FLOOR;
                if !within {
                    return Err(format!("frame {frame}, {side}: {sample} where the bound is {limit}"));
                }
                if limit > 1e-3 {
                    highest = highest.max(size / limit);
                }
            }
        }
        start += frames;
        if start - looked >= LOOK_FRAMES || start == case.frames {
            looked = start;
            look(&mut player, step.checked_sub(1).map(|step| &steps[step]), start)?;
        }
    }
    Ok(steps.last().is_none_or(|step| step.displacement < UNKNOWN).then_some(highest))
}

/// Checks that the visible state of the player at the end of a block is finite and within the bound of its strikes.
fn look(player: &mut Player, step: Option<&Step>, frame: usize) -> Result<(), String> {
    let limit = step.map_or(0.0, |step| step.displacement) * (1.0 + TOLERANCE) + FLOOR;
    for (m, mass) in player.snapshot().masses.iter().enumerate() {
        let within = f64::from(mass.displacement.abs()) <= limit;
        if !within {
            return Err(format!("frame {frame}: mass {m} at {} where the bound is {limit}", mass.displacement));
        }
        if !(mass.energy >= 0.0 && f64::from(mass.energy) <= limit * limit) {
            return Err(format!("frame {frame}: mass {m} with energy {} where the bound is {limit}²", mass.energy));
        }
    }
    if let Player::Synth(synth) | Player::Outputs(synth, _) = player {
        // An overflow here panics in builds with overflow checks.
        let tail = synth.tail_frames();
        if tail > 0 && synth.is_silent() {
            return Err(format!("frame {frame}: a tail of {tail} frames of silence"));
        }
    }
    Ok(())
}
