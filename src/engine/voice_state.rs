//! The current state of a sounding voice and of its modes, from which exact labels are made.

use super::note::Note;
use super::voice::SynthVoice;
pub use super::voice::mode_state::ModeState;

/// The state of a sounding voice between two blocks. A display needs a [`Snapshot`](super::Snapshot).
pub struct VoiceState<'a> {
    note: &'a Note,
    voice: &'a SynthVoice,
}

impl<'a> VoiceState<'a> {
    pub(super) fn new(note: &'a Note, voice: &'a SynthVoice) -> Self {
        Self { note, voice }
    }

    /// Its note. The notes of one part have different serial numbers. Real-time safe.
    pub fn note(&self) -> &Note {
        self.note
    }

    /// Which of the note's unison voices it is, from 0. Real-time safe.
    pub fn unison(&self) -> usize {
        self.voice.unison_index()
    }

    /// Whether mallet, pluck or noise still act. Real-time safe.
    pub fn is_being_struck(&self) -> bool {
        self.voice.is_being_struck()
    }

    /// Its modes, in the order of the sound's table. Real-time safe.
    pub fn modes(&self) -> impl Iterator<Item = ModeState> {
        self.voice.mode_states()
    }
}
