//! How the pitch of a note depends on its key.

use crate::dsp::pitch::Glide;
use crate::engine::note::Note;
use crate::params::{Choice, GlideBy, GlideWhen, Param};
use libm::fabs;

/// The key whose pitch does not depend on the amount of tracking.
const MIDDLE_C: f64 = 60.0;

/// The key tracking and glide of a patch. A voice keeps them as long as it sounds, since the instrument may have
/// another patch by the time that the voice returns to a held key.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KeyTracking {
    /// Semitones per semitone of the tuned key.
    amount: f64,
    /// Frequency of A4 in Hz.
    pub(super) a4_hz: f64,
    /// Glide time in seconds: for the whole glide, or for each octave of it.
    glide_seconds: f64,
    glide_by: GlideBy,
    glide_when: GlideWhen,
}

impl KeyTracking {
    /// Full tracking, A4 at 440 Hz, no glide.
    pub(super) const FULL: Self =
        Self { amount: 1.0, a4_hz: 440.0, glide_seconds: 0.0, glide_by: GlideBy::Time, glide_when: GlideWhen::Always };

    /// The key tracking of a patch with these values.
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

    /// The glide of a note from a pitch in semitones on the MIDI scale to its own. `is_legato` says that another key is down.
    pub(super) fn glide(&self, from: f64, note: &Note, is_legato: bool) -> Glide {
        let to = self.pitch(note);
        let from = note.glide.and_then(|glide| glide.from).unwrap_or(from) - to;
        if let Some(pace) = note.glide.and_then(|glide| glide.pace) {
            return Glide::new(from, 0.0, pace * fabs(from));
        }
        let octaves = if self.glide_by == GlideBy::Rate { fabs(from) / 12.0 } else { 1.0 };
        let slides = is_legato || note.glide.is_some() || self.glide_when == GlideWhen::Always;
        Glide::new(from, 0.0, if slides { self.glide_seconds * octaves } else { 0.0 })
    }
}
