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

/// The modes of a bank, a row for each field of [`ModeSetup`].
#[derive(Clone, Copy, Debug)]
pub struct ModeRows {
    /// As [`ModeSetup::frequency`].
    pub frequency: [f64; MAX_MODES],
    /// As [`ModeSetup::t60`].
    pub t60: [f64; MAX_MODES],
    /// As [`ModeSetup::left`].
    pub left: [f32; MAX_MODES],
    /// As [`ModeSetup::right`].
    pub right: [f32; MAX_MODES],
    /// Number of modes, at most [`MAX_MODES`]. Numbers beyond them are not used.
    pub len: usize,
}

impl FromIterator<ModeSetup> for ModeRows {
    /// Modes beyond [`MAX_MODES`] are ignored.
    fn from_iter<I: IntoIterator<Item = ModeSetup>>(modes: I) -> Self {
        let (wide, gains) = ([1.0; MAX_MODES], [1.0; MAX_MODES]);
        let mut rows = Self { frequency: wide, t60: wide, left: gains, right: gains, len: 0 };
        for (m, mode) in modes.into_iter().take(MAX_MODES).enumerate() {
            (rows.frequency[m], rows.t60[m]) = (mode.frequency, mode.t60);
            (rows.left[m], rows.right[m], rows.len) = (mode.left, mode.right, m + 1);
        }
        rows
    }
}

/// How strongly the pulse and noise excite one mode.
#[derive(Clone, Copy, Debug)]
pub struct ExcitationGains {
    /// Amplitude after a pulse of unit area that pushes the mass (a strike).
    pub push: f32,
    /// Amplitude after a pulse of unit area that displaces the mass (a pluck).
    pub pull: f32,
    /// Expected amplitude after a noise burst of unit force.
    pub noise: f32,
    /// Cosine and sine of the phase advance of the response to pulses; the amplitude does not change.
    pub turn: [f32; 2],
}

impl ExcitationGains {
    /// No excitation.
    pub const NONE: Self = Self { push: 0.0, pull: 0.0, noise: 0.0, turn: [1.0, 0.0] };
}

/// The excitation gains of the modes of a bank, a row for each.
#[derive(Clone, Copy, Debug)]
pub struct ExcitationRows {
    /// As [`ExcitationGains::push`].
    pub push: [f32; MAX_MODES],
    /// As [`ExcitationGains::pull`].
    pub pull: [f32; MAX_MODES],
    /// As [`ExcitationGains::noise`].
    pub noise: [f32; MAX_MODES],
    /// As [`ExcitationGains::turn`].
    pub turn: [[f32; MAX_MODES]; 2],
    /// Whether the response to noise has the phases as well, because they belong to the body and not only to a pulse.
    pub turned_noise: bool,
}

impl ExcitationRows {
    /// No excitation.
    pub const NONE: Self = Self::all(ExcitationGains::NONE);

    /// The same gains for all modes. Noise has no phase.
    pub const fn all(ExcitationGains { push, pull, noise, turn: [cos, sin] }: ExcitationGains) -> Self {
        let [push, pull, noise] = [[push; MAX_MODES], [pull; MAX_MODES], [noise; MAX_MODES]];
        Self { push, pull, noise, turn: [[cos; MAX_MODES], [sin; MAX_MODES]], turned_noise: false }
    }

    /// The gains of mode `m`.
    pub fn at(&self, m: usize) -> ExcitationGains {
        let Self { push, pull, noise, turn: [cos, sin], .. } = self;
        ExcitationGains { push: push[m], pull: pull[m], noise: noise[m], turn: [cos[m], sin[m]] }
    }
}
