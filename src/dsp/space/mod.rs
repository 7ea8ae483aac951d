//! The effects after the voices: stereo processors that do not depend on voices, events or parameters.
//!
//! | processor | what it does |
//! |---|---|
//! | [`ModalReverb`] | a resonant body whose modes are masses that every sample drives: a [`Plate`], a [`Spring`] tank, a [`Room`], sympathetic [`Strings`] |
//! | [`Soundbox`] | a body with a few fixed resonances, through which all sound passes |
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
//! A plate has all modes of a steel sheet: 12,965 masses up to 10 kHz. Each is `z ← λ (z + u)` at every frame, with the input `u`
//! and `λ = e^(iθ−σ)`, as in [`super::mode_bank`], and what is heard of it is its gain times the imaginary part of `z`. The
//! unit of each mass is its response to a sample of 1. A bank that steps all masses at every frame takes 1,908 ns a frame with
//! AVX2. A [`Resonator`] has the same output in a thirteenth of the time (`benches/README.md`), because it takes the response apart by age:
//!
//! - **The head**, what input does within one to two blocks of 11 ms, is a convolution (`resonator/head`). It has no latency.
//! - **The tail**, what older input does, is in the masses. They turn once a block, by `λ^B`. The sums that this needs, of a
//!   block's input for each mass and of all masses for each frame, are Fourier transforms at the masses' own frequencies
//!   (`resonator/taps`, `resonator/masses`).
//!
//! The work on a block is done in the next block and heard in the one after that. It is divided into control ticks of 64
//! frames: the input's transform in the first, the masses by groups, the output's transform in the last.
//!
//! **Exact.** At rest the output differs from that of a bank in double precision by less than −100 dB of its loudest frame:
//! −102 to −127 dB for all bodies, decays, pitches and rates that `resonator/tests` tries. The former bank was at −62 to
//! −102 dB, as its coefficients in single precision detuned the modes. Only springs with a T60 of 0.15 s or less differ
//! more, by −82 dB in the worst case that was tried: their masses cancel before the first echo, which has then decayed.
//!
//! **Smooth.** Pitch and decay move once a block, and masses keep amplitude and phase at that moment. The tail fades over from
//! its former pitch within a tick, the head within a block. Of low-passed noise in a plate without modes above 6 kHz, −112 dB
//! are above 15 kHz while the pitch moves by a fifth, where a bank whose coefficients jump leaves −81 dB; −128 and −100 dB by
//! a semitone; −98 and −99 dB while T60 becomes a fifth, because the wet level ramps. While something moves, all ticks of a
//! block but the last take equally long, about six times as long as at rest: the masses are laid out anew in groups of
//! neighbours, and the head is computed anew. The bank took longer at its worst tick.
//!
//! What was worse: convolution with the whole response (1,116 ns a frame for 30 s, and 70 MB; ringing modes cannot move);
//! octaves at lower rates (at most three times, by calculation). Sparse bodies gain least: a bank of 320 modes took less time,
//! and one of 600 modes as much.
//!
//! # Passive, and asleep in time
//!
//! Only input adds energy to a mass, however its decay changes: `√E` grows by at most `|input| √modes` per frame. With
//! the slowest mode of each third octave, the same inequality gives the bound from which a reverb computes its tail and
//! decides to sleep: the pick-ups output at most `Σ ‖gains‖ √E` (Cauchy and Schwarz). While something moves, the slower of
//! both decays counts. After a silent block, energies are measured every 2,048 frames, which lowers the bound to the real
//! energy. The bound assumes that all modes add up in phase, so sleep begins when noise is already near −160 dBFS. A reverb
//! that wakes starts its blocks anew with the first frame of input. Wet levels are scaled so that white noise keeps its
//! loudness for every body and decay; they follow when a change of the decay is heard.
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
mod soundbox;
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
pub use soundbox::{BoxBody, Resonance, Soundbox};
pub use spring::Spring;
pub use strings::Strings;
pub use tone::Tone;
pub use tremolo::Tremolo;
pub use width::Width;
