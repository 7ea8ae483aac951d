//! The slots of a voice manager, and the pool that their voices come from.
//!
//! Only slots in use are searched: searching all 128 voices took 345 ns per tick for a single mass, now it takes 52
//! (measured once).

use super::footprint::Footprint;
use super::pool::VoicePool;
use super::slot::Slot;
use super::voice::Voice;
use crate::engine::note::Note;

/// Maximum number of notes that sound at once.
pub const MAX_VOICES: usize = 64;

/// Slots for stolen notes while they fade out: enough if all notes are stolen at once.
const FADING_NOTES: usize = MAX_VOICES;

/// All slots of a voice manager. Real-time safe once made.
pub(super) struct Slots<V: Voice> {
    slots: Vec<Slot<V>>,
    /// All slots from this index on are free.
    used: usize,
    pool: VoicePool<V>,
}

impl<V: Voice> Slots<V> {
    /// Free slots, which take their voices from this pool. Allocates.
    pub(super) fn new(pool: VoicePool<V>) -> Self {
        let slots = std::iter::repeat_with(Slot::new).take(MAX_VOICES + FADING_NOTES).collect();
        Self { slots, used: 0, pool }
    }

    /// Frees all slots.
    pub(super) fn reset(&mut self) {
        self.slots[..self.used].iter_mut().for_each(|slot| slot.free(&mut self.pool));
        self.used = 0;
    }

    /// The voices and cells that no note uses.
    pub(super) fn pool(&mut self) -> &mut VoicePool<V> {
        &mut self.pool
    }

    /// The slots up to the last that is not free.
    pub(super) fn in_use(&self) -> &[Slot<V>] {
        &self.slots[..self.used]
    }

    /// As [`Slots::in_use`], mutable.
    pub(super) fn in_use_mut(&mut self) -> &mut [Slot<V>] {
        &mut self.slots[..self.used]
    }

    /// The slots in use whose notes sound and do not fade out.
    pub(super) fn sounding(&mut self) -> impl Iterator<Item = &mut Slot<V>> {
        self.in_use_mut().iter_mut().filter(|slot| slot.is_sounding())
    }

    /// The slots in use whose present or last note is on a channel.
    pub(super) fn on_channel(&mut self, channel: u8) -> impl Iterator<Item = &mut Slot<V>> {
        self.in_use_mut().iter_mut().filter(move |slot| slot.note.channel == channel)
    }

    /// Number of notes that sound and do not fade out.
    pub(super) fn count_sounding(&self) -> usize {
        self.in_use().iter().filter(|slot| slot.is_sounding()).count()
    }

    /// The first free slot.
    pub(super) fn first_free(&self) -> Option<usize> {
        self.slots.iter().position(Slot::is_free)
    }

    /// Starts a note in a free slot. Returns whether the pool had enough voices and cells for it.
    pub(super) fn start(&mut self, index: usize, context: &V::Context, note: Note) -> bool {
        let is_started = self.slots[index].start(&mut self.pool, V::footprint(context), context, note);
        if is_started {
            self.used = self.used.max(index + 1);
        }
        is_started
    }

    /// Silences a note at once and gives its voices back. Returns the note.
    pub(super) fn free(&mut self, index: usize) -> Note {
        let slot = &mut self.slots[index];
        slot.free(&mut self.pool);
        slot.note
    }

    /// Moves `used` back behind the last slot that is not free.
    pub(super) fn shrink(&mut self) {
        while self.used > 0 && self.slots[self.used - 1].is_free() {
            self.used -= 1;
        }
    }

    /// The slot and the energy of the quietest note among those that `includes` selects; if several are equal, the
    /// oldest.
    pub(super) fn quietest(&self, includes: impl Fn(&Slot<V>) -> bool) -> Option<(usize, f64)> {
        let chosen = self.in_use().iter().enumerate().filter(|(_, slot)| includes(slot));
        let ranked = chosen.map(|(index, slot)| (index, slot.energy(), slot.note.serial));
        let least = ranked.min_by(|a, b| a.1.total_cmp(&b.1).then(a.2.cmp(&b.2)));
        least.map(|(index, energy, _)| (index, energy))
    }

    /// The voices and cells that the notes selected by `includes` use.
    pub(super) fn footprint(&self, includes: impl Fn(&Slot<V>) -> bool) -> Footprint {
        let chosen = self.in_use().iter().filter(|slot| includes(slot));
        chosen.map(Slot::footprint).fold(Footprint::NONE, |sum, one| sum + one)
    }
}
