//! Monophonic modes: one voice moves from key to key, and returns to keys that are still down.

use super::VoiceManager;
use super::slot::State;
use super::voice::Voice;
use crate::engine::note::{Note, Notes};
use crate::engine::portamento::NoteGlide;
use crate::params::PlayMode;

impl<V: Voice> VoiceManager<V> {
    /// The slot whose voices a monophonic note takes over.
    pub(super) fn slot_to_take_over(&self, note: &Note) -> Option<usize> {
        // There is at most one such slot, except after a change from polyphonic mode: then the first is taken. A note
        // of another body cannot be taken over.
        self.slots.in_use().iter().position(|slot| slot.is_sounding() && slot.note.body == note.body)
    }

    /// Remembers a key that is now down. Returns whether it has priority over the key that sounds.
    pub(super) fn takes_priority(&mut self, note: Note) -> bool {
        self.forget(|held| (held.channel, held.key) == (note.channel, note.key));
        if let Some(surplus) = self.held.surplus() {
            self.forget(|held| held.serial == surplus.serial);
        }
        self.held.push(Note { glide: note.glide.map(NoteGlide::back), ..note });
        let playing = self.slot_to_take_over(&note).map(|index| &self.slots.in_use()[index]);
        playing.is_none_or(|slot| !slot.key_down || self.priority.prefers(&note, &slot.note))
    }

    /// Plays a note with the voices of the note before, if they sound; other sounding notes fade.
    pub(super) fn note_on_mono(&mut self, context: &V::Context, note: Note) {
        let playing = self.slot_to_take_over(&note);
        for (index, slot) in self.slots.in_use_mut().iter_mut().enumerate() {
            if slot.is_sounding() && Some(index) != playing {
                slot.fade();
            }
        }
        let Some(index) = playing else { return self.start(context, note) };
        let slot = &mut self.slots.in_use_mut()[index];
        let before = if self.mode == PlayMode::Legato && slot.state == State::Held {
            slot.retune(Some(context), &note);
            slot.hold(note)
        } else {
            slot.restrike(context, note)
        };
        self.retire(before);
    }

    /// Moves the voice of one of these notes, whose keys were just released, to a key that is still down, without a
    /// strike. Returns false if there is no such key or no such voice.
    pub(super) fn return_to_held(&mut self, context: &V::Context, notes: &Notes) -> bool {
        self.forget(|held| notes.include(held));
        let Some(note) = self.held.first(self.priority) else { return false };
        let mut slots = self.slots.in_use_mut().iter_mut();
        let Some(slot) = slots.find(|slot| slot.key_down && slot.is_one_of(notes)) else { return false };
        slot.retune((slot.note.patch == self.patch).then_some(context), &note);
        // The voice keeps its sound: the patch, body and choke group that it was started with.
        let Note { patch, body, choke, .. } = slot.note;
        let before = slot.set_note(Note { patch, body, choke, ..note });
        self.retire(before);
        true
    }
}
