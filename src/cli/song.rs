//! Reads the song that a command plays.

use super::terminal::complain;
use sprung::Result;
use sprung::io::{Inputs, Song};
use std::path::Path;

/// Maximum number of repairs that are reported one by one.
const MOST_REPAIRS: usize = 10;

/// How a song is read and played.
#[derive(clap::Args)]
pub(super) struct SongArgs {
    /// Repair a MIDI file that strays from the standard, and say how
    #[arg(long, requires = "song")]
    lenient: bool,
}

impl SongArgs {
    /// Reads the song; `-` is stdin.
    pub(super) fn read(&self, path: &Path, inputs: &mut Inputs) -> Result<Song> {
        if path == Path::new("-") {
            return self.parse(inputs.stdin()?.lock(), "stdin");
        }
        self.parse(inputs.open(path)?, &path.display().to_string())
    }

    fn parse(&self, reader: impl std::io::Read, origin: &str) -> Result<Song> {
        if !self.lenient {
            return Song::read(reader, origin);
        }
        let (song, repairs) = Song::read_leniently(reader, origin)?;
        for repair in repairs.iter().take(MOST_REPAIRS) {
            complain("warning", format_args!("{origin}: {repair}"));
        }
        if repairs.len() > MOST_REPAIRS {
            complain("warning", format_args!("{origin}: {} repairs more", repairs.len() - MOST_REPAIRS));
        }
        Ok(song)
    }
}
