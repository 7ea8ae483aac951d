//! Measures sound, in `f64`: fits, spectra, levels, digests, differences and figures.
//!
//! It serves tests, documentation and people. Nothing here is real-time safe, and no sample of the engine depends on
//! it. With the feature `fit` alone there are no digests, figures and measures.

pub mod alignment;
pub mod comparison;
pub mod diff;
#[cfg(feature = "analysis")]
pub mod digest;
#[cfg(feature = "analysis")]
pub mod figure;
pub mod fit;
pub mod level;
pub(crate) mod line;
pub mod log_mel;
#[cfg(feature = "analysis")]
pub mod measures;
pub mod modes;
pub mod spectrum;
