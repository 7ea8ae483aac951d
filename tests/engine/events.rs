//! Events on the first channel, in a short form for tests.

use sprung::engine::{Event, EventKind};

pub(crate) fn event(frame: u32, kind: EventKind) -> Event {
    Event { frame, channel: 0, kind }
}

pub(crate) fn on(frame: u32, key: u8) -> Event {
    event(frame, EventKind::NoteOn { key, detune: 0.0, velocity: 1.0, id: None })
}

pub(crate) fn off(frame: u32, key: u8) -> Event {
    event(frame, EventKind::NoteOff { key, velocity: 0.5, id: None })
}
