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
//!
//! # A body is a bank of modes
//!
//! A plate has all modes of a steel sheet: 12,965 masses up to 10 kHz, with the coordinates and the CPU instructions of
//! [`super::mode_bank`]. `kernel` has no code for pitch that moves within a tick, and reads a block of 16 masses as one
//! piece of memory. The unit of each mass is its response to a sample of 1, so that driving it is one addition. `cargo
//! bench --bench space` compares the plate with the driven bank. SSE2 and scalar code, which emulate the fused
//! operation, are too slow for a plate in real time: a temporary program measured 0.18 and 0.10 · 10⁹ modes × frames
//! per second, the work of 3.5 and 6 cores.
//!
//! # Passive, and asleep in time
//!
//! Only input adds energy to a mass, however its decay changes: `√E` grows by at most `|input| √modes` per frame. With
//! the slowest mode of each third octave, the same inequality gives the bound from which a reverb computes its tail and
//! decides to sleep: the pick-ups output at most `Σ ‖gains‖ √E` (Cauchy and Schwarz). Energies are measured every 2,048
//! frames, which lowers the bound to the real energy. The bound assumes that all modes add up in phase, so sleep begins
//! when noise is already near −160 dBFS. Wet levels are scaled so that white noise keeps its loudness for every body
//! and decay.
//!
//! Tests: `tests/engine/space/` measures T60 by octave within 5 %, and tests passivity, sleep, tails, blocks, clicks,
//! loudness, aliases and allocation; `tests/levels/` compares the bits of all levels.

mod bands;
mod decay;
mod half_band;
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
