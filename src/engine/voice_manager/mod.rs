//! Who plays what: polyphony, stealing, re-striking, pedals, choke groups, and which notes have ended. Knows no DSP.

mod footprint;
mod held_keys;
mod pool;
mod room;
mod slot;
mod voice;

use super::note::{Note, Notes};
pub use crate::params::{PlayMode, Priority};
pub use footprint::Footprint;
use held_keys::HeldKeys;
pub use pool::VoicePool;
pub use room::{has_room, make_room};
pub use slot::MAX_UNISON;
use slot::{Slot, State};
pub use voice::{Unison, Voice};

/// Most notes that sound at once.
pub const MAX_VOICES: usize = 64;

/// Notes beyond those that are stolen and still fade: enough for all of them to be stolen at once.
const FADING_NOTES: usize = MAX_VOICES;

/// Ended notes that are kept until somebody asks.
pub const MAX_ENDED: usize = 1024;

/// Deals notes to voices from a pool. Real-time safe after [`VoiceManager::new`].
pub struct VoiceManager<V: Voice> {
    slots: Vec<Slot<V>>,
    /// Slots from here on are free.
    used: usize,
    pool: VoicePool<V>,
    sustain: [bool; 16],
    sostenuto: [bool; 16],
    polyphony: usize,
    mode: PlayMode,
    priority: Priority,
    /// The patch of the context: see [`Note::patch`].
    patch: u32,
    held: HeldKeys,
    /// Notes that have ended: their voices are silent or another's, and no key of theirs is waited for.
    ended: Vec<Note>,
    peak: usize,
}

