//! The trait that connects the voice manager to its voices.

use super::footprint::Footprint;
use crate::engine::note::Note;

/// Something that sounds one note at a time. All methods are called on the audio thread.
pub(crate) trait Voice {
    /// The state of the instrument that a voice reads when a note starts.
    type Context;
    /// A block of modes. A voice takes as many cells as its note needs, and gives them back.
    type Cell;
    /// The number of voices and cells that a note needs if it starts now.
    fn footprint(context: &Self::Context) -> Footprint;
    /// Gives the voice a cell, before the note starts.
    fn add_cell(&mut self, cell: Box<Self::Cell>);
    /// Takes a cell from the voice, after it has become silent.
    fn take_cell(&mut self) -> Option<Box<Self::Cell>>;
    /// Starts a note from rest. Earlier notes of the voice and its cells must not affect it.
    fn start(&mut self, context: &Self::Context, note: &Note, unison: Unison);
    /// Strikes the sounding voice again, perhaps at another pitch.
    fn restrike(&mut self, context: &Self::Context, note: &Note);
    /// Moves the sounding voice to another pitch without striking it. `context` is none if the instrument now has
    /// another patch than the one that the voice was started with: the voice then uses its stored values of its own
    /// patch.
    fn retune(&mut self, context: Option<&Self::Context>, note: &Note);
    /// Lets dampers down by a share 0–1, while no key holds the note. Once it is released, they do not rise again.
    fn damp(&mut self, share: f32);
    /// Releases the note, with a release velocity 0–1.
    fn release(&mut self, velocity: f32);
    /// Silences the voice within a few milliseconds, without a click.
    fn fade(&mut self);
    /// How loud the voice is, in any unit: it is only compared with other voices.
    fn energy(&self) -> f64;
    /// Whether the voice will be silent until it is struck again.
    fn is_over(&self) -> bool;
}

/// The position of a voice among the unison voices of one note.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Unison {
    /// Index, from 0.
    pub index: usize,
    /// Number of voices, at least 1.
    pub count: usize,
}

impl Unison {
    /// The only voice of its note.
    pub(crate) const ONE: Self = Self { index: 0, count: 1 };

    /// Position of the voice among the others, evenly spaced from −1 to 1; 0 if it is the only one.
    pub(crate) fn position(self) -> f64 {
        if self.count < 2 { 0.0 } else { 2.0 * self.index as f64 / (self.count - 1) as f64 - 1.0 }
    }
}
