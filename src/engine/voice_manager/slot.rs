//! A slot: place for one note and its voices. It is free, or its note is held, released or fading out.

use super::footprint::Footprint;
use super::pool::VoicePool;
use super::voice::{Unison, Voice};
use crate::engine::note::{Note, Notes};

/// The sustain pedal holds notes from this position on.
const HELD_FROM: f32 = 0.5;

/// Most voices that play one note.
pub(crate) const MAX_UNISON: usize = 8;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    Free,
    /// The key is down, or a pedal holds the note.
    Held,
    Released,
    Fading,
}

pub(crate) struct Slot<V> {
    voices: Vec<Box<V>>,
    /// Number of cells of all its voices together.
    cells: usize,
    pub(super) note: Note,
    pub(super) state: State,
    pub(super) key_down: bool,
    pub(super) sostenuto: bool,
}

impl<V: Voice> Slot<V> {
    /// A place for a note. Allocates.
    pub(super) fn new() -> Self {
        let (voices, note, state) = (Vec::with_capacity(MAX_UNISON), Note::NONE, State::Free);
        Self { voices, cells: 0, note, state, key_down: false, sostenuto: false }
    }

    pub(super) fn is_free(&self) -> bool {
        self.state == State::Free
    }

    pub(super) fn is_sounding(&self) -> bool {
        matches!(self.state, State::Held | State::Released)
    }

    pub(super) fn is_fading(&self) -> bool {
        self.state == State::Fading
    }

    pub(super) fn is_on(&self, channel: u8, key: u8) -> bool {
        self.is_one_of(&Notes::on(channel, key))
    }

    pub(super) fn is_one_of(&self, notes: &Notes) -> bool {
        self.is_sounding() && notes.include(&self.note)
    }

    /// The voices and cells that the note uses; none if the slot is free.
    pub(super) fn footprint(&self) -> Footprint {
        Footprint { voices: self.voices.len(), cells: self.cells }
    }

    pub(crate) fn voices(&self) -> impl Iterator<Item = &V> {
        self.voices.iter().map(|voice| &**voice)
    }

    /// The present note, or, of a free slot, the last.
    pub(crate) fn note(&self) -> &Note {
        &self.note
    }

    /// The voices, each with the note.
    pub(crate) fn voices_mut(&mut self) -> impl Iterator<Item = (&Note, &mut V)> {
        let Self { note, voices, .. } = self;
        voices.iter_mut().map(|voice| (&*note, &mut **voice))
    }

    /// Starts a note in a free slot with voices from the pool. Returns false, and changes nothing, if the pool has too
    /// few.
    pub(super) fn start(
        &mut self,
        pool: &mut VoicePool<V>,
        footprint: Footprint,
        context: &V::Context,
        note: Note,
    ) -> bool {
        let count = footprint.voices.clamp(1, MAX_UNISON);
        if !footprint.fits(pool.free()) {
            return false;
        }
        for index in 0..count {
            let Some(mut voice) = pool.take(footprint.cells / count) else { break };
            voice.start(context, &note, Unison { index, count });
            self.voices.push(voice);
        }
        (self.cells, self.sostenuto) = (footprint.cells, false);
        self.hold(note);
        true
    }

    /// Strikes the slot's voices again for another note. Returns the note before.
    pub(super) fn restrike(&mut self, context: &V::Context, note: Note) -> Note {
        self.voices.iter_mut().for_each(|voice| voice.restrike(context, &note));
        self.hold(note)
    }

    /// Moves the slot's voices to the pitch of another note, without a strike.
    pub(super) fn retune(&mut self, context: Option<&V::Context>, note: &Note) {
        self.voices.iter_mut().for_each(|voice| voice.retune(context, note));
    }

    /// Gives the slot a note whose key is down. Returns the note before.
    pub(super) fn hold(&mut self, note: Note) -> Note {
        self.state = State::Held;
        self.key_down = true;
        self.set_note(note)
    }

    /// Gives the slot another note. Returns the note before. A sostenuto pedal holds notes of its own channel only.
    pub(super) fn set_note(&mut self, note: Note) -> Note {
        self.sostenuto &= note.channel == self.note.channel;
        std::mem::replace(&mut self.note, note)
    }

    pub(super) fn fade(&mut self) {
        self.voices.iter_mut().for_each(|voice| voice.fade());
        self.state = State::Fading;
        self.key_down = false;
    }

    /// Releases the note unless its key is down or a pedal holds it. `sustain` is the position of the sustain pedal, 0–1.
    pub(super) fn release_unless_held(&mut self, sustain: f32, velocity: f32) {
        if self.key_down || self.sostenuto {
            return;
        }
        if self.state == State::Held && sustain < HELD_FROM {
            self.voices.iter_mut().for_each(|voice| voice.release(velocity));
            self.state = State::Released;
        }
        self.voices.iter_mut().for_each(|voice| voice.damp(dampers_at(sustain)));
    }

    /// How loud the note is: the sum over its voices, in the unit of [`Voice::energy`].
    pub(super) fn energy(&self) -> f64 {
        self.voices().map(V::energy).sum()
    }

    /// Whether all voices are silent.
    pub(crate) fn is_over(&self) -> bool {
        self.voices().all(V::is_over)
    }

    /// Silences the note at once, and gives its voices back.
    pub(super) fn free(&mut self, pool: &mut VoicePool<V>) {
        self.voices.drain(..).for_each(|voice| pool.give_back(voice));
        (self.cells, self.state, self.key_down) = (0, State::Free, false);
    }
}

/// How far dampers lie on at a position of the sustain pedal, 0–1. Over the middle half of its way it lets them down by degrees; a
/// switch does so at once.
fn dampers_at(sustain: f32) -> f32 {
    (1.5 - 2.0 * sustain).clamp(0.0, 1.0)
}
