//! A note as voices receive it, and how events select notes.

use super::portamento::NoteGlide;
use crate::sound::Contact;
use crate::sound::tuning::Pitch;

/// An identifier that a host gives to a note, to distinguish it from other notes on the same key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NoteId(u32);

impl NoteId {
    /// The identifier for a number as plugin hosts send it; none if it is negative, which stands for any note.
    /// Real-time safe.
    pub fn new(number: i32) -> Option<Self> {
        u32::try_from(number).ok().map(Self)
    }

    /// The number of the identifier. Real-time safe.
    pub fn number(self) -> i32 {
        self.0 as i32
    }
}

/// A note as the manager passes it to a voice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Note {
    /// MIDI channel, 0–15.
    pub(crate) channel: u8,
    /// MIDI key, 0–127.
    pub(crate) key: u8,
    /// Pitch of the key in the tuning.
    pub(crate) pitch: Pitch,
    /// Offset from that pitch in semitones.
    pub(crate) detune: f32,
    /// 0–1.
    pub(crate) velocity: f32,
    /// Whether the soft pedal was down.
    pub(crate) soft: bool,
    /// Brightness of the channel, −0.5 to 0.5.
    pub(crate) brightness: f32,
    /// The identifier that the host gave the note, if any.
    pub(crate) id: Option<NoteId>,
    /// Number of the note among those of its synth.
    pub(crate) serial: u64,
    /// Number of the sound among those that its synth has played.
    pub(crate) patch: u32,
    /// Number of the body among those of its synth. Notes with different bodies never share a voice.
    pub(crate) body: u32,
    /// Choke group, 0 for none.
    pub(crate) choke: u8,
    /// The output beside the main one that it goes to where there are several; 0 for the main one.
    pub(crate) output: u8,
    /// Amplitude ratio of the pad.
    pub(crate) gain: f32,
    /// Pan of the pad, −1 (left) to 1 (right).
    pub(crate) pan: f32,
    /// Whether another key was down when the note began.
    pub(crate) is_legato: bool,
    /// The glide that the channel's portamento gives it, in place of the patch's.
    pub(crate) glide: Option<NoteGlide>,
    /// The hit of another body, if the note is one ([`EventKind::Strike`](super::EventKind::Strike)).
    pub(crate) contact: Option<Contact>,
}

impl Note {
    /// Placeholder where there is no note yet.
    pub(super) const NONE: Self = Self {
        channel: 0,
        key: 0,
        pitch: Pitch::Semitones(0.0),
        detune: 0.0,
        velocity: 0.0,
        soft: false,
        brightness: 0.0,
        id: None,
        serial: 0,
        patch: 0,
        body: 0,
        choke: 0,
        output: 0,
        gain: 1.0,
        pan: 0.0,
        is_legato: false,
        glide: None,
        contact: None,
    };
}

/// What is left to tell of a note that has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EndedNote {
    /// MIDI channel, 0–15.
    pub channel: u8,
    /// MIDI key, 0–127.
    pub key: u8,
    /// The identifier that the host gave the note, if any.
    pub id: Option<NoteId>,
    /// Number of the note among those of its synth.
    pub serial: u64,
}

/// Selects notes of a synth: those that match every field that is not none. A synth ignores the event's own channel; an
/// ensemble uses it to choose the synth, as for every event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Notes {
    /// The host's identifier. A note without one matches any.
    pub id: Option<NoteId>,
    /// MIDI channel, 0–15.
    pub channel: Option<u8>,
    /// MIDI key, 0–127.
    pub key: Option<u8>,
}

impl Notes {
    /// All notes of a key on a channel.
    pub fn on(channel: u8, key: u8) -> Self {
        Self { id: None, channel: Some(channel), key: Some(key) }
    }

    /// Whether a note is one of these. Real-time safe.
    pub(super) fn include(&self, note: &Note) -> bool {
        self.id.is_none_or(|id| note.id.is_none_or(|own| own == id))
            && self.channel.is_none_or(|channel| note.channel == nearest_channel(channel))
            && self.key.is_none_or(|key| note.key == nearest_key(key))
    }
}

/// Clamps a MIDI channel to 0–15.
pub(crate) fn nearest_channel(channel: u8) -> u8 {
    channel.min(15)
}

/// Clamps a MIDI key to 0–127.
pub(crate) fn nearest_key(key: u8) -> u8 {
    key.min(127)
}
