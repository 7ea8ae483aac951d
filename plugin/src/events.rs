//! The wrapper's note events as the engine's.

use nice_plug_core::midi::NoteEvent;
use sprung::engine::EventKind;
use sprung::io::midi::parse_message;

/// The engine's event, and its channel. `None` for what an instrument has no use for, and for a note without a key.
/// Real-time safe.
pub(crate) fn translate(event: &NoteEvent<()>) -> Option<(u8, EventKind)> {
    match *event {
        NoteEvent::NoteOn { voice_id, channel, key, velocity, .. } => {
            let id = voice_id.id().unwrap_or(-1);
            let kind = EventKind::NoteOn { key: key.number()?, detune: 0.0, velocity, id };
            Some((channel.number().unwrap_or(0), kind))
        }
        NoteEvent::NoteOff { voice_id, channel, key, velocity, .. } => {
            let id = voice_id.id().unwrap_or(-1);
            Some((channel.number()?, EventKind::NoteOff { key: key.number()?, velocity, id }))
        }
        NoteEvent::PolyPressure { channel, key, pressure, .. } => {
            Some((channel.number()?, EventKind::PolyPressure { key: key.number()?, pressure }))
        }
        NoteEvent::MidiChannelPressure { channel, pressure, .. } => {
            Some((channel, EventKind::ChannelPressure(pressure)))
        }
        NoteEvent::MidiPitchBend { channel, value, .. } => Some((channel, bend(value))),
        NoteEvent::MidiCC { channel, cc, value, .. } => Some((channel, EventKind::Control { controller: cc, value })),
        _ => None,
    }
}

/// A wheel's position 0–1 as an event: that of the 14 bits it was made from, if it was made from 14 bits, so that it
/// is what a MIDI file gives.
fn bend(value: f32) -> EventKind {
    let steps = value * 16_383.0;
    let whole = steps.round();
    if (steps - whole).abs() < 0.01 && (0.0..=16_383.0).contains(&whole) {
        let whole = whole as u16;
        if let Some((_, kind)) = parse_message(&[0xE0, (whole & 127) as u8, (whole >> 7) as u8]) {
            return kind;
        }
    }
    EventKind::PitchBend(value * 2.0 - 1.0)
}
