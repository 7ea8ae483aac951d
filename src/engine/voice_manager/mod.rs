//! Voice allocation, without DSP: polyphony, stealing, re-striking, pedals, choke groups, and finished notes.

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

use super::note::{EndedNote, Note, Notes};
pub(crate) use crate::params::{PlayMode, Priority};
pub(crate) use footprint::Footprint;
use held_keys::HeldKeys;
use pedals::Pedals;
pub(crate) use pool::VoicePool;
pub(crate) use room::{has_room, make_room};
pub(crate) use slot::MAX_UNISON;
pub(crate) use slot::Slot;
pub use slots::MAX_VOICES;
use slots::Slots;
pub(crate) use voice::{Unison, Voice};

/// Maximum number of ended notes that are kept until the host has collected them.
pub(crate) const MAX_ENDED: usize = 1024;

/// Gives notes voices from a pool. Real-time safe after [`VoiceManager::new`].
pub(crate) struct VoiceManager<V: Voice> {
    slots: Slots<V>,
    pedals: Pedals,
    polyphony: usize,
    mode: PlayMode,
    priority: Priority,
    /// The patch that the context has now: see [`Note::patch`].
    patch: u32,
    /// The keys that are down in a monophonic mode.
    held: HeldKeys,
    /// Ended notes: no voice plays them, and no held key will start them again. Kept until [`VoiceManager::clear_ended`].
    ended: Vec<EndedNote>,
    peak: usize,
}

impl<V: Voice> VoiceManager<V> {
    /// A manager that takes its voices from a pool. Allocates.
    pub(crate) fn new(pool: VoicePool<V>) -> Self {
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

    /// Stops all notes at once and lifts all pedals.
    pub(crate) fn reset(&mut self) {
        self.slots.reset();
        self.pedals = Pedals::UP;
        self.held = HeldKeys::NONE;
        self.ended.clear();
        self.peak = 0;
    }

    /// Sets the maximum number of notes at once (1 to [`MAX_VOICES`]), the mode and the key priority, from the next
    /// note on, and the number of the context's patch.
    pub(crate) fn configure(&mut self, polyphony: usize, mode: PlayMode, priority: Priority, patch: u32) {
        self.priority = priority;
        self.patch = patch;
        self.polyphony = polyphony.clamp(1, MAX_VOICES);
        if mode != self.mode {
            self.forget(|_| true);
        }
        self.mode = mode;
    }

    /// The notes that have ended since the last [`VoiceManager::clear_ended`], in order of their ends. Each note
    /// appears once. Notes beyond the first [`MAX_ENDED`] are lost.
    pub(crate) fn ended(&self) -> &[EndedNote] {
        &self.ended
    }

    /// Forgets the notes that have ended.
    pub(crate) fn clear_ended(&mut self) {
        self.ended.clear();
    }

    /// Reports a note as ended that gets no voice.
    pub(crate) fn turn_away(&mut self, note: Note) {
        self.retire(note);
    }

    /// The voices that play or fade, in an order that is always the same, each with its note.
    pub(crate) fn active(&mut self) -> impl Iterator<Item = (&Note, &mut V)> {
        self.slots.in_use_mut().iter_mut().flat_map(Slot::voices_mut)
    }

    /// The notes that play or fade, each with its place, in the order of [`VoiceManager::active`].
    pub(crate) fn notes_mut(&mut self) -> impl Iterator<Item = (usize, &mut Slot<V>)> {
        self.slots.in_use_mut().iter_mut().enumerate().filter(|(_, slot)| !slot.is_free())
    }

    /// How many notes play or fade.
    pub(crate) fn count_notes(&self) -> usize {
        self.slots.in_use().iter().filter(|slot| !slot.is_free()).count()
    }

    /// The voices of a key's notes on a channel that sound and do not fade out, each with its note.
    pub(crate) fn sounding_on(&mut self, channel: u8, key: u8) -> impl Iterator<Item = (&Note, &mut V)> {
        let notes = Notes::on(channel, key);
        self.slots.in_use_mut().iter_mut().filter(move |slot| slot.is_one_of(&notes)).flat_map(Slot::voices_mut)
    }

    /// The voices that play or fade, with their notes, read-only.
    pub(crate) fn sounding_voices(&self) -> impl Iterator<Item = (&Note, &V)> {
        self.slots.in_use().iter().flat_map(|slot| slot.voices().map(|voice| (&slot.note, voice)))
    }

    /// The voices and cells that no note uses.
    pub(crate) fn pool(&mut self) -> &mut VoicePool<V> {
        self.slots.pool()
    }

    /// Whether no voice plays or fades.
    pub(crate) fn is_silent(&self) -> bool {
        self.slots.in_use().is_empty()
    }

    /// The largest number of notes that have sounded at once. Fading notes do not count.
    pub(crate) fn peak(&self) -> usize {
        self.peak
    }

    /// Whether any key is down.
    pub(crate) fn has_key_down(&self) -> bool {
        !self.held.as_slice().is_empty() || self.slots.in_use().iter().any(|slot| slot.key_down)
    }

    /// Sets the brightness of a channel's held keys, for when the voice returns to them.
    pub(crate) fn brighten(&mut self, channel: u8, brightness: f32) {
        let held = self.held.as_mut_slice().iter_mut().filter(|held| held.channel == channel);
        held.for_each(|held| held.brightness = brightness);
    }

    /// Frees the voices of notes that are over.
    pub(crate) fn free_finished(&mut self) {
        for index in 0..self.slots.in_use().len() {
            let slot = &self.slots.in_use()[index];
            if !slot.is_free() && slot.is_over() {
                self.free(index);
            }
        }
        self.slots.shrink();
    }

    /// Frees the voices of notes that are over, by their places.
    pub(crate) fn end(&mut self, places: impl Iterator<Item = usize>) {
        places.for_each(|place| self.free(place));
        self.slots.shrink();
    }

    /// Silences a note at once, without a fade.
    fn cut_off(&mut self, index: usize) {
        self.end(std::iter::once(index));
    }

    fn free(&mut self, index: usize) {
        let note = self.slots.free(index);
        self.retire(note);
    }

    /// Handles a note that a slot or a held key no longer has. It has ended, unless another slot or held key still has it.
    fn retire(&mut self, note: Note) {
        let has_note = |slot: &Slot<V>| !slot.is_free() && slot.note.serial == note.serial;
        let is_held = self.held.as_slice().iter().any(|held| held.serial == note.serial);
        if !is_held && !self.slots.in_use().iter().any(has_note) && self.ended.len() < MAX_ENDED {
            let Note { channel, key, id, serial, .. } = note;
            self.ended.push(EndedNote { channel, key, id, serial });
        }
    }

    /// Removes the held keys that `which` selects. Their notes end unless they sound.
    fn forget(&mut self, which: impl Fn(&Note) -> bool) {
        while let Some(note) = self.held.take(&which) {
            self.retire(note);
        }
    }
}

#[cfg(test)]
mod tests;
