//! Files: reads MIDI songs and recordings, writes WAV and FLAC sound, and replaces output files only when they are complete.

mod bars;
#[cfg(feature = "batch")]
mod file_format;
#[cfg(feature = "batch")]
pub(crate) mod flac;
pub(crate) mod inputs;
#[cfg(feature = "batch")]
mod journal;
pub(crate) mod midi;
pub(crate) mod output;
mod quantise;
#[cfg(feature = "render")]
mod riff;
#[cfg(feature = "render")]
mod room;
#[cfg(feature = "render")]
mod sampler_chunk;
pub(crate) mod song;
mod song_cursor;
#[cfg(feature = "fit")]
pub mod sound_file;
pub(crate) mod target;
mod tempo;
mod temporary;
#[cfg(feature = "render")]
pub(crate) mod wav;
#[cfg(feature = "render")]
mod wav_format;

pub use bars::SongTime;
#[cfg(feature = "batch")]
pub use file_format::FileFormat;
pub(crate) use inputs::Inputs;
#[cfg(feature = "batch")]
pub(crate) use journal::Journal;
pub(crate) use midi::{MidiFile, Reading};
pub(crate) use output::Output;
pub(crate) use quantise::quantise;
#[cfg(feature = "render")]
pub(crate) use sampler_chunk::Loop;
#[cfg(feature = "render")]
pub(crate) use sampler_chunk::MIDDLE_C;
pub use song::{Song, SongEvent};
pub(crate) use song_cursor::{SILENCE_INTERVAL, SongCursor};
pub(crate) use target::Target;
#[cfg(feature = "render")]
pub use wav::WavWriter;
#[cfg(feature = "render")]
pub use wav_format::{SampleFormat, WavFormat};
