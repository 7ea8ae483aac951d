//! Renders notes of a patch with the engine.

use crate::analysis::level::mono;
use crate::analysis::log_mel::RATE;
use crate::engine::{Event, EventKind, Synth};
use crate::params::{Choice, Limiter, Param};
use crate::patch::Patch;

/// Frames per block.
const BLOCK: usize = 512;

/// A note to play.
#[derive(Clone, Copy)]
pub(super) struct Played {
    /// As a fractional MIDI key.
    pub(super) key: f64,
    /// 0–1.
    pub(super) velocity: f64,
    /// Number of frames that are rendered.
    pub(super) frames: usize,
    /// The frame at which the key is let go; none if it is held.
    pub(super) let_go: Option<usize>,
}

/// A synth that plays one note after another, each as if it were the first. Not real-time safe.
pub(super) struct Audition {
    synth: Synth,
    has_limiter: bool,
}

impl Audition {
    /// Without the limiter: a search for levels cannot see beyond it.
    pub(super) fn new() -> Self {
        Self { synth: Synth::new(RATE.into(), 0), has_limiter: false }
    }

    /// With the patch's limiter, as a player hears it.
    pub(super) fn with_limiter() -> Self {
        Self { has_limiter: true, ..Self::new() }
    }

    /// The first frames of a note, left and right.
    pub(super) fn play(&mut self, patch: &Patch, Played { key, velocity, frames, let_go }: Played) -> [Vec<f32>; 2] {
        // `set_patch` moves parameters smoothly to their new values; the reset makes the patch the present one at once.
        if self.has_limiter {
            self.synth.set_patch(patch);
        } else {
            self.synth.set_patch(&patch.clone().with(Param::Limiter, Limiter::Off.value()));
        }
        self.synth.reset();
        let nearest = key.round().clamp(0.0, 127.0);
        let on = EventKind::NoteOn {
            key: nearest as u8,
            detune: (key - nearest) as f32,
            velocity: velocity as f32,
            id: None,
        };
        let off = EventKind::NoteOff { key: nearest as u8, velocity: 0.5, id: None };
        let [mut left, mut right] = [vec![0.0; frames], vec![0.0; frames]];
        for (n, (left, right)) in left.chunks_mut(BLOCK).zip(right.chunks_mut(BLOCK)).enumerate() {
            let event = |at: usize, kind| {
                let frame = at.checked_sub(n * BLOCK).filter(|frame| *frame < left.len())?;
                Some(Event { frame: frame as u32, channel: 0, kind })
            };
            let events: Vec<Event> = event(0, on).into_iter().chain(let_go.and_then(|at| event(at, off))).collect();
            self.synth.process(&events, left, right);
        }
        [left, right]
    }

    /// As [`Audition::play`], the mean of both channels.
    pub(super) fn mean(&mut self, patch: &Patch, played: Played) -> Vec<f32> {
        mono(&self.play(patch, played))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_pass_the_audition_unless_a_player_is_to_hear_them() {
        let loud = Patch::default().with(Param::Gain, 12.0);
        let peak = |mut audition: Audition| {
            let note = Played { key: 60.0, velocity: 1.0, frames: 4800, let_go: None };
            audition.mean(&loud, note).iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()))
        };
        let [free, limited] = [Audition::new(), Audition::with_limiter()].map(peak);
        assert!(free > 1.5 && limited < 0.95, "{free}, {limited}");
    }
}
