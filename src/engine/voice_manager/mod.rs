//! Who plays what: polyphony, stealing, re-striking, pedals, choke groups, and which notes have ended. Knows no DSP.

mod held_keys;

use super::note::{Note, Notes};
pub use crate::params::PlayMode;
use held_keys::HeldKeys;

/// Something that sounds one note at a time. All methods are called on the audio thread.
pub trait Voice {
    /// What a voice needs to know of the instrument when a note starts.
    type Context;
    /// Starts a note from rest.
    fn start(&mut self, context: &Self::Context, note: &Note);
    /// Strikes the sounding voice again, perhaps at another pitch.
    fn restrike(&mut self, context: &Self::Context, note: &Note);
    /// Moves the sounding voice to another pitch without striking it. There is no context where the instrument has
    /// another patch than the voice was started with: then the voice goes by what it knows.
    fn retune(&mut self, context: Option<&Self::Context>, note: &Note);
    /// Lets go of the note, with a release velocity 0–1.
    fn release(&mut self, velocity: f32);
    /// Silences the voice within a few milliseconds, without a click.
    fn fade(&mut self);
    /// How loud the voice is, in any unit that orders voices.
    fn energy(&self) -> f64;
    /// Whether the voice will be silent until it is struck again.
    fn is_over(&self) -> bool;
}

/// Most notes that sound at once.
pub const MAX_VOICES: usize = 64;

/// Voices beyond those, for stolen notes to fade out in: enough for all of them to be stolen at once.
const FADING_VOICES: usize = MAX_VOICES;

/// Ended notes that are kept until somebody asks.
pub const MAX_ENDED: usize = 1024;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Free,
    /// The key is down, or a pedal holds the note.
    Held,
    Released,
    Fading,
}

struct Slot<V> {
    voice: V,
    note: Note,
    state: State,
    key_down: bool,
    sostenuto: bool,
}

impl<V> Slot<V> {
    fn is_sounding(&self) -> bool {
        matches!(self.state, State::Held | State::Released)
    }

    fn is_on(&self, channel: u8, key: u8) -> bool {
        self.is_one_of(&Notes::on(channel, key))
    }

    fn is_one_of(&self, notes: &Notes) -> bool {
        self.is_sounding() && notes.include(&self.note)
    }
}

/// Deals notes to a fixed set of voices. Real-time safe after [`VoiceManager::new`].
pub struct VoiceManager<V> {
    slots: Vec<Slot<V>>,
    /// Slots from here on are free. Voices are large: looking at all of them costs more than a short one sounds.
    used: usize,
    sustain: [bool; 16],
    sostenuto: [bool; 16],
    polyphony: usize,
    mode: PlayMode,
    /// The patch of the context: see [`Note::patch`].
    patch: u32,
    held: HeldKeys,
    /// Notes that have ended: their voices are silent or another's, and no key of theirs is waited for.
    ended: Vec<Note>,
    peak: usize,
}

impl<V: Voice> VoiceManager<V> {
    /// A manager of voices made by `voice`. Allocates.
    pub fn new(mut voice: impl FnMut() -> V) -> Self {
        let slot = || Slot { voice: voice(), note: Note::NONE, state: State::Free, key_down: false, sostenuto: false };
        Self {
            slots: std::iter::repeat_with(slot).take(MAX_VOICES + FADING_VOICES).collect(),
            used: 0,
            sustain: [false; 16],
            sostenuto: [false; 16],
            polyphony: MAX_VOICES,
            mode: PlayMode::Poly,
            patch: 0,
            held: HeldKeys::NONE,
            ended: Vec::with_capacity(MAX_ENDED),
            peak: 0,
        }
    }

    /// Stops everything at once, pedals included.
    pub fn reset(&mut self) {
        self.slots.iter_mut().for_each(|slot| slot.state = State::Free);
        self.used = 0;
        self.sustain = [false; 16];
        self.sostenuto = [false; 16];
        self.held = HeldKeys::NONE;
        self.ended.clear();
        self.peak = 0;
    }

