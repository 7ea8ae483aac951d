//! Sounds and kits that an engine plays, the bodies and pairs of bodies they are made of, the tuning of the keys, and the mix.
//!
//! While a new sound is made, a live host continues to play the old one. `Synth::set_kit` switches to the new kit at
//! one frame, and later notes play it. Sounding notes continue unchanged, because a voice has its own modes, ratios,
//! decay and routes, and keeps its last controls: nothing is retuned and nothing clicks. `tests/engine/kits.rs` compares the
//! bits of sounding notes with and without 300 changes of kit.
//!
//! Instruments drop their references to sounds before the synth drops its reference to the kit, which also refers to
//! each of them; so only the reference to the kit must be kept in a [`Collector`]. `tests/engine/allocation.rs` exchanges a
//! thousand kits per second, each made and dropped meanwhile.
//!
//! The parameters of a kit of several sounds start at the defaults: each sound's value is as far from its own value, in
//! knob travel, as the kit's value is from the default.

pub(crate) mod blown;
pub mod bodies;
mod collector;
pub(crate) mod contact;
pub(crate) mod coupled;
pub(crate) mod kit;
mod mix;
pub mod pairs;
pub mod tuning;

pub use collector::Collector;
pub use contact::{Contact, contact_time};
pub use kit::{KEYS, Kit, OUTPUTS, Pad};
pub use mix::Mix;
pub use tuning::Tuning;

use crate::patch::Patch;

/// A patch that is ready to play. It never changes afterwards, and is shared as `Arc<Sound>`.
///
/// An engine plays sounds as parts of a [`Kit`]. Other modes, routes, tunings or pads need another sound or kit:
/// sounding notes keep the sound that they were started with. Only parameter values change inside the engine, by events.
/// Sounds are made and freed outside the audio thread: see [`Collector`].
#[derive(Clone, Debug, PartialEq)]
pub struct Sound {
    patch: Patch,
    tuning: Option<Tuning>,
    correction: Option<blown::Correction>,
}

impl Sound {
    /// The sound of a patch, in the tuning of the whole instrument. Allocates. If the patch has a table of modes for each
    /// key, these are made here, which can take a second; clones of the patch share them. If it is blown, it is tuned here, which
    /// takes up to a tenth of a second.
    pub fn new(patch: Patch) -> Self {
        patch.modes.make_tables();
        let correction = blown::Correction::of(&patch);
        Self { patch, tuning: None, correction }
    }

    /// The sound with a tuning of its own, which replaces that of the instrument; none for the instrument's.
    #[must_use]
    pub fn tuned(mut self, tuning: Option<Tuning>) -> Self {
        self.tuning = tuning;
        self
    }

    /// The patch of the sound.
    pub fn patch(&self) -> &Patch {
        &self.patch
    }

    /// How its tube is tuned, if it is blown.
    pub(crate) fn correction(&self) -> Option<&blown::Correction> {
        self.correction.as_ref()
    }

    /// The sound's own tuning, if it has one.
    pub fn tuning(&self) -> Option<&Tuning> {
        self.tuning.as_ref()
    }
}
