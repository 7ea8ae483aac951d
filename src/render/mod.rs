//! The offline renderer: turns songs into samples, block by block, as fast as the machine can.
//!
//! **Threads.** Channels of an ensemble depend on events alone, and the notes of a channel depend on nothing else between two
//! events. So whoever calls `Ensemble::process_by` may render them on any threads; voices and channels are added up in
//! their order. The renderer uses Rayon for this, in blocks of 512 frames and more, and renders the next block while the last
//! one is measured and written. Spaces, which come after the sum, and the limiter stay with one thread:
//! `benches/README.md` has what two cores gain, and what more would. `Ensemble::process`, which the audio thread calls, uses no
//! threads.
//!
//! **Two passes instead of a buffer.** Normalising, and writing a WAV to a pipe, need results from the end of the song
//! at its beginning. Since rendering is deterministic, the song is rendered twice, and memory use does not grow with
//! its length.

mod job;
pub(crate) mod labels;
pub(crate) mod looped;
pub(crate) mod meter;
pub(crate) mod stems;
mod stream;
#[cfg(test)]
mod tests;
pub(crate) mod threads;
pub(crate) mod wav;

pub use crate::dsp::limiter::Work as LimiterWork;
pub use crate::engine::synth::SAMPLE_RATES;
pub use job::{BLOCKS, Job, Options, Rendered, Tail};
pub(crate) use labels::{ModeLabel, NoteLabel};
pub(crate) use threads::on_threads;
pub(crate) use wav::to_labelled_wav;
pub use wav::{Delivery, Level, Progress, Report};
