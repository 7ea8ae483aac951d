//! Files: MIDI songs in, WAV sound out, and the care with which outputs appear on disk.

mod bars;
pub mod midi;
pub mod output;
mod riff;
pub mod song;
mod tempo;
pub mod wav;

pub use output::{Output, Target};
pub use song::{Song, SongEvent};
pub use wav::{SampleFormat, WavFormat, WavWriter};
