//! A note as voices get it, and how events say which notes they mean.

use crate::sound::tuning::Pitch;

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
    /// The host's identifier, or −1.
    pub id: i32,
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
        id: -1,
        serial: 0,
        patch: 0,
        body: 0,
        choke: 0,
        gain: 1.0,
        pan: 0.0,
    };
}

/// Which notes of a synth an event is for: those that agree in all that is given. The event's own channel plays no
/// part in a synth; in an ensemble it chooses the synth, as it does for every event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Notes {
    /// The host's identifier; a note that was given none agrees with any.
    pub id: Option<i32>,
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
        self.id.is_none_or(|id| note.id == id || note.id == -1)
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
