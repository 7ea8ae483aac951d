//! How pitch and decay follow the key.

use crate::engine::note::Note;
use crate::params::Param;
use crate::units::{frequency_from_key, ratio_from_semitones};

/// The key that tracking turns about.
const MIDDLE_C: f64 = 60.0;

/// What a patch says of it. A voice keeps it for as long as it sounds, since the instrument may have another patch by
/// the time that a held key takes the voice back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KeyTracking {
    /// Semitones per semitone of the tuned key.
    pitch: f64,
    /// Octaves of T60 per octave of pitch.
    decay: f64,
    /// Frequency of A4 in Hz.
    a4_hz: f64,
    /// Time to slide from the note before.
    pub(super) glide_seconds: f64,
}

impl KeyTracking {
    /// Every key has its own pitch, at 440 Hz, and one decay.
    pub(super) const NONE: Self = Self { pitch: 1.0, decay: 0.0, a4_hz: 440.0, glide_seconds: 0.0 };

    /// That of a patch with these values.
    pub(crate) fn new(value: impl Fn(Param) -> f64) -> Self {
        Self {
            pitch: value(Param::KeyTrack) * 0.01,
            decay: value(Param::DecayKey) * 0.01,
            a4_hz: value(Param::Tuning),
            glide_seconds: value(Param::Glide),
        }
    }

    /// The pitch of a note in semitones on the MIDI scale.
    pub(crate) fn pitch(&self, note: &Note) -> f64 {
        MIDDLE_C + (note.pitch.semitones(self.a4_hz) + f64::from(note.detune) - MIDDLE_C) * self.pitch
    }

    /// What a pitch in semitones multiplies T60s by.
    pub(super) fn decay_scale(&self, pitch: f64) -> f64 {
        ratio_from_semitones(self.decay * (MIDDLE_C - pitch))
    }

    /// Frequency in Hz of a pitch in semitones.
    pub(super) fn frequency(&self, pitch: f64) -> f64 {
        frequency_from_key(pitch, self.a4_hz)
    }
}
