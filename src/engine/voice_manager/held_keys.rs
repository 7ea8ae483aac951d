//! The keys that are down in a monophonic mode, so that the voice can return to them.

use crate::engine::note::Note;
use crate::params::Priority;

impl Priority {
    /// Whether `note` has priority over `earlier`.
    pub(super) fn prefers(self, note: &Note, earlier: &Note) -> bool {
        match self {
            Self::Last => true,
            Self::Low => note.key <= earlier.key,
            Self::High => note.key >= earlier.key,
        }
    }
}

/// Maximum number of keys that are remembered.
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

    /// The oldest note, if it must be removed before another can be added.
    pub(super) fn surplus(&self) -> Option<Note> {
        (self.len == MAX_HELD_KEYS).then(|| self.notes[0])
    }

    /// Adds the newest note. Does nothing if there is no room.
    pub(super) fn push(&mut self, note: Note) {
        if let Some(free) = self.notes.get_mut(self.len) {
            *free = note;
            self.len += 1;
        }
    }

    /// The note that has priority over the others.
    pub(super) fn first(&self, priority: Priority) -> Option<Note> {
        self.as_slice().iter().copied().reduce(|best, note| if priority.prefers(&note, &best) { note } else { best })
    }

    /// Removes and returns the oldest note for which `is_meant` is true.
    pub(super) fn take(&mut self, is_meant: impl Fn(&Note) -> bool) -> Option<Note> {
        let index = self.as_slice().iter().position(is_meant)?;
        let note = self.notes[index];
        self.notes[index..self.len].rotate_left(1);
        self.len -= 1;
        Some(note)
    }
}
