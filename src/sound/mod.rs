//! What notes are made from: sounds, kits that put sounds on keys, and how the keys are tuned.

pub mod bodies;
pub mod kit;
pub mod tuning;

pub use kit::Kit;
pub use tuning::Tuning;

use crate::patch::Patch;

/// A patch made ready to play: never changed afterwards, and shared by counted handles (`Arc<Sound>`).
///
/// A voice keeps the handle of the sound that it was started with, so that nothing that happens to the instrument later
/// changes its modes or routes. Made and freed off the audio thread: whoever makes a sound keeps a handle for as long as
/// an engine may have one.
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
