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
//!
//! # Why the state is not displacement and velocity
//!
//! [`super::HarmonicOscillator`] stores displacement and velocity, as the original listing does. It defines a mode, and
//! tests compare the bank with it. It is exact while its coefficients are constant. But a change of pitch may add
//! energy: a state that has little energy at one pitch can have much at another, above all near half the sample rate
//! (vibrato of ±800 cents at 23 kHz: +108 dB in two seconds). In the coordinates of the bank, the amplitude `|(x, y)|`
//! does not depend on the pitch.
//!
//! - The coefficient `r cos θ` is stored as `α = 1 − r cos θ`, so that long decays at low pitches lose no digits.
//! - The straight line between two coefficients is a chord, which is shorter than the arc: over a tick that turns by
//!   `Δθ`, the logarithm of the amplitude loses about `32 Δθ²/12`. `tuning` compensates for it, except after a tick in
//!   which a force has acted. T60 stays within 0.1 % while the pitch moves an octave up and down in 20 ms each, without
//!   end (`decay_does_not_depend_on_the_movement_of_the_pitch`).
//! - The bank agrees with the oscillator in double precision within −120 dB RMS up to 10 kHz, and within −110 dB above,
//!   where the phase has the errors of single precision (`bank::tests`).
//!
//! # Tables or steps
//!
//! Modes that have rung freely at one pitch for `1 + modes/8` ticks get tables; modes that are swept, damped or driven
//! are stepped. If a host block ends within a tick, the rest of the tick is kept for the next block. If an event falls
//! within a tick, the state at its frame is computed by stepping from the start of the tick. A bank has 20.4 KB, of
//! which 8 KB are tables.
//!
//! # Frozen
//!
//! The bits depend on 16 lanes, 16 frames per table, the orders of summation in `ring`, `step` and `played`, 32
//! frames per control tick, and 4 frames with the same coefficients.
//!
//! # What did not work
//!
//! G is 10⁹ modes × frames per second. Each of these figures was measured once; no command of the project repeats it.
//! `benches/README.md` has those that `cargo xtask bench-table` measures.
//!
//! - Displacement and velocity as separate broadcasts in the table loop, each with a register: limited by loads, 18.8 G
//!   on AVX-512. As pairs (see `ring`), each mode needs two loads fewer.
//! - Copying the output and swapping the states took a third of the speed of a single mode (1.1 instead of 1.7 G).
//! - A kernel that always reads pulse, pluck and noise waits for three more fused operations. If there is only one
//!   force, reading only that one: 13.8 instead of 11.4 G driven on AVX-512; with eight vectors at a time as well, 9.7
//!   instead of 6.1 G on AVX2.
//! - Negating coefficients in the loop over frames: the compiler keeps both the negated and the plain ones, and runs
//!   out of registers. Negating the state, which changes every frame anyway: 7.6 instead of 6.7 G modulated on AVX-512.
//! - Two vectors at a time on AVX2, so that everything fits into 16 registers: 7.5 instead of 10.3 G stepped, 3.9
//!   instead of 6.1 G driven. Constants as memory operands cost less than waiting.
//! - A running sum for ramps instead of `start + i · step`: every addition of a ramp rounds in the same direction, and
//!   T60 was wrong by 0.4 % under vibrato.
//! - One function for every case (three kinds of movement, three of force, mono and stereo, one to four groups of
//!   modes): a debug build took 275 s of CPU time instead of 104.
//! - All cases of the scalar and the SSE2 kernel inlined into one function, as the other levels need it: a third of the
//!   time that the optimiser took for the library. Each case is a separate function now, with the same instruction
//!   counts.
//! - Release builds without link-time optimisation within the crate (`lto = "off"`): a quarter less compile time, but
//!   46 % more instructions for driven banks and 63 % more for a silent ensemble.
//! - When voices take turns, they read their tables from the second-level cache: 21 instead of 26 G. Tables of eight
//!   frames would halve this traffic, but need as many more broadcasts and rotations (by count; not tried).

mod bank;
pub(super) mod exchange;
#[allow(clippy::needless_range_loop, reason = "as in `ring`")]
pub(super) mod played;
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
    pub(crate) frequency: [f64; MAX_MODES],
    /// As [`ModeSetup::t60`].
    pub(crate) t60: [f64; MAX_MODES],
    /// As [`ModeSetup::left`].
    pub(crate) left: [f32; MAX_MODES],
    /// As [`ModeSetup::right`].
    pub(crate) right: [f32; MAX_MODES],
    /// Number of modes, at most [`MAX_MODES`]. Numbers beyond them are not used.
    pub(crate) len: usize,
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
    pub(crate) push: [f32; MAX_MODES],
    /// As [`ExcitationGains::pull`].
    pub(crate) pull: [f32; MAX_MODES],
    /// As [`ExcitationGains::noise`].
    pub(crate) noise: [f32; MAX_MODES],
    /// As [`ExcitationGains::turn`].
    pub(crate) turn: [[f32; MAX_MODES]; 2],
    /// Whether the response to noise has the phases as well, because they belong to the body and not only to a pulse.
    pub(crate) turned_noise: bool,
}

impl ExcitationRows {
    /// No excitation.
    pub(crate) const NONE: Self = Self::all(ExcitationGains::NONE);

    /// The same gains for all modes. Noise has no phase.
    pub const fn all(ExcitationGains { push, pull, noise, turn: [cos, sin] }: ExcitationGains) -> Self {
        let [push, pull, noise] = [[push; MAX_MODES], [pull; MAX_MODES], [noise; MAX_MODES]];
        Self { push, pull, noise, turn: [[cos; MAX_MODES], [sin; MAX_MODES]], turned_noise: false }
    }

    /// The gains of mode `m`.
    pub(crate) fn at(&self, m: usize) -> ExcitationGains {
        let Self { push, pull, noise, turn: [cos, sin], .. } = self;
        ExcitationGains { push: push[m], pull: pull[m], noise: noise[m], turn: [cos[m], sin[m]] }
    }
}
