//! Options for reading the song that a command plays.

use super::quantity;
use sprung::internals::request::SongRequest;

/// How a song is read and played.
#[derive(clap::Args)]
pub(super) struct SongArgs {
    /// Repair a MIDI file that strays from the standard, and say how
    #[arg(long, requires = "song")]
    lenient: bool,
    /// Factor of the tempo, 0.1-10
    #[arg(long, default_value_t = 1.0, value_name = "FACTOR", requires = "song", allow_hyphen_values = true,
        value_parser = quantity::tempo)]
    tempo: f64,
    /// Semitones by which the notes of all channels but 10 are moved, -60 to 60
    #[arg(long, default_value_t = 0, value_name = "SEMITONES", requires = "song", allow_hyphen_values = true,
        value_parser = quantity::transpose)]
    transpose: i32,
    /// Pattern of a file of type 2, whose tracks are patterns, from 1
    #[arg(long, value_name = "N", requires = "song", allow_hyphen_values = true,
        value_parser = quantity::whole::<u16>(1..=u16::MAX.into()))]
    pattern: Option<u16>,
    /// Channels to hear alone, 1-16
    #[arg(long, value_name = "CHANNELS", value_delimiter = ',', requires = "song", value_parser = quantity::whole::<u8>(1..=16))]
    solo: Vec<u8>,
    /// Channels to leave out, 1-16
    #[arg(long, value_name = "CHANNELS", value_delimiter = ',', requires = "song", value_parser = quantity::whole::<u8>(1..=16))]
    mute: Vec<u8>,
}

impl SongArgs {
    pub(super) fn request(&self) -> SongRequest {
        SongRequest {
            lenient: self.lenient,
            tempo: self.tempo,
            transpose: self.transpose,
            solo: self.solo.clone(),
            mute: self.mute.clone(),
            pattern: self.pattern,
            ..SongRequest::default()
        }
    }
}
