//! Note on: choke groups, strikes on keys that sound already, new notes, and voice stealing.

use super::VoiceManager;
use super::footprint::Footprint;
use super::slot::Slot;
use super::voice::Voice;
use crate::engine::note::Note;
use crate::params::PlayMode;

impl<V: Voice> VoiceManager<V> {
    /// The voices and cells that a note would take from the pool. None if it takes over the voices of another note.
    pub(crate) fn need(&self, context: &V::Context, note: &Note) -> Footprint {
        let taken_over = match self.mode {
            PlayMode::Poly => self.slot_to_restrike(note).is_some(),
            PlayMode::Mono | PlayMode::Legato => self.slot_to_take_over(note).is_some(),
        };
        if taken_over { Footprint::NONE } else { V::footprint(context) }
    }

    /// Plays a note. Returns false if another key has priority in a monophonic mode: the note then waits until its key has
    /// priority.
    pub(crate) fn note_on(&mut self, context: &V::Context, note: Note) -> bool {
        let is_poly = self.mode == PlayMode::Poly;
        if !is_poly && !self.takes_priority(note) {
            return false;
        }
        for slot in self.slots.sounding() {
            // A note whose voices this one takes over is not choked.
            let is_taken_over = slot.note.body == note.body && (!is_poly || slot.is_on(note.channel, note.key));
            if note.choke != 0 && slot.note.choke == note.choke && !is_taken_over {
                slot.fade();
            }
        }
        if is_poly {
            self.note_on_poly(context, note);
        } else {
            self.note_on_mono(context, note);
        }
        self.peak = self.peak.max(self.slots.count_sounding());
        true
    }

    fn note_on_poly(&mut self, context: &V::Context, note: Note) {
        if let Some(index) = self.slot_to_restrike(&note) {
            let before = self.slots.in_use_mut()[index].restrike(context, note);
            self.retire(before);
        } else {
            while self.slots.count_sounding() >= self.polyphony {
                self.steal(&note);
            }
            self.start(context, note);
        }
    }

    /// The slot that a polyphonic note strikes again: its note has the same key, channel and body.
    fn slot_to_restrike(&self, note: &Note) -> Option<usize> {
        let same = |slot: &Slot<V>| slot.is_on(note.channel, note.key) && slot.note.body == note.body;
        self.slots.in_use().iter().position(same)
    }

    /// Fades one note: preferably one on the same key, else the quietest; if several are equal, the oldest.
    fn steal(&mut self, note: &Note) {
        let rank = |slot: &Slot<V>| (!slot.is_on(note.channel, note.key), slot.energy(), slot.note.serial);
        let victim = self.slots.sounding().min_by(|a, b| {
            let (a, b) = (rank(a), rank(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2))
        });
        if let Some(slot) = victim {
            slot.fade();
        }
    }

    /// Starts a note in a free slot. If no slot is free, since many notes were stolen within a few milliseconds, the
    /// quietest fading note is cut off.
    pub(super) fn start(&mut self, context: &V::Context, note: Note) {
        let index = self.slots.first_free().or_else(|| {
            let (index, _) = self.slots.quietest(Slot::is_fading)?;
            self.free(index);
            Some(index)
        });
        // The pool's owner has made room before, so `start` succeeds. If it does not, the note ends at once.
        if !index.is_some_and(|index| self.slots.start(index, context, note)) {
            self.retire(note);
        }
    }
}
