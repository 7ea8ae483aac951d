//! Up to 64 masses side by side, whose outputs are summed in one fixed order.
//!
//! The state of each mass is a point that turns around the origin: `x` is the displacement, and `y` is the displacement
//! a quarter period later, so `|(x, y)|` is the audible amplitude. Each frame multiplies the point by `r e^(iθ)`. This
//! gives the same damped sinusoid as [`super::HarmonicOscillator`], sample for sample. While the pitch moves, the
//! coefficients change linearly between control ticks. All coefficients lie inside the unit disk, so for any changes of
//! pitch and damping, only a strike can add energy to a mass.
//!
//! `bank` is the public interface, `rows` the data, `step` and `ring` are the two ways to render, `tuning` is the work
//! at control ticks, `table` makes the tables for freely ringing modes, `tail` computes how long they ring, and `exchange`
//! lets modes pass energy to each other. Kernels are written once for all vector instructions of [`super::simd`].

mod bank;
pub(super) mod exchange;
#[allow(clippy::needless_range_loop, reason = "as in `ring`")]
mod friction;
#[allow(clippy::needless_range_loop, reason = "kernels index several arrays in step")]
mod ring;
mod rows;
#[allow(clippy::needless_range_loop, reason = "as in `ring`")]
mod step;
mod table;
pub(super) mod tail;
mod tuning;

pub use bank::ModeBank;

/// Maximum number of modes in a bank.
pub const MAX_MODES: usize = 64;

/// The logarithm of the smallest radius for which the series is accurate. At sample rates from 8 kHz on, this is below that
/// of a voice's shortest T60, 0.5 ms; at 1 kHz the shortest T60 becomes 3.8 ms.
const LEAST_LN_RADIUS: f64 = -1.8;

/// The logarithm of the largest radius. The rounding of a step can add up to 1.3e-8 of the amplitude per frame, for a
/// low mode at a high rate (65 Hz at 768 kHz); this limit removes as much again. So a T60 is at most 4,829 s at 48 kHz.
const MOST_LN_RADIUS: f64 = -1.0 / (1 << 25) as f64;

/// One mode, as the arguments of [`ModeBank::load`].
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

/// How strongly the pulse and noise excite one mode.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExcitationGains {
    /// Amplitude after a pulse of unit area that pushes the mass (a strike).
    pub push: f32,
    /// Amplitude after a pulse of unit area that displaces the mass (a pluck).
    pub pull: f32,
    /// Expected amplitude after a noise burst of unit force.
    pub noise: f32,
    /// Phase advance in radians of the response to pulses; the amplitude does not change.
    pub phase: f32,
    /// Whether the response to noise has the phase as well, because the phase belongs to the body and not only to a pulse.
    pub turned_noise: bool,
}
