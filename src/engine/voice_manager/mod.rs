//! Voice allocation: polyphony, stealing, re-striking, pedals, choke groups, and finished notes. Knows no DSP.

mod footprint;
mod held_keys;
mod mono;
mod note_off;
mod note_on;
mod pedals;
mod pool;
mod room;
mod slot;
mod slots;
mod voice;

use super::note::Note;
pub use crate::params::{PlayMode, Priority};
pub use footprint::Footprint;
use held_keys::HeldKeys;
use pedals::Pedals;
pub use pool::VoicePool;
pub use room::{has_room, make_room};
pub use slot::MAX_UNISON;
use slot::Slot;
pub use slots::MAX_VOICES;
use slots::Slots;
pub use voice::{Unison, Voice};

/// Ended notes that are kept until somebody asks.
pub const MAX_ENDED: usize = 1024;

/// Gives notes voices from a pool. Real-time safe after [`VoiceManager::new`].
pub struct VoiceManager<V: Voice> {
    slots: Slots<V>,
    pedals: Pedals,
    polyphony: usize,
    mode: PlayMode,
    priority: Priority,
    /// The patch of the context: see [`Note::patch`].
    patch: u32,
    /// The keys that are down in a monophonic mode.
    held: HeldKeys,
    /// Notes that have ended: no voice plays them, and no held key will bring them back.
    ended: Vec<Note>,
    peak: usize,
}

impl<V: Voice> VoiceManager<V> {
    /// A manager of the voices of a pool. Allocates.
    pub fn new(pool: VoicePool<V>) -> Self {
        Self {
            slots: Slots::new(pool),
            pedals: Pedals::UP,
            polyphony: MAX_VOICES,
            mode: PlayMode::Poly,
            priority: Priority::Last,
            patch: 0,
            held: HeldKeys::NONE,
            ended: Vec::with_capacity(MAX_ENDED),
            peak: 0,
        }
    }

    /// Stops everything at once, pedals included.
    pub fn reset(&mut self) {
        self.slots.reset();
        self.pedals = Pedals::UP;
        self.held = HeldKeys::NONE;
        self.ended.clear();
        self.peak = 0;
    }

    /// Sets how many notes sound at once (1 to [`MAX_VOICES`]) and how they share voices, from the next note on, and
    /// which patch the context has.
    pub fn configure(&mut self, polyphony: usize, mode: PlayMode, priority: Priority, patch: u32) {
        self.priority = priority;
        self.patch = patch;
        self.polyphony = polyphony.clamp(1, MAX_VOICES);
        if mode != self.mode {
            self.forget(|_| true);
        }
        self.mode = mode;
    }

    /// The notes that have ended since [`VoiceManager::clear_ended`], in that order: each note once, the first
    /// [`MAX_ENDED`] of them.
    pub fn ended(&self) -> &[Note] {
        &self.ended
    }

    /// Forgets the notes that have ended.
    pub fn clear_ended(&mut self) {
        self.ended.clear();
    }

    /// Takes a note that gets no voice: it ends as it begins.
    pub fn turn_away(&mut self, note: Note) {
        self.retire(note);
    }

    /// The voices that are not free, in their fixed order, and the note that each plays.
    pub fn active(&mut self) -> impl Iterator<Item = (&Note, &mut V)> {
        self.slots.in_use_mut().iter_mut().flat_map(|slot| {
            let (note, voices) = slot.voices_mut();
            voices.map(move |voice| (note, voice))
        })
    }

    /// The voices that are not free, to look at.
    pub fn sounding_voices(&self) -> impl Iterator<Item = &V> {
        self.slots.in_use().iter().flat_map(Slot::voices)
    }

    /// The voices and cells that no note has.
    pub fn pool(&mut self) -> &mut VoicePool<V> {
        self.slots.pool()
    }

    /// Whether every voice is free.
    pub fn is_silent(&self) -> bool {
        self.slots.in_use().is_empty()
    }

    /// Most notes that have sounded at once, fading ones not counted.
    pub fn peak(&self) -> usize {
        self.peak
    }

    /// Whether any key is down.
    pub fn has_key_down(&self) -> bool {
        !self.held.as_slice().is_empty() || self.slots.in_use().iter().any(|slot| slot.key_down)
    }

    /// Sets the brightness that held keys of a channel have when the voice returns to them.
    pub fn brighten(&mut self, channel: u8, brightness: f32) {
        let held = self.held.as_mut_slice().iter_mut().filter(|held| held.channel == channel);
        held.for_each(|held| held.brightness = brightness);
    }

    /// Frees the voices of notes that are over.
    pub fn free_finished(&mut self) {
        for index in 0..self.slots.in_use().len() {
            let slot = &self.slots.in_use()[index];
            if !slot.is_free() && slot.is_over() {
                self.free(index);
            }
        }
        self.slots.shrink();
    }

    /// Silences a note at once.
    fn cut_off(&mut self, index: usize) {
        self.free(index);
        self.slots.shrink();
    }

    fn free(&mut self, index: usize) {
        let note = self.slots.free(index);
        self.retire(note);
    }

    /// A voice or a held key has let go of a note: it has ended, unless another voice or key still has it.
    fn retire(&mut self, note: Note) {
        let has_note = |slot: &Slot<V>| !slot.is_free() && slot.note.serial == note.serial;
        let is_held = self.held.as_slice().iter().any(|held| held.serial == note.serial);
        if !is_held && !self.slots.in_use().iter().any(has_note) && self.ended.len() < MAX_ENDED {
            self.ended.push(note);
        }
    }

    /// Stops waiting for the keys of the notes that `which` chooses.
    fn forget(&mut self, which: impl Fn(&Note) -> bool) {
        while let Some(note) = self.held.take(&which) {
            self.retire(note);
        }
    }
}

#[cfg(test)]
mod tests;
