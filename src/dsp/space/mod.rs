//! The effects after the voices: stereo processors that do not depend on voices, events or parameters.
//!
//! | processor | what it does |
//! |---|---|
//! | [`ModalReverb`] | a resonant body whose modes are masses that every sample drives: a [`Plate`], a [`Spring`] tank, a [`Room`], sympathetic [`Strings`] |
//! | [`Tremolo`] | the tremolo of a vibraphone's motor |
//! | [`Overdrive`] | soft clipping |
//! | [`Tone`] | low and high shelving filters |
//! | [`Width`] | the level of the side signal relative to the middle |
//!
//! A body is made in three steps, off the audio thread: its shape gives a [`ModeSet`], which with a [`Decay`] and a sample
//! rate gives a [`Resonator`]. All processors change `left` and `right` in place, give the same bits for any division into
//! blocks and on any CPU, and never allocate, lock or panic. Setters move smoothly.

mod bands;
mod decay;
mod half_band;
#[allow(clippy::needless_range_loop, reason = "kernels index several arrays in step")]
mod kernel;
mod material;
mod modes;
mod overdrive;
mod plate;
mod pre_delay;
mod resonator;
mod reverb;
mod room;
mod smoothed;
mod spring;
mod strings;
mod ticks;
mod tone;
mod tremolo;
mod width;

pub use decay::Decay;
pub use material::Material;
pub use modes::{BodyMode, MAX_MODES, ModeSet};
pub use overdrive::Overdrive;
pub use plate::Plate;
pub use resonator::Resonator;
pub use reverb::{LONGEST_PRE_DELAY, ModalReverb};
pub use room::Room;
pub use spring::Spring;
pub use strings::Strings;
pub use tone::Tone;
pub use tremolo::Tremolo;
pub use width::Width;
