//! What happens to the engine, and at which frame.

use super::note::{NoteId, Notes};
use crate::params::Param;

/// An event at a frame of the block that it is handed over with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Frame within the block; a frame beyond its end is taken as its last.
    pub frame: u32,
    /// MIDI channel, 0–15; a number above is taken as 15.
    pub channel: u8,
    /// What happens.
    pub kind: EventKind,
}

/// What happens. Numbers out of range are clamped where they are used, keys and channels as well; NaN counts as zero.
/// A controller, program or choke group that does not exist changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EventKind {
    /// A key goes down; one that the tuning leaves unmapped starts nothing. Velocity 0 strikes with no force; MIDI's "velocity 0 is a note-off" is the reader's to translate.
    NoteOn {
        /// MIDI key, 0–127.
        key: u8,
        /// Offset from the tuned key in semitones, for pitches between keys.
        detune: f32,
        /// 0–1.
        velocity: f32,
        /// The identifier that the host gives this note.
        id: Option<NoteId>,
    },
    /// A key comes up.
    NoteOff {
        /// MIDI key, 0–127.
        key: u8,
        /// 0–1; 0.5 where the controller does not tell.
        velocity: f32,
        /// Ends the note with this identifier only; none for any on the key.
        id: Option<NoteId>,
    },
    /// Pressure on one key, 0–1.
    PolyPressure {
        /// MIDI key, 0–127.
        key: u8,
        /// 0–1.
        pressure: f32,
    },
    /// Keys come up: a note-off as plugin hosts put it.
    Release {
        /// The notes that the keys belong to.
        notes: Notes,
        /// 0–1; 0.5 where the host does not tell.
        velocity: f32,
    },
    /// Notes are silenced within a few milliseconds.
    Silence {
        /// Which.
        notes: Notes,
    },
    /// Notes are told how to sound. It lasts until their next word, and ends when the note leaves its voice: a key that
    /// a monophonic voice comes back to starts neutral.
    Express {
        /// Which.
        notes: Notes,
        /// What is told.
        expression: Expression,
        /// In the expression's unit.
        value: f32,
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
    /// A parameter is moved away from its value, by an offset in knob travel (−1 to 1, see
    /// [`crate::params::ParamInfo::normalise`]).
    Modulate {
        /// The sounding note that is meant, which then heeds its own offset only; none for the whole instrument. A
        /// note can be modulated in the parameters that it follows while it sounds ([`crate::params::Change::Smoothed`]).
        id: Option<NoteId>,
        /// Which.
        param: Param,
        /// Knob travel.
        offset: f32,
    },
    /// Beats per minute, on all channels.
    Tempo(f32),
    /// All notes of a choke group are silenced (sent between the channels of an ensemble).
    Choke {
        /// 1–16; 0 silences nothing.
        group: u8,
    },
    /// The channel changes to the program of this number (acted on by the ensemble; a single synth ignores it).
    Program(u8),
}

/// What a note can be told while it sounds: the expressions of CLAP and VST3, and MIDI's polyphonic pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expression {
    /// Offset in semitones, −128 to 128.
    Tuning,
    /// Amplitude ratio, 0–4.
    Volume,
    /// −1 (left) to 1 (right).
    Pan,
    /// 0–1; acts as the channel's pressure does, where it is the greater.
    Pressure,
    /// 0–1, neutral at 0.5: the source `timbre` of routes. By those of a new patch it tilts the strike by up to 12 dB per
    /// octave either way, and below 0.5 it damps the higher modes of what sounds.
    Brightness,
    /// 0–1; acts as the modulation wheel does, where it is the greater.
    Vibrato,
    /// 0–1: swells as controller 11 does.
    Swell,
}

impl Expression {
    /// Every expression.
    pub const ALL: [Expression; 7] =
        [Self::Tuning, Self::Volume, Self::Pan, Self::Pressure, Self::Brightness, Self::Vibrato, Self::Swell];
}

/// A number, 0 where there is none.
pub(super) fn finite(value: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value }
}

/// A number from 0 to 1.
pub(super) fn unit(value: f32) -> f32 {
    finite(value).clamp(0.0, 1.0)
}
