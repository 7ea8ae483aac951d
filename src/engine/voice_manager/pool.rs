//! Voices and cells that no note uses: notes take them when they start and give them back when they are over.
//!
//! A voice plays a body in cells of 64 modes, one to eight of them ([`crate::dsp::cells`]). Both are reset in place
//! when a note starts, so nothing that they played before affects the new note, and it makes no difference which ones a
//! note gets. A `Synth` has its own pool (256 voices, 256 cells); the parts of an `Ensemble` share one (512 and 512).
//! Three quarters of a pool are for sounding notes, the rest for notes that fade out: 384 notes of 64 modes, or 48 of
//! 512, in an ensemble. An ensemble takes less than 16 MB. Tests: `dsp::cells::tests`, `tests/engine/pool.rs`,
//! `tests/memory.rs`.

use super::footprint::Footprint;
use super::voice::Voice;

/// Free voices and cells. They are all alike, so any of them gives a note the same sound. Real-time safe once made.
pub(crate) struct VoicePool<V: Voice> {
    voices: Vec<Box<V>>,
    cells: Vec<Box<V::Cell>>,
}

impl<V: Voice> VoicePool<V> {
    /// An empty pool with room for `capacity`. Allocates.
    pub(crate) fn empty(capacity: Footprint) -> Self {
        Self { voices: Vec::with_capacity(capacity.voices), cells: Vec::with_capacity(capacity.cells) }
    }

    /// A pool with `capacity` voices and cells, made by `voice` and `cell`. Allocates.
    pub(crate) fn full(capacity: Footprint, voice: impl Fn() -> V, cell: impl Fn() -> V::Cell) -> Self {
        let mut pool = Self::empty(capacity);
        pool.voices.extend((0..capacity.voices).map(|_| Box::new(voice())));
        pool.cells.extend((0..capacity.cells).map(|_| Box::new(cell())));
        pool
    }

    /// The number of free voices and cells.
    pub(crate) fn free(&self) -> Footprint {
        Footprint { voices: self.voices.len(), cells: self.cells.len() }
    }

    /// The free voices.
    pub(in crate::engine) fn voices_mut(&mut self) -> impl Iterator<Item = &mut V> {
        self.voices.iter_mut().map(|voice| &mut **voice)
    }

    /// Moves up to `some` voices and cells to another pool, which must have room for them.
    pub(crate) fn lend(&mut self, other: &mut Self, some: Footprint) {
        move_last(&mut self.voices, &mut other.voices, some.voices);
        move_last(&mut self.cells, &mut other.cells, some.cells);
    }

    /// Takes a voice with this many cells out of the pool, if there are enough.
    pub(super) fn take(&mut self, cells: usize) -> Option<Box<V>> {
        if self.cells.len() < cells {
            return None;
        }
        let mut voice = self.voices.pop()?;
        self.cells.drain(self.cells.len() - cells..).for_each(|cell| voice.add_cell(cell));
        Some(voice)
    }

    /// Puts a silent voice and its cells back.
    pub(super) fn give_back(&mut self, mut voice: Box<V>) {
        while let Some(cell) = voice.take_cell() {
            self.cells.push(cell);
        }
        self.voices.push(voice);
    }
}

fn move_last<T>(from: &mut Vec<T>, to: &mut Vec<T>, count: usize) {
    let kept = from.len().saturating_sub(count);
    to.extend(from.drain(kept..));
}
