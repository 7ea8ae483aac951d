//! What notes are made from besides a patch: how the keys are tuned.

pub mod tuning;

pub use tuning::Tuning;
