//! The offline renderer: turns songs into samples, block by block, as fast as the machine can.
//!
//! **Threads.** Channels of an ensemble depend on events alone, so a caller of `Ensemble::process_by` may render them
//! on any threads; they are added up in channel order. The renderer uses Rayon for this, in blocks of 512 frames and
//! more, and renders the next block while the last one is measured and written. A song with one channel gains only from
//! the latter. Single voices are not shared between cores: a tick of 16 ringing voices of 64 modes takes about 6 µs
//! (`benches/README.md`), and giving half of them to another core would save little more than it costs.
//! `Ensemble::process`, which the audio thread calls, uses no threads.
//!
//! **Two passes instead of a buffer.** Normalising, and writing a WAV to a pipe, need results from the end of the song
//! at its beginning. Since rendering is deterministic, the song is rendered twice, and memory use does not grow with
//! its length.

mod job;
pub mod labels;
mod looped;
pub mod meter;
mod stems;
mod stream;
#[cfg(test)]
mod tests;
mod threads;
mod wav;

pub use crate::dsp::limiter::Work as LimiterWork;
pub use crate::engine::synth::SAMPLE_RATES;
pub use job::{BLOCKS, Job, Options, Rendered, Tail};
pub(crate) use labels::{ModeLabel, NoteLabel};
pub use looped::to_looped_wav;
pub use meter::{Levels, Meter};
pub use stems::{Stem, StemsReport, stems_of, to_stem_wavs};
pub use threads::{THREADS, on_threads};
pub(crate) use wav::to_labelled_wav;
pub use wav::{Delivery, Level, Progress, Report, to_wav};
