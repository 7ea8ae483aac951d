//! A note as voices get it, and how events say which notes they mean.

use crate::sound::tuning::Pitch;

/// The identifier that a host gives a note, to tell it from others on its key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NoteId(u32);

impl NoteId {
    /// That of a number as plugin hosts count them; none for a negative one, which stands for any note. Real-time safe.
    pub fn new(number: i32) -> Option<Self> {
        u32::try_from(number).ok().map(Self)
    }

    /// The number that it was made from. Real-time safe.
    pub fn number(self) -> i32 {
        self.0 as i32
    }
}

/// A note as the manager hands it to a voice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Note {
    /// MIDI channel, 0–15.
    pub channel: u8,
    /// MIDI key, 0–127.
    pub key: u8,
    /// Pitch that the tuning gives the key.
    pub pitch: Pitch,
    /// Offset from that pitch in semitones.
    pub detune: f32,
    /// 0–1.
    pub velocity: f32,
    /// Whether the soft pedal was down.
    pub soft: bool,
    /// Brightness of the channel, −0.5 to 0.5.
    pub brightness: f32,
    /// The identifier that the host has given it.
    pub id: Option<NoteId>,
    /// Counts the notes of a synth.
    pub serial: u64,
    /// Counts the sounds that a synth has been given.
    pub patch: u32,
    /// Counts the bodies of a synth; notes of different bodies never share a voice.
    pub body: u32,
    /// Choke group, 0 for none.
    pub choke: u8,
    /// Amplitude ratio of its pad.
    pub gain: f32,
    /// Position of its pad, −1 to 1.
    pub pan: f32,
    /// Whether another key was down when it began.
    pub is_legato: bool,
}

impl Note {
    /// What stands where there is no note yet.
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
        gain: 1.0,
        pan: 0.0,
        is_legato: false,
    };
}

/// Which notes of a synth an event is for: those that agree in all that is given. The event's own channel plays no
/// part in a synth; in an ensemble it chooses the synth, as it does for every event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Notes {
    /// The host's identifier; a note that was given none agrees with any.
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

/// A MIDI channel, 0–15.
pub(crate) fn nearest_channel(channel: u8) -> u8 {
    channel.min(15)
}

/// A MIDI key, 0–127.
pub(crate) fn nearest_key(key: u8) -> u8 {
    key.min(127)
}
