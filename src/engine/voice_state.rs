//! The current state of a sounding voice and of its modes, from which exact labels are made.

use super::note::Note;
use super::voice::SynthVoice;
pub(crate) use super::voice::mode_state::{ModeState, StrikeState};

/// The state of a sounding voice between two blocks. A display needs a [`Snapshot`](super::Snapshot).
pub(crate) struct VoiceState<'a> {
    note: &'a Note,
    voice: &'a SynthVoice,
}

impl<'a> VoiceState<'a> {
    pub(super) fn new(note: &'a Note, voice: &'a SynthVoice) -> Self {
        Self { note, voice }
    }

    /// Its note. The notes of one part have different serial numbers. Real-time safe.
    pub(crate) fn note(&self) -> &Note {
        self.note
    }

    /// Which of the note's unison voices it is, from 0. Real-time safe.
    pub(crate) fn unison(&self) -> usize {
        self.voice.unison_index()
    }

    /// Whether mallet, pluck or noise still act. Real-time safe.
    pub(crate) fn is_being_struck(&self) -> bool {
        self.voice.is_being_struck()
    }

    /// The strikes on it that overlap with others or were made while it rang, each with what it alone has given the modes. They are
    /// here until they no longer act, and once more. Empty unless `Ensemble::separate_strikes` was called. Real-time safe.
    pub(crate) fn strikes(&self) -> impl Iterator<Item = StrikeState<'_>> {
        self.voice.strikes()
    }

    /// Its modes, in the order of the sound's table. Real-time safe.
    pub(crate) fn modes(&self) -> impl Iterator<Item = ModeState> {
        self.voice.mode_states()
    }
}
