//! MIDI messages as the engine's events.

use crate::engine::EventKind;
use midly::live::LiveEvent;
use midly::{MidiMessage, PitchBend};

/// The channel and event of one complete MIDI message, as a port delivers them; none for what is not a channel
/// message. Real-time safe.
pub fn parse_message(bytes: &[u8]) -> Option<(u8, EventKind)> {
    match LiveEvent::parse(bytes) {
        Ok(LiveEvent::Midi { channel, message }) => Some((channel.as_int(), translate(message))),
        _ => None,
    }
}

/// The event that a channel message stands for.
pub(super) fn translate(message: MidiMessage) -> EventKind {
    let unit = |value: midly::num::u7| f32::from(value.as_int()) / 127.0;
    match message {
        // A note-on of velocity 0 is a note-off whose velocity the controller does not tell (MIDI 1.0).
        MidiMessage::NoteOn { key, vel } if vel == 0 => EventKind::NoteOff { key: key.as_int(), velocity: 0.5, id: -1 },
        MidiMessage::NoteOn { key, vel } => {
            EventKind::NoteOn { key: key.as_int(), detune: 0.0, velocity: unit(vel), id: -1 }
        }
        MidiMessage::NoteOff { key, vel } => EventKind::NoteOff { key: key.as_int(), velocity: unit(vel), id: -1 },
        MidiMessage::Aftertouch { key, vel } => EventKind::PolyPressure { key: key.as_int(), pressure: unit(vel) },
        MidiMessage::ChannelAftertouch { vel } => EventKind::ChannelPressure(unit(vel)),
        MidiMessage::Controller { controller, value } => {
            EventKind::Control { controller: controller.as_int(), value: unit(value) }
        }
        MidiMessage::ProgramChange { program } => EventKind::Program(program.as_int()),
        MidiMessage::PitchBend { bend } => EventKind::PitchBend(bend_position(bend)),
    }
}

/// −8192…8191 as −1…1: both ends and the centre are exact, so the upper half has steps of its own.
fn bend_position(bend: PitchBend) -> f32 {
    let steps = f32::from(bend.as_int());
    if steps < 0.0 { steps / 8192.0 } else { steps / 8191.0 }
}
