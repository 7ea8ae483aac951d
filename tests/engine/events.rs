//! Events on the first channel, in a short form for tests, and what a synth plays of them.

use sprung::engine::{Event, EventKind, NoteId, Synth};
use sprung::patch::Patch;

/// The left side of some frames of a patch, at a rate and with a seed.
pub(crate) fn played(patch: &Patch, (rate, seed): (f64, u64), events: &[Event], frames: usize) -> Vec<f32> {
    let mut synth = Synth::new(rate, seed);
    synth.set_patch(patch);
    let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
    synth.process(events, &mut left, &mut right);
    left
}

pub(crate) fn event(frame: u32, kind: EventKind) -> Event {
    Event { frame, channel: 0, kind }
}

pub(crate) fn on(frame: u32, key: u8) -> Event {
    Event::note_on(frame, key, 1.0)
}

pub(crate) fn off(frame: u32, key: u8) -> Event {
    Event::note_off(frame, key)
}

/// With a host's identifier; none if `id` is negative.
pub(crate) fn on_with_id(frame: u32, channel: u8, key: u8, id: i32) -> Event {
    Event { frame, channel, kind: EventKind::NoteOn { key, detune: 0.0, velocity: 1.0, id: NoteId::new(id) } }
}
