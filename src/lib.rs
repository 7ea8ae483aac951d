//! Sprung: a synthesizer whose only sound source is a mass on a spring.
//!
//! One mass is a kick drum or a sine; sixty-four are a marimba or a bell. The signal path, and the order in which
//! to read the crate:
//!
//! | module | holds |
//! |---|---|
//! | [`dsp`] | pure numerics: the oscillator, the bank of modes, exciters, pitch envelopes, smoothing |
//! | [`params`], [`patch`], [`preset`] | what can be set, a set of values, and its file |
//! | [`engine`] | events, voices, the voice manager, the synth, the ensemble of sixteen channels |
//! | [`io`], [`render`](mod@render) | MIDI files in, WAV files out, and the offline renderer between them |

pub mod dsp;
pub mod engine;
pub mod error;
pub mod io;
pub mod params;
pub mod patch;
pub mod preset;
pub mod render;
pub mod units;

pub use error::{Error, Result};
