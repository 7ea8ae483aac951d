//! How pitch follows the key.

use crate::dsp::pitch::Glide;
use crate::engine::note::Note;
use crate::params::{Choice, GlideBy, GlideWhen, Param};
use libm::fabs;

/// The key that tracking turns about.
pub(super) const MIDDLE_C: f64 = 60.0;

/// How a patch says that pitch follows the key. A voice keeps it for as long as it sounds, since the instrument may have
/// another patch by the time that a held key takes the voice back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KeyTracking {
    /// Semitones per semitone of the tuned key.
    amount: f64,
    /// Frequency of A4 in Hz.
    pub(super) a4_hz: f64,
    /// Time to slide from the note before, or that for each octave.
    glide_seconds: f64,
    glide_by: GlideBy,
    glide_when: GlideWhen,
}

impl KeyTracking {
    /// Every key has its own pitch, at 440 Hz.
    pub(super) const FULL: Self =
        Self { amount: 1.0, a4_hz: 440.0, glide_seconds: 0.0, glide_by: GlideBy::Time, glide_when: GlideWhen::Always };

    /// That of a patch with these values.
    pub(crate) fn new(value: impl Fn(Param) -> f64) -> Self {
        Self {
            amount: value(Param::KeyTrack) * 0.01,
            a4_hz: value(Param::Tuning),
            glide_seconds: value(Param::Glide),
            glide_by: GlideBy::from_value(value(Param::GlideBy) as f32),
            glide_when: GlideWhen::from_value(value(Param::GlideWhen) as f32),
        }
    }

    /// The pitch of a note in semitones on the MIDI scale.
    pub(crate) fn pitch(&self, note: &Note) -> f64 {
        MIDDLE_C + (note.pitch.semitones(self.a4_hz) + f64::from(note.detune) - MIDDLE_C) * self.amount
    }

    /// The slide of a note from some semitones away; `is_legato` if another key is down.
    pub(super) fn glide(&self, from: f64, is_legato: bool) -> Glide {
        let octaves = if self.glide_by == GlideBy::Rate { fabs(from) / 12.0 } else { 1.0 };
        let slides = is_legato || self.glide_when == GlideWhen::Always;
        Glide::new(from, 0.0, if slides { self.glide_seconds * octaves } else { 0.0 })
    }
}
