//! The events that the engine handles, and the frames at which they occur.

use super::note::{NoteId, Notes};
use crate::params::Param;
use crate::sound::Contact;

/// An event, at a frame of the block that it is passed with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Frame within the block. A frame beyond the end counts as the last one.
    pub frame: u32,
    /// MIDI channel, 0–15. A greater number counts as 15.
    pub channel: u8,
    /// The kind of the event, with its data.
    pub kind: EventKind,
}

impl Event {
    /// A key of channel 0 goes down with a velocity of 0–1: exactly its tuned pitch, without an identifier.
    ///
    /// ```
    /// use sprung::engine::{Event, Synth};
    ///
    /// let mut synth = Synth::new(48_000.0, 0);
    /// let (mut left, mut right) = ([0.0; 480], [0.0; 480]);
    /// synth.process(&[Event::note_on(0, 60, 0.8), Event::note_off(240, 60)], &mut left, &mut right);
    /// // On another channel:
    /// let drum = Event { channel: 9, ..Event::note_on(0, 36, 1.0) };
    /// synth.process(&[drum], &mut left, &mut right);
    /// ```
    pub fn note_on(frame: u32, key: u8, velocity: f32) -> Self {
        Self { frame, channel: 0, kind: EventKind::NoteOn { key, detune: 0.0, velocity, id: None } }
    }

    /// A key of channel 0 goes up, with the velocity of controllers that send none: ends all notes on the key.
    pub fn note_off(frame: u32, key: u8) -> Self {
        Self { frame, channel: 0, kind: EventKind::NoteOff { key, velocity: 0.5, id: None } }
    }
}

/// The kind of an event. Values out of range are clamped where they are used, keys and channels too; NaN counts as
/// zero. A controller, program or choke group that does not exist changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EventKind {
    /// Starts a note. A key that the tuning does not map starts none. Velocity 0 is a strike without force: code that
    /// reads MIDI must translate "note on with velocity 0" to a note off.
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
    /// Another body hits the object that a key stands for: a note on with that body as the mallet, as
    /// [`Sound::strike`](crate::sound::Sound::strike) describes it. If the sound has noise or a pluck, they use the velocity
    /// whose square is the impulse. The key counts as down.
    Strike {
        /// MIDI key, 0–127.
        key: u8,
        /// The hit.
        contact: Contact,
    },
    /// Pushes one mode of a key's sounding note in the direction in which it moves, so that its amplitude grows and the output
    /// does not jump. Nothing else about the note changes. If no note of the key sounds, or if it has no such mode, nothing
    /// happens; to let a mode sound alone, send a note on with velocity 0 before it, at the same frame.
    Nudge {
        /// MIDI key, 0–127.
        key: u8,
        /// Number of the mode, from 0.
        mode: u16,
        /// 0–1: how much the amplitude grows at most. 1 is what the strongest of mallet, pluck and noise gives the mode at full
        /// force wherever it acts, or 0 dB if all three are off. Unison voices share its energy.
        amplitude: f32,
    },
    /// Releases a key.
    NoteOff {
        /// MIDI key, 0–127.
        key: u8,
        /// 0–1; 0.5 if the controller does not send one.
        velocity: f32,
        /// Ends only the note with this identifier, or notes without one; if none, all notes on the key.
        id: Option<NoteId>,
    },
    /// Pressure on one key, 0–1.
    PolyPressure {
        /// MIDI key, 0–127.
        key: u8,
        /// 0–1.
        pressure: f32,
    },
    /// Releases notes, as plugin hosts send it.
    Release {
        /// The notes to release.
        notes: Notes,
        /// 0–1; 0.5 if the host does not send one.
        velocity: f32,
    },
    /// Fades out notes within a few milliseconds.
    Silence {
        /// The notes to fade out.
        notes: Notes,
    },
    /// Sets a note expression. It lasts until the next one, or until the voice plays another note: if a monophonic voice
    /// returns to a held key, that note starts with neutral expressions.
    Express {
        /// The notes that it applies to.
        notes: Notes,
        /// The expression to set.
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
        /// 0–1, for MIDI's 0–127.
        value: f32,
    },
    /// Sets a parameter.
    Param {
        /// The parameter.
        param: Param,
        /// In the unit of the parameter table.
        value: f32,
    },
    /// Modulates a parameter: an offset from its value in knob travel (−1 to 1, see
    /// [`crate::params::ParamInfo::normalise`]).
    Modulate {
        /// The sounding note to modulate; none for the whole instrument. If a note has its own offset, the instrument's offset
        /// does not apply to it. Notes accept offsets only for parameters that they follow while they sound
        /// ([`crate::params::Change::Smoothed`]).
        id: Option<NoteId>,
        /// The parameter.
        param: Param,
        /// Offset in knob travel.
        offset: f32,
    },
    /// Modulates a parameter of sounding notes, each as [`EventKind::Modulate`] does one.
    ModulateNotes {
        /// The notes that it applies to.
        notes: Notes,
        /// The parameter.
        param: Param,
        /// Offset in knob travel.
        offset: f32,
    },
    /// Sets the tempo in beats per minute, on all channels.
    Tempo(f32),
    /// Gives a key of the channel's instrument another pitch, as MIDI Tuning Standard does. Sounds with a tuning of their own keep it.
    Tune {
        /// MIDI key, 0–127.
        key: u8,
        /// 0–128, in semitones on the MIDI scale: 69 is A4.
        pitch: f32,
        /// Whether notes of the key that sound now follow, or only later ones have the pitch.
        sounding: bool,
    },
    /// Silences all notes of a choke group (sent between the channels of an ensemble).
    Choke {
        /// 1–16; 0 silences nothing.
        group: u8,
    },
    /// Selects a program for the channel. An ensemble handles it; a single synth ignores it.
    Program(u8),
}

/// The note expressions: those of CLAP and VST3, and MIDI's polyphonic pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expression {
    /// Offset in semitones, −128 to 128.
    Tuning,
    /// Amplitude ratio, 0–4.
    Volume,
    /// −1 (left) to 1 (right).
    Pan,
    /// 0–1. The greater of it and the channel's pressure counts.
    Pressure,
    /// 0–1, neutral at 0.5: the source `timbre` of routes. In a new patch, routes tilt the strike's spectrum by up to 12 dB
    /// per octave in either direction, and values below 0.5 also damp the higher modes while they sound.
    Brightness,
    /// 0–1. The greater of it and the modulation wheel counts.
    Vibrato,
    /// 0–1, acts as controller 11 (expression) does.
    Swell,
}

impl Expression {
    /// Every expression.
    pub const ALL: [Expression; 7] =
        [Self::Tuning, Self::Volume, Self::Pan, Self::Pressure, Self::Brightness, Self::Vibrato, Self::Swell];
}

/// The value, or 0 if it is NaN.
pub(super) fn finite(value: f32) -> f32 {
    if value.is_nan() { 0.0 } else { value }
}

/// The value clamped to 0–1, or 0 if it is NaN.
pub(super) fn unit(value: f32) -> f32 {
    finite(value).clamp(0.0, 1.0)
}
