//! Up to 64 masses side by side, their ringing summed in one fixed order.
//!
//! Each mass is kept as a point that turns: `x` is its displacement and `y` the displacement that it will have a
//! quarter turn ahead, so `|(x, y)|` is the amplitude that is heard. One frame multiplies the point by `r e^(iθ)`: the
//! same damped sinusoid as [`super::HarmonicOscillator`] gives, sample for sample. Pitch moves in straight lines of the
//! coefficients between control ticks. All of them lie inside the unit disk, so no mass can gain energy from anything
//! but a strike, however its pitch and its damping move.
//!
//! `bank` has the bank as its users see it, `rows` its data, `step` and `ring` what happens every sample, `tuning` what
//! happens at control ticks, `table` the tables of freely ringing modes, `tail` how long they ring. Kernels are written
//! once for all vector instructions of [`super::simd`].

mod bank;
#[allow(clippy::needless_range_loop, reason = "kernels index several arrays in step")]
mod ring;
mod rows;
#[allow(clippy::needless_range_loop, reason = "as in `ring`")]
mod step;
mod table;
pub(super) mod tail;
mod tuning;

pub use bank::ModeBank;

/// Most modes in a bank.
pub const MAX_MODES: usize = 64;

/// The logarithm of the smallest radius that the series for it can take: a T60 of 0.5 ms at 8 kHz, the least of a voice;
/// at 1 kHz modes ring for 3.8 ms at least.
const LEAST_LN_RADIUS: f64 = -1.8;

/// The logarithm of the largest radius: what a step's rounding can add at worst where a low mode moves at a high rate
/// (65 Hz at 768 kHz: 1.3e-8 of the amplitude a frame) is taken away again. So a T60 is at most 4,829 s at 48 kHz.
const MOST_LN_RADIUS: f64 = -1.0 / (1 << 25) as f64;

/// One mode as it is loaded into a bank.
#[derive(Clone, Copy, Debug)]
pub struct ModeSetup {
    /// Frequency in Hz at a pitch ratio of 1.
    pub frequency: f64,
    /// T60 in seconds.
    pub t60: f64,
    /// Output gain to the left.
    pub left: f32,
    /// Output gain to the right.
    pub right: f32,
}

/// How strongly one mode is moved by what drives a bank.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExcitationGains {
    /// Amplitude that a pulse of unit area gives by pushing (a strike).
    pub push: f32,
    /// Amplitude that a pulse of unit area gives by displacing (a pluck).
    pub pull: f32,
    /// Expected amplitude that a noise burst of unit force gives.
    pub noise: f32,
    /// By how many radians what a pulse brings is turned ahead; its amplitude stays.
    pub phase: f32,
}
