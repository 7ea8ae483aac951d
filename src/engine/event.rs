//! What happens to the engine, and at which frame.

use crate::params::Param;

/// An event at a frame of the block that it is handed over with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Frame within the block; a frame beyond its end is taken as its last.
    pub frame: u32,
    /// MIDI channel, 0–15.
    pub channel: u8,
    /// What happens.
    pub kind: EventKind,
}

/// What happens. Out-of-range numbers are clamped where they are used; NaN counts as zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EventKind {
    /// A key goes down. Velocity 0 strikes with no force; MIDI's "velocity 0 is a note-off" is the reader's to translate.
    NoteOn {
        /// MIDI key, 0–127.
        key: u8,
        /// Offset from the key in semitones, for pitches between keys.
        detune: f32,
        /// 0–1.
        velocity: f32,
        /// The host's identifier of this note, or −1.
        id: i32,
    },
    /// A key comes up.
    NoteOff {
        /// MIDI key, 0–127.
        key: u8,
        /// 0–1; 0.5 where the controller does not tell.
        velocity: f32,
        /// Ends the note with this identifier only, or any on the key if −1.
        id: i32,
    },
    /// Pressure on one key, 0–1.
    PolyPressure {
        /// MIDI key, 0–127.
        key: u8,
        /// 0–1.
        pressure: f32,
    },
    /// Pressure on the whole channel, 0–1.
    ChannelPressure(f32),
    /// Pitch wheel, −1 to 1.
    PitchBend(f32),
    /// A controller, 0–127, at a value 0–1.
    Control {
        /// MIDI controller number.
        controller: u8,
        /// 0–1, where MIDI says 0–127.
        value: f32,
    },
    /// A parameter takes a new value, in the table's unit.
    Param {
        /// Which.
        param: Param,
        /// In the table's unit.
        value: f32,
    },
    /// All notes of a choke group are silenced (sent between the channels of an ensemble).
    Choke {
        /// 1–16; 0 silences nothing.
        group: u8,
    },
    /// The channel changes to the program of this number (acted on by the ensemble; a single synth ignores it).
    Program(u8),
}
