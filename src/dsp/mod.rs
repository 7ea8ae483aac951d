//! Pure numerics: no events, no files, no threads.
//!
//! Real-time safe, except where noted.

pub(crate) mod bank;
pub(crate) mod cells;
pub(crate) mod classic_bank;
pub(crate) mod coefficients;
pub(crate) mod exciter;
pub(crate) mod fader;
pub(crate) mod limiter;
pub(crate) mod mode_bank;
pub(crate) mod oscillator;
pub(crate) mod pitch;
pub(crate) mod power;
pub(crate) mod ramp;
pub(crate) mod random;
pub(crate) mod real;
pub(crate) mod series;
#[allow(unsafe_code)]
pub(crate) mod simd;
pub(crate) mod smoothed;
pub(crate) mod space;
pub(crate) mod true_peak;
pub(crate) mod wander;

pub(crate) use cells::Cell;
pub(crate) use classic_bank::ClassicBank;
pub use coefficients::Coefficients;
pub use exciter::Drive;
pub(crate) use limiter::Limiter;
pub use mode_bank::{ExcitationGains, ExcitationRows, MAX_MODES, ModeBank, ModeRows, ModeSetup};
pub use oscillator::HarmonicOscillator;
pub(crate) use power::power_of_two;

/// Frames between two control ticks. Must not change: pitch and gain move linearly between ticks, so all samples depend on
/// it.
pub const CONTROL_FRAMES: usize = 32;
