//! The keys that are down in a monophonic mode, for the voice to return to.

use crate::engine::note::Note;

/// Most keys that are remembered.
const MAX_HELD_KEYS: usize = 32;

/// Notes whose keys are down, oldest first. Real-time safe.
pub(super) struct HeldKeys {
    notes: [Note; MAX_HELD_KEYS],
    len: usize,
}

impl HeldKeys {
    pub(super) const NONE: Self = Self { notes: [Note::NONE; MAX_HELD_KEYS], len: 0 };

    pub(super) fn as_slice(&self) -> &[Note] {
        &self.notes[..self.len]
    }

    pub(super) fn as_mut_slice(&mut self) -> &mut [Note] {
        &mut self.notes[..self.len]
    }

    /// The note that has to be taken out before another can be added.
    pub(super) fn surplus(&self) -> Option<Note> {
        (self.len == MAX_HELD_KEYS).then(|| self.notes[0])
    }

    /// Adds the newest, if there is room.
    pub(super) fn push(&mut self, note: Note) {
        if let Some(free) = self.notes.get_mut(self.len) {
            *free = note;
            self.len += 1;
        }
    }

    /// Takes out the oldest note that is meant.
    pub(super) fn take(&mut self, is_meant: impl Fn(&Note) -> bool) -> Option<Note> {
        let index = self.as_slice().iter().position(is_meant)?;
        let note = self.notes[index];
        self.notes[index..self.len].rotate_left(1);
        self.len -= 1;
        Some(note)
    }
}