    /// Sets how many notes sound at once (1 to [`MAX_VOICES`]) and how they share voices, from the next note on, and
    /// which patch the context has.
    pub fn configure(&mut self, polyphony: usize, mode: PlayMode, patch: u32) {
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
        let sounds = |slot: &Slot<V>| slot.state != State::Free && slot.note.serial == note.serial;
        let is_held = self.held.as_slice().iter().any(|held| held.serial == note.serial);
        if !is_held && !self.slots[..self.used].iter().any(sounds) && self.ended.len() < MAX_ENDED {
            self.ended.push(note);
        }
    }

    /// The voices that are not free, in their fixed order.
    pub fn active(&mut self) -> impl Iterator<Item = (&Note, &mut V)> {
        let used = self.slots[..self.used].iter_mut();
        used.filter(|slot| slot.state != State::Free).map(|slot| (&slot.note, &mut slot.voice))
    }

    /// The voices that are not free, to look at.
    pub fn sounding_voices(&self) -> impl Iterator<Item = &V> {
        self.slots[..self.used].iter().filter(|slot| slot.state != State::Free).map(|slot| &slot.voice)
    }

    /// Whether every voice is free.
    pub fn is_silent(&self) -> bool {
        self.used == 0
    }

    /// Most notes that have sounded at once, fading ones not counted.
    pub fn peak(&self) -> usize {
        self.peak
    }

    /// Frees the voices that are over.
    pub fn free_finished(&mut self) {
        for index in 0..self.used {
            let slot = &mut self.slots[index];
            if slot.state != State::Free && slot.voice.is_over() {
                slot.state = State::Free;
                let note = slot.note;
                self.retire(note);
            }
        }
        while self.used > 0 && self.slots[self.used - 1].state == State::Free {
            self.used -= 1;
        }
    }

    /// A key goes down.
    pub fn note_on(&mut self, context: &V::Context, note: Note) {
        for slot in self.slots[..self.used].iter_mut().filter(|slot| slot.is_sounding()) {
            // What the note is about to strike again or to retune is not choked.
            let reused =
                slot.note.body == note.body && (self.mode != PlayMode::Poly || slot.is_on(note.channel, note.key));
            if note.choke != 0 && slot.note.choke == note.choke && !reused {
                fade(slot);
            }
        }
        match self.mode {
            PlayMode::Poly => self.note_on_poly(context, note),
            PlayMode::Mono | PlayMode::Legato => self.note_on_mono(context, note),
        }
        self.peak = self.peak.max(self.sounding());
    }

    fn note_on_poly(&mut self, context: &V::Context, note: Note) {
        let same = |slot: &&mut Slot<V>| slot.is_on(note.channel, note.key) && slot.note.body == note.body;
        if let Some(slot) = self.slots[..self.used].iter_mut().find(same) {
            slot.voice.restrike(context, &note);
            let before = hold(slot, note);
            self.retire(before);
        } else {
            while self.sounding() >= self.polyphony {
                self.steal(&note);
            }
            self.start(context, note);
        }
    }

    fn note_on_mono(&mut self, context: &V::Context, note: Note) {
        self.forget(|held| (held.channel, held.key) == (note.channel, note.key));
        if let Some(surplus) = self.held.surplus() {
            self.forget(|held| held.serial == surplus.serial);
        }
        self.held.push(note);

        let mut playing = None;
        for (index, slot) in self.slots[..self.used].iter_mut().enumerate().filter(|(_, slot)| slot.is_sounding()) {
            // Left over from another patch or from polyphony: make room.
            if playing.is_some() || slot.note.body != note.body {
                fade(slot);
            } else {
                playing = Some(index);
            }
        }
        let Some(index) = playing else { return self.start(context, note) };
        let slot = &mut self.slots[index];
        if self.mode == PlayMode::Legato && slot.state == State::Held {
            slot.voice.retune(Some(context), &note);
        } else {
            slot.voice.restrike(context, &note);
        }
        let before = hold(slot, note);
        self.retire(before);
    }

