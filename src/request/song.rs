//! The song of a request: a MIDI file, read strictly or leniently.

use crate::error::Result;
use crate::io::{Inputs, Song};
use std::path::Path;

/// Maximum number of repairs that are reported one by one.
const MOST_REPAIRS: usize = 10;

/// How a song is read.
#[derive(Clone, Copy, Debug, Default)]
pub struct SongRequest {
    /// Whether to repair a MIDI file that strays from the standard.
    pub lenient: bool,
}

impl SongRequest {
    /// Reads the song; `-` is stdin. `warn` is called for each repair.
    ///
    /// # Errors
    /// As [`Song::read`].
    pub fn read(&self, path: &Path, inputs: &mut Inputs, warn: &mut dyn FnMut(&str)) -> Result<Song> {
        if path == Path::new("-") {
            return self.parse(inputs.stdin()?.lock(), "stdin", warn);
        }
        self.parse(inputs.open(path)?, &path.display().to_string(), warn)
    }

    fn parse(&self, reader: impl std::io::Read, origin: &str, warn: &mut dyn FnMut(&str)) -> Result<Song> {
        if !self.lenient {
            return Song::read(reader, origin);
        }
        let (song, repairs) = Song::read_leniently(reader, origin)?;
        for repair in repairs.iter().take(MOST_REPAIRS) {
            warn(&format!("{origin}: {repair}"));
        }
        if repairs.len() > MOST_REPAIRS {
            warn(&format!("{origin}: {} repairs more", repairs.len() - MOST_REPAIRS));
        }
        Ok(song)
    }
}
