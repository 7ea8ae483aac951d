//! Pure numerics: no events, no files, no threads.
//!
//! Real-time safe, except where noted.

pub mod bank;
pub mod cells;
pub mod classic_bank;
pub mod coefficients;
pub mod exciter;
pub(crate) mod fader;
pub mod limiter;
pub mod mode_bank;
pub mod oscillator;
pub mod pitch;
pub mod power;
pub mod ramp;
pub mod random;
pub mod real;
pub(crate) mod series;
#[allow(unsafe_code)]
pub mod simd;
pub(crate) mod smoothed;
pub mod space;
pub mod true_peak;

pub use bank::Bank;
pub use cells::{Cell, Cells};
pub use classic_bank::ClassicBank;
pub use coefficients::Coefficients;
pub use limiter::Limiter;
pub use mode_bank::ModeBank;
pub use oscillator::HarmonicOscillator;
pub(crate) use power::power_of_two;
pub use simd::Level;

/// Frames between two control ticks. Must not change: pitch and gain move linearly between ticks, so all samples depend on
/// it.
pub const CONTROL_FRAMES: usize = 32;
