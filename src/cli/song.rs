//! Options for reading the song that a command plays.

use sprung::request::SongRequest;

/// How a song is read and played.
#[derive(clap::Args)]
pub(super) struct SongArgs {
    /// Repair a MIDI file that strays from the standard, and say how
    #[arg(long, requires = "song")]
    lenient: bool,
}

impl SongArgs {
    pub(super) fn request(&self) -> SongRequest {
        SongRequest { lenient: self.lenient }
    }
}
