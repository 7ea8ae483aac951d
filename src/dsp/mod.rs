//! Pure numerics: no events, no files, no threads. Everything in it is real-time safe.

pub mod coefficients;
pub mod oscillator;
pub mod random;
pub mod real;

pub use coefficients::Coefficients;
pub use oscillator::HarmonicOscillator;
