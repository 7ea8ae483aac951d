//! Files: MIDI songs in, WAV sound out, and the care with which outputs appear on disk.

mod bars;
pub mod inputs;
pub mod midi;
pub mod output;
mod riff;
pub mod song;
mod song_cursor;
pub mod target;
mod tempo;
mod temporary;
pub mod wav;
mod wav_format;

pub use inputs::Inputs;
pub use output::Output;
pub use song::{Song, SongEvent};
pub use song_cursor::{SILENCE_INTERVAL, SongCursor};
pub use target::Target;
pub use wav::WavWriter;
pub use wav_format::{SampleFormat, WavFormat};