    /// The keys of these notes come up.
    pub fn note_off(&mut self, context: &V::Context, notes: Notes, velocity: f32) {
        if self.mode != PlayMode::Poly {
            self.forget(|held| notes.include(held));
            // The key before is still down: a release never strikes, it returns.
            if let Some(note) = self.held.as_slice().last().copied()
                && let Some(slot) =
                    self.slots[..self.used].iter_mut().find(|slot| slot.key_down && slot.is_one_of(&notes))
            {
                slot.voice.retune((slot.note.patch == self.patch).then_some(context), &note);
                // The voice keeps the sound that it has.
                let Note { patch, body, choke, .. } = slot.note;
                let note = Note { patch, body, choke, ..note };
                let before = std::mem::replace(&mut slot.note, note);
                return self.retire(before);
            }
        }
        for slot in self.slots[..self.used].iter_mut().filter(|slot| slot.is_one_of(&notes)) {
            slot.key_down = false;
            release_unless_held(slot, &self.sustain, velocity);
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
        self.slots[..self.used].iter_mut().filter(|slot| slot.is_one_of(&notes)).for_each(fade);
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
            .for_each(fade);
    }

    /// Silences the notes of a choke group (0 is none).
    pub fn choke(&mut self, group: u8) {
        self.slots[..self.used]
            .iter_mut()
            .filter(|slot| group != 0 && slot.is_sounding() && slot.note.choke == group)
            .for_each(fade);
    }

    /// Notes whose keys are up and that no pedal holds any more are released.
    fn release_let_go(&mut self, channel: u8) {
        for slot in self.slots[..self.used].iter_mut().filter(|slot| slot.note.channel == channel && !slot.key_down) {
            release_unless_held(slot, &self.sustain, MIDDLE_VELOCITY);
        }
    }

    fn sounding(&self) -> usize {
        self.slots[..self.used].iter().filter(|slot| slot.is_sounding()).count()
    }

    /// Fades the note that will be missed least: one on the same key, else the quietest, of equals the oldest.
    fn steal(&mut self, note: &Note) {
        let rank = |slot: &Slot<V>| (!slot.is_on(note.channel, note.key), slot.voice.energy(), slot.note.serial);
        let victim = self.slots[..self.used].iter_mut().filter(|slot| slot.is_sounding()).min_by(|a, b| {
            let (a, b) = (rank(a), rank(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2))
        });
        if let Some(slot) = victim {
            fade(slot);
        }
    }

    /// Starts a note in a free voice. If so many notes were stolen within a few milliseconds that all the spare ones
    /// still fade, the one that is nearly silent is cut off.
    fn start(&mut self, context: &V::Context, note: Note) {
        let slot = match self.slots.iter().position(|slot| slot.state == State::Free) {
            Some(free) => {
                self.used = self.used.max(free + 1);
                Some(&mut self.slots[free])
            }
            None => {
                let fading = self.slots.iter_mut().filter(|slot| slot.state == State::Fading);
                fading.min_by(|a, b| a.voice.energy().total_cmp(&b.voice.energy()))
            }
        };
        if let Some(slot) = slot {
            slot.voice.start(context, &note);
            slot.sostenuto = false;
            let before = (slot.state != State::Free).then_some(slot.note);
            hold(slot, note);
            before.into_iter().for_each(|before| self.retire(before));
        }
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

/// Gives the slot a note whose key is down; returns the one that it had.
fn hold<V>(slot: &mut Slot<V>, note: Note) -> Note {
    slot.state = State::Held;
    slot.key_down = true;
    std::mem::replace(&mut slot.note, note)
}

fn fade<V: Voice>(slot: &mut Slot<V>) {
    slot.voice.fade();
    slot.state = State::Fading;
    slot.key_down = false;
}

fn release_unless_held<V: Voice>(slot: &mut Slot<V>, sustain: &[bool; 16], velocity: f32) {
    if slot.state == State::Held && !slot.key_down && !slot.sostenuto && !sustain[usize::from(slot.note.channel)] {
        slot.voice.release(velocity);
        slot.state = State::Released;
    }
}

#[cfg(test)]
mod tests;
