//! Events as a CLAP host sends them.

use clack_host::events::event_types::{
    Midi2Event, MidiEvent, NoteChokeEvent, NoteExpressionEvent, NoteExpressionType, NoteOffEvent, NoteOnEvent,
    ParamModEvent, ParamValueEvent, TransportEvent, TransportFlags,
};
use clack_host::events::{EventFlags, EventHeader};
use clack_host::prelude::*;
use clack_host::utils::{BeatTime, SecondsTime};

/// Channel, key and note id of a note, or of all notes that match; −1 matches any.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Address {
    pub(crate) channel: i16,
    pub(crate) key: i16,
    pub(crate) id: i32,
}

/// An event that a host sends.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Sent {
    /// A note with a velocity of 0–1.
    On(Address, f64),
    Off(Address, f64),
    Choke(Address),
    Express(Address, NoteExpressionType, f64),
    /// A parameter's value: the position of its knob, or a step.
    Value(ClapId, f64),
    /// The same bytes as [`Sent::Value`], but in a namespace that is not CLAP's.
    Foreign(ClapId, f64),
    /// An offset of a parameter for all notes that match an address.
    Modulate(ClapId, Address, f64),
    /// A MIDI message.
    Midi([u8; 3]),
    /// A MIDI 2.0 message, which the plugin has not requested.
    Midi2([u32; 4]),
    /// The tempo in beats per minute.
    Tempo(f64),
}

/// An event with its frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Timed {
    pub(crate) frame: u64,
    pub(crate) sent: Sent,
}

impl Address {
    /// A note without an id.
    pub(crate) fn key(channel: i16, key: i16) -> Self {
        Self { channel, key, id: -1 }
    }

    /// A note with an id.
    pub(crate) fn note(channel: i16, key: i16, id: i32) -> Self {
        Self { channel, key, id }
    }

    /// All notes with this id.
    pub(crate) fn id(id: i32) -> Self {
        Self { channel: -1, key: -1, id }
    }

    fn pckn(self) -> Pckn {
        Pckn::from_raw(0, self.channel, self.key, self.id)
    }
}

impl From<Pckn> for Address {
    fn from(pckn: Pckn) -> Self {
        Self { channel: pckn.raw_channel(), key: pckn.raw_key(), id: pckn.raw_note_id() }
    }
}

impl Sent {
    /// This event at a frame of the song.
    pub(crate) fn at(self, frame: u64) -> Timed {
        Timed { frame, sent: self }
    }

    /// Appends this event to the events of a block.
    pub(crate) fn push(self, time: u32, buffer: &mut EventBuffer) {
        match self {
            Sent::On(address, velocity) => buffer.push(&NoteOnEvent::new(time, address.pckn(), velocity)),
            Sent::Off(address, velocity) => buffer.push(&NoteOffEvent::new(time, address.pckn(), velocity)),
            Sent::Choke(address) => buffer.push(&NoteChokeEvent::new(time, address.pckn())),
            Sent::Express(address, kind, value) => {
                buffer.push(&NoteExpressionEvent::new(time, address.pckn(), kind, value));
            }
            Sent::Value(id, value) => buffer.push(&ParamValueEvent::new(time, id, Pckn::match_all(), value)),
            Sent::Foreign(id, value) => buffer.push(&foreign(ParamValueEvent::new(time, id, Pckn::match_all(), value))),
            Sent::Modulate(id, address, amount) => {
                buffer.push(&ParamModEvent::new(time, id, address.pckn(), amount));
            }
            Sent::Midi(data) => buffer.push(&MidiEvent::new(time, 0, data)),
            Sent::Midi2(data) => buffer.push(&Midi2Event::new(time, 0, data)),
            Sent::Tempo(tempo) => buffer.push(&transport(time, tempo)),
        }
    }
}

/// Moves an event out of CLAP's namespace.
#[allow(unsafe_code)]
fn foreign(mut event: ParamValueEvent) -> ParamValueEvent {
    // SAFETY: nothing here reads the event with its old type, and a receiver must check the namespace first.
    unsafe { event.as_raw_mut() }.header.space_id = 0xB33F;
    event
}

/// A transport that plays at a tempo and contains no other information.
pub(crate) fn transport(time: u32, tempo: f64) -> TransportEvent {
    TransportEvent {
        header: EventHeader::new_core(time, EventFlags::empty()),
        flags: TransportFlags::HAS_TEMPO | TransportFlags::IS_PLAYING,
        song_pos_beats: BeatTime::from_int(0),
        song_pos_seconds: SecondsTime::from_int(0),
        tempo,
        tempo_inc: 0.0,
        loop_start_beats: BeatTime::from_int(0),
        loop_end_beats: BeatTime::from_int(0),
        loop_start_seconds: SecondsTime::from_int(0),
        loop_end_seconds: SecondsTime::from_int(0),
        bar_start: BeatTime::from_int(0),
        bar_number: 0,
        time_signature_numerator: 4,
        time_signature_denominator: 4,
    }
}
