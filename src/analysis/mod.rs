//! What sound is measured with: fits, spectra, levels, digests, differences and figures. All arithmetic is in `f64`.
//!
//! For tests, documentation and people; nothing here is real-time safe, and no sample that the engine makes depends
//! on it.

pub mod alignment;
pub mod comparison;
pub mod damped_sine;
pub mod diff;
pub mod digest;
pub mod figure;
pub mod fit;
pub mod level;
pub mod log_mel;
pub mod measures;
pub mod modes;
pub mod spectrum;
