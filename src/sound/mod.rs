//! What notes are made from: sounds, bodies that are joined, kits that put sounds on keys, and how the keys are tuned.

pub mod bodies;
pub mod coupled;
pub mod kit;
mod shelf;
pub mod tuning;

pub use kit::{Kit, Pad};
pub use shelf::Shelf;
pub use tuning::Tuning;

use crate::patch::Patch;

/// A patch made ready to play: never changed afterwards, and shared by counted handles (`Arc<Sound>`).
///
/// An engine plays sounds as parts of a [`Kit`]. What changes modes, routes, tuning or pads is another sound or kit: notes
/// that ring keep the ones that they were struck with. Values alone move within the engine, by events. Made and freed off
/// the audio thread: see [`Shelf`].
#[derive(Clone, Debug, PartialEq)]
pub struct Sound {
    patch: Patch,
    tuning: Option<Tuning>,
}

impl Sound {
    /// The sound of a patch, on the tuning of the whole instrument. Allocates.
    pub fn new(patch: Patch) -> Self {
        Self { patch, tuning: None }
    }

    /// The sound with a tuning of its own, which goes before that of the instrument.
    #[must_use]
    pub fn tuned(mut self, tuning: Option<Tuning>) -> Self {
        self.tuning = tuning;
        self
    }

    /// The patch that it was made from.
    pub fn patch(&self) -> &Patch {
        &self.patch
    }

    /// The tuning of its own.
    pub fn tuning(&self) -> Option<&Tuning> {
        self.tuning.as_ref()
    }
}
