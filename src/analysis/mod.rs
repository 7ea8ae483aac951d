//! Measures sound, in `f64`: fits, spectra, levels, digests, differences and figures.
//!
//! It serves tests, documentation and people. Nothing here is real-time safe, and no sample of the engine depends on
//! it. With the feature `fit` alone there are no digests, figures and measures.

pub(crate) mod alignment;
pub(crate) mod comparison;
pub(crate) mod diff;
#[cfg(feature = "analysis")]
pub(crate) mod digest;
#[cfg(feature = "analysis")]
pub mod figure;
pub mod fit;
pub(crate) mod level;
pub(crate) mod line;
pub mod log_mel;
#[cfg(feature = "analysis")]
pub(crate) mod measures;
pub mod modes;
pub(crate) mod spectrum;

pub use alignment::Alignment;
pub use comparison::{Comparison, Octave};
pub use diff::Difference;
