//! From events to samples: voices, their manager, the synth, and the ensemble of sixteen channels.
//!
//! Knows no files, no command line and no audio device. Everything here is real-time safe once built.

pub mod ensemble;
pub mod event;

pub use ensemble::Ensemble;
pub use event::{Event, EventKind};
