//! What the voice manager asks of a voice.

use super::footprint::Footprint;
use crate::engine::note::Note;

/// Something that sounds one note at a time. All methods are called on the audio thread.
pub trait Voice {
    /// What a voice needs to know of the instrument when a note starts.
    type Context;
    /// A part of a body that voices take as many of as their note needs, and give back.
    type Cell;
    /// What a note takes that starts now.
    fn footprint(context: &Self::Context) -> Footprint;
    /// Hands the voice a cell, before it starts.
    fn add_cell(&mut self, cell: Box<Self::Cell>);
    /// Takes a cell away, once the voice is silent.
    fn take_cell(&mut self) -> Option<Box<Self::Cell>>;
    /// Starts a note from rest. What the voice and its cells played before leaves no trace.
    fn start(&mut self, context: &Self::Context, note: &Note, unison: Unison);
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

/// Which of the voices of one note a voice is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unison {
    /// From 0.
    pub index: usize,
    /// At least 1.
    pub count: usize,
}

impl Unison {
    /// The only voice of its note.
    pub const ONE: Self = Self { index: 0, count: 1 };

    /// Where the voice lies among the others, from −1 to 1, evenly; 0 if it is the only one.
    pub fn position(self) -> f64 {
        if self.count < 2 { 0.0 } else { 2.0 * self.index as f64 / (self.count - 1) as f64 - 1.0 }
    }
}
