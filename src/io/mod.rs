//! Files: MIDI songs in, WAV sound out, and the care with which outputs appear on disk.

#[cfg(feature = "render")]
mod bars;
pub mod inputs;
#[cfg(feature = "render")]
pub mod midi;
pub mod output;
mod quantise;
#[cfg(feature = "render")]
mod riff;
#[cfg(feature = "render")]
mod room;
pub mod song;
mod song_cursor;
pub mod target;
#[cfg(feature = "render")]
mod tempo;
mod temporary;
#[cfg(feature = "render")]
pub mod wav;
#[cfg(feature = "render")]
mod wav_format;

pub use inputs::Inputs;
pub use output::Output;
pub use quantise::quantise;
pub use song::{Song, SongEvent};
pub use song_cursor::{SILENCE_INTERVAL, SongCursor};
pub use target::Target;
#[cfg(feature = "render")]
pub use wav::WavWriter;
#[cfg(feature = "render")]
pub use wav_format::{SampleFormat, WavFormat};