impl<V: Voice> VoiceManager<V> {
    /// A manager of the voices of a pool. Allocates.
    pub fn new(pool: VoicePool<V>) -> Self {
        Self {
            slots: std::iter::repeat_with(Slot::new).take(MAX_VOICES + FADING_NOTES).collect(),
            used: 0,
            pool,
            sustain: [false; 16],
            sostenuto: [false; 16],
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
        self.slots[..self.used].iter_mut().for_each(|slot| slot.free(&mut self.pool));
        self.used = 0;
        self.sustain = [false; 16];
        self.sostenuto = [false; 16];
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

    /// Takes a note that has no voice: it has ended as it began.
    pub fn turn_away(&mut self, note: Note) {
        self.retire(note);
    }

    /// A voice or a held key has let go of a note: it has ended, unless another has it still.
    fn retire(&mut self, note: Note) {
        let sounds = |slot: &Slot<V>| !slot.is_free() && slot.note.serial == note.serial;
        let is_held = self.held.as_slice().iter().any(|held| held.serial == note.serial);
        if !is_held && !self.slots[..self.used].iter().any(sounds) && self.ended.len() < MAX_ENDED {
            self.ended.push(note);
        }
    }

    /// The voices that are not free, in their fixed order, and the note that each plays.
    pub fn active(&mut self) -> impl Iterator<Item = (&Note, &mut V)> {
        self.slots[..self.used].iter_mut().flat_map(|slot| {
            let (note, voices) = slot.voices_mut();
            voices.map(move |voice| (note, voice))
        })
    }

    /// The voices that are not free, to look at.
    pub fn sounding_voices(&self) -> impl Iterator<Item = &V> {
        self.slots[..self.used].iter().flat_map(Slot::voices)
    }

    /// The voices and cells that no note has.
    pub fn pool(&mut self) -> &mut VoicePool<V> {
        &mut self.pool
    }

    /// Whether every voice is free.
    pub fn is_silent(&self) -> bool {
        self.used == 0
    }

    /// Most notes that have sounded at once, fading ones not counted.
    pub fn peak(&self) -> usize {
        self.peak
    }

    /// Frees the voices of notes that are over.
    pub fn free_finished(&mut self) {
        for index in 0..self.used {
            let slot = &self.slots[index];
            if !slot.is_free() && slot.is_over() {
                self.free(index);
            }
        }
        self.shrink();
    }

    fn free(&mut self, index: usize) {
        let slot = &mut self.slots[index];
        slot.free(&mut self.pool);
        let note = slot.note;
        self.retire(note);
    }

    fn shrink(&mut self) {
        while self.used > 0 && self.slots[self.used - 1].is_free() {
            self.used -= 1;
        }
    }

    /// What a note would take from the pool: nothing if it takes over the voices of another.
    pub fn need(&self, context: &V::Context, note: &Note) -> Footprint {
        let taken_over = match self.mode {
            PlayMode::Poly => self.same(note).is_some(),
            PlayMode::Mono | PlayMode::Legato => self.playing(note).is_some(),
        };
        if taken_over { Footprint::NONE } else { V::footprint(context) }
    }

    /// The slot of the note that a polyphonic one strikes again.
    fn same(&self, note: &Note) -> Option<usize> {
        let same = |slot: &Slot<V>| slot.is_on(note.channel, note.key) && slot.note.body == note.body;
        self.slots[..self.used].iter().position(same)
    }

    /// The slot of the note whose voices a monophonic one takes over.
    fn playing(&self, note: &Note) -> Option<usize> {
        let slots = &self.slots[..self.used];
        // Others than the first are left over from polyphony, and those of another body from another patch.
        slots.iter().position(|slot| slot.is_sounding() && slot.note.body == note.body)
    }

    /// Whether any key is down.
    pub fn has_key_down(&self) -> bool {
        !self.held.as_slice().is_empty() || self.slots[..self.used].iter().any(|slot| slot.key_down)
    }

    /// A key goes down. Returns whether its note sounds: if not, another key has priority, and this one waits.
    pub fn note_on(&mut self, context: &V::Context, note: Note) -> bool {
        if self.mode != PlayMode::Poly {
            self.remember(note);
            let playing = self.playing(&note).map(|index| &self.slots[index]);
            if playing.is_some_and(|slot| slot.key_down && !self.priority.prefers(&note, &slot.note)) {
                return false;
            }
        }
        for slot in self.slots[..self.used].iter_mut().filter(|slot| slot.is_sounding()) {
            // What the note is about to strike again or to retune is not choked.
            let reused =
                slot.note.body == note.body && (self.mode != PlayMode::Poly || slot.is_on(note.channel, note.key));
            if note.choke != 0 && slot.note.choke == note.choke && !reused {
                slot.fade();
            }
        }
        match self.mode {
            PlayMode::Poly => self.note_on_poly(context, note),
            PlayMode::Mono | PlayMode::Legato => self.note_on_mono(context, note),
        }
        self.peak = self.peak.max(self.sounding());
        true
    }

    /// Keeps a key that is down for a monophonic voice to return to.
    fn remember(&mut self, note: Note) {
        self.forget(|held| (held.channel, held.key) == (note.channel, note.key));
        if let Some(surplus) = self.held.surplus() {
            self.forget(|held| held.serial == surplus.serial);
        }
        self.held.push(note);
    }

    fn note_on_poly(&mut self, context: &V::Context, note: Note) {
        if let Some(index) = self.same(&note) {
            let before = self.slots[index].restrike(context, note);
            self.retire(before);
        } else {
            while self.sounding() >= self.polyphony {
                self.steal(&note);
            }
            self.start(context, note);
        }
    }

    fn note_on_mono(&mut self, context: &V::Context, note: Note) {
        let playing = self.playing(&note);
        for (index, slot) in self.slots[..self.used].iter_mut().enumerate() {
            if slot.is_sounding() && Some(index) != playing {
                slot.fade();
            }
        }
        let Some(index) = playing else { return self.start(context, note) };
        let slot = &mut self.slots[index];
        let before = if self.mode == PlayMode::Legato && slot.state == State::Held {
            slot.retune(Some(context), &note);
            slot.hold(note)
        } else {
            slot.restrike(context, note)
        };
        self.retire(before);
    }

    /// The keys of these notes come up.
    pub fn note_off(&mut self, context: &V::Context, notes: Notes, velocity: f32) {
        if self.mode != PlayMode::Poly {
            self.forget(|held| notes.include(held));
            // The key before is still down: a release never strikes, it returns.
            if let Some(note) = self.held.first(self.priority)
                && let Some(slot) =
                    self.slots[..self.used].iter_mut().find(|slot| slot.key_down && slot.is_one_of(&notes))
            {
                slot.retune((slot.note.patch == self.patch).then_some(context), &note);
                // The voice keeps the sound that it has.
                let Note { patch, body, choke, .. } = slot.note;
                let note = Note { patch, body, choke, ..note };
                let before = std::mem::replace(&mut slot.note, note);
                return self.retire(before);
            }
        }
        for slot in self.slots[..self.used].iter_mut().filter(|slot| slot.is_one_of(&notes)) {
            slot.key_down = false;
            slot.release_unless_held(&self.sustain, velocity);
        }
    }

    /// Tells keys that are waited for of their channel's brightness.
    pub fn brighten(&mut self, channel: u8, brightness: f32) {
        let held = self.held.as_mut_slice().iter_mut().filter(|held| held.channel == channel);
        held.for_each(|held| held.brightness = brightness);
    }

    /// Silences these notes.
    pub fn silence(&mut self, notes: Notes) {
        self.forget(|held| notes.include(held));
        self.slots[..self.used].iter_mut().filter(|slot| slot.is_one_of(&notes)).for_each(Slot::fade);
    }

    /// The sustain pedal (controller 64).
    pub fn sustain(&mut self, channel: u8, down: bool) {
        self.sustain[usize::from(channel)] = down;
        self.release_let_go(channel);
    }

    /// The sostenuto pedal (controller 66): holds the notes whose keys are down when it goes down.
    pub fn sostenuto(&mut self, channel: u8, down: bool) {
        // Pedals that send positions repeat themselves; only going down catches notes.
        if std::mem::replace(&mut self.sostenuto[usize::from(channel)], down) == down {
            return;
        }
        for slot in self.slots[..self.used].iter_mut().filter(|slot| slot.note.channel == channel) {
            slot.sostenuto = down && slot.state == State::Held && slot.key_down;
        }
        self.release_let_go(channel);
    }

    /// Controller 123: every key of the channel comes up.
    pub fn all_notes_off(&mut self, channel: u8) {
        self.forget(|held| held.channel == channel);
        self.slots[..self.used]
            .iter_mut()
            .filter(|slot| slot.note.channel == channel)
            .for_each(|slot| slot.key_down = false);
        self.release_let_go(channel);
    }

    /// Controller 120: the channel is silenced.
    pub fn all_sound_off(&mut self, channel: u8) {
        self.forget(|held| held.channel == channel);
        self.slots[..self.used]
            .iter_mut()
            .filter(|slot| slot.is_sounding() && slot.note.channel == channel)
            .for_each(Slot::fade);
    }

    /// Silences the notes of a choke group (0 is none).
    pub fn choke(&mut self, group: u8) {
        self.slots[..self.used]
            .iter_mut()
            .filter(|slot| group != 0 && slot.is_sounding() && slot.note.choke == group)
            .for_each(Slot::fade);
    }

    /// Notes whose keys are up and that no pedal holds any more are released.
    fn release_let_go(&mut self, channel: u8) {
        for slot in self.slots[..self.used].iter_mut().filter(|slot| slot.note.channel == channel && !slot.key_down) {
            slot.release_unless_held(&self.sustain, MIDDLE_VELOCITY);
        }
    }

    fn sounding(&self) -> usize {
        self.slots[..self.used].iter().filter(|slot| slot.is_sounding()).count()
    }

    /// Fades the note that will be missed least: one on the same key, else the quietest, of equals the oldest.
    fn steal(&mut self, note: &Note) {
        let rank = |slot: &Slot<V>| (!slot.is_on(note.channel, note.key), slot.energy(), slot.note.serial);
        let victim = self.slots[..self.used].iter_mut().filter(|slot| slot.is_sounding()).min_by(|a, b| {
            let (a, b) = (rank(a), rank(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2))
        });
        if let Some(slot) = victim {
            slot.fade();
        }
    }

    /// Starts a note in a free slot. If so many notes were stolen within a few milliseconds that all the spare ones
    /// still fade, the one that is nearly silent is cut off.
    fn start(&mut self, context: &V::Context, note: Note) {
        let index = self.slots.iter().position(Slot::is_free).or_else(|| {
            let (index, _) = self.quietest(false)?;
            self.free(index);
            Some(index)
        });
        let need = V::footprint(context);
        match index {
            Some(index) if self.slots[index].start(&mut self.pool, need, context, note) => {
                self.used = self.used.max(index + 1);
            }
            // Whoever owns the pool has made room before: never.
            _ => self.retire(note),
        }
    }

    /// The quietest note of those that sound or of those that fade, and how loud it is; of equals the oldest.
    fn quietest(&self, sounding: bool) -> Option<(usize, f64)> {
        let slots = self.slots[..self.used].iter().enumerate();
        let meant = slots.filter(|(_, slot)| !slot.is_free() && slot.is_sounding() == sounding);
        let ranked = meant.map(|(index, slot)| (index, slot.energy(), slot.note.serial));
        let least = ranked.min_by(|a, b| a.1.total_cmp(&b.1).then(a.2.cmp(&b.2)));
        least.map(|(index, energy, _)| (index, energy))
    }

    /// What the notes take that sound, or those that fade.
    fn footprint(&self, sounding: bool) -> Footprint {
        let slots = self.slots[..self.used].iter().filter(|slot| slot.is_sounding() == sounding);
        slots.map(Slot::footprint).fold(Footprint::NONE, |sum, one| sum + one)
    }

    fn slot_footprint(&self, index: usize) -> Footprint {
        self.slots[index].footprint()
    }

    fn fade_slot(&mut self, index: usize) {
        self.slots[index].fade();
    }

    fn cut_slot(&mut self, index: usize) {
        self.free(index);
        self.shrink();
    }

    /// Stops waiting for keys.
    fn forget(&mut self, which: impl Fn(&Note) -> bool) {
        while let Some(note) = self.held.take(&which) {
            self.retire(note);
        }
    }
}

/// Release velocity where nobody gave one.
const MIDDLE_VELOCITY: f32 = 0.5;

#[cfg(test)]
mod tests;
