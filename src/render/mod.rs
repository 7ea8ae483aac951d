//! The offline renderer: turns songs into samples, block by block, as fast as the machine can.

mod job;
pub mod labels;
pub mod meter;
mod stream;
#[cfg(test)]
mod tests;
mod threads;
mod wav;

pub use crate::dsp::limiter::Work as LimiterWork;
pub use crate::engine::synth::SAMPLE_RATES;
pub use job::{BLOCKS, Job, Options, Rendered, Tail};
pub use labels::{ModeLabel, NoteLabel};
pub use meter::{Levels, Meter};
pub use threads::{THREADS, on_threads};
pub use wav::{Delivery, Level, Progress, Report, to_labelled_wav, to_wav};
