//! The keys that are down in a monophonic mode, for the voice to return to.

use crate::engine::note::Note;
use crate::params::Priority;

impl Priority {
    /// Whether a note is played rather than an earlier one.
    pub(super) fn prefers(self, note: &Note, earlier: &Note) -> bool {
        match self {
            Self::Last => true,
            Self::Low => note.key <= earlier.key,
            Self::High => note.key >= earlier.key,
        }
    }
}

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

    /// The key that sounds.
    pub(super) fn first(&self, priority: Priority) -> Option<Note> {
        self.as_slice().iter().copied().reduce(|best, note| if priority.prefers(&note, &best) { note } else { best })
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
