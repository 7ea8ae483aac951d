//! Reads Standard MIDI Files (types 0 and 1) as songs: events in order of time.

mod container;
mod fault;
mod master_volume;
mod reader;
mod simultaneous;
mod system_exclusive;

use super::song::{Song, SongEvent};
use super::tempo::TempoMap;
use crate::engine::EventKind;
use crate::error::Error;
use container::Container;
use reader::TrackReader;
use std::io::Read;

pub use reader::MAX_EVENTS;

/// Maximum size of a MIDI file in bytes.
pub const MAX_FILE_SIZE: u64 = 64 << 20;

impl Song {
    /// Reads a MIDI file to its end. `origin` names it in errors.
    ///
    /// # Errors
    /// [`Error::Io`] if reading fails; [`Error::Format`] if the file is larger than [`MAX_FILE_SIZE`], or as
    /// [`Song::parse`].
    pub fn read(reader: impl Read, origin: &str) -> crate::Result<Self> {
        Self::parse(&read_file(reader, origin)?, origin)
    }

    /// As [`Song::read`], but with [`Song::parse_leniently`].
    ///
    /// # Errors
    /// As [`Song::read`].
    pub(crate) fn read_leniently(reader: impl Read, origin: &str) -> crate::Result<(Self, Vec<String>)> {
        Self::parse_leniently(&read_file(reader, origin)?, origin)
    }

    /// Reads the bytes of a MIDI file of type 0 or 1. `origin` names it in errors.
    ///
    /// Reading is strict: if a file is cut off or violates the standard, the error names track, bar and beat, and no
    /// notes are lost silently. There are two exceptions, in which nothing is lost: tracks may have no end mark, and
    /// data after the declared number of tracks is ignored.
    ///
    /// # Errors
    /// [`Error::Format`]. The message says so if `Song::parse_leniently` could read the file.
    pub fn parse(bytes: &[u8], origin: &str) -> crate::Result<Self> {
        parse(bytes, false).map(|(song, _)| song).map_err(|mut message| {
            if parse(bytes, true).is_ok() {
                message += "; add --lenient to read it nevertheless";
            }
            Error::format(origin, message)
        })
    }

    /// As [`Song::parse`], but repairs known faults, and returns a description of each. Running status continues after
    /// a meta or SysEx event; data bytes above 127 are taken as 127 where they are no key or program; messages of a MIDI
    /// cable, invalid meta events and tempos of 0 are ignored; a file that is cut off is read up to its end; wrong sizes,
    /// track counts and types are replaced by the real ones, and what stands between tracks is skipped. Where nothing can
    /// be made of a track, its rest is left out.
    ///
    /// # Errors
    /// [`Error::Format`] for all other faults.
    pub(crate) fn parse_leniently(bytes: &[u8], origin: &str) -> crate::Result<(Self, Vec<String>)> {
        parse(bytes, true).map_err(|message| Error::format(origin, message))
    }
}

fn read_file(reader: impl Read, origin: &str) -> crate::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(MAX_FILE_SIZE + 1).read_to_end(&mut bytes).map_err(|source| Error::io(origin, source))?;
    if bytes.len() as u64 > MAX_FILE_SIZE {
        let limit = MAX_FILE_SIZE >> 20;
        return Err(Error::format(origin, format!("too large for a MIDI file: expected at most {limit} MiB")));
    }
    Ok(bytes)
}

/// Returns the song, and descriptions of the repairs.
fn parse(bytes: &[u8], lenient: bool) -> Result<(Song, Vec<String>), String> {
    let Container { header, tracks, mut repairs } = Container::open(bytes, lenient)?;
    // Check the division first, since the places in later errors depend on it.
    TempoMap::new(header.timing, &[])?;
    let mut reader = TrackReader::new(header.timing, lenient);
    for (track, number) in tracks.iter().zip(1..) {
        reader.read(track, number)?;
    }
    let TrackReader { mut events, mut tempos, last_tick, .. } = reader;
    repairs.extend(reader.repairs.iter().map(ToString::to_string));
    // Stable sorts: at the same tick, tempo comes first, and the order of tracks and of events in a track stays.
    tempos.sort_by_key(|(tick, _)| *tick);
    let beats_per_minute = |tempo: u32| (6e7 / f64::from(tempo)) as f32;
    let told = tempos.iter().map(|(tick, tempo)| (*tick, 0, EventKind::Tempo(beats_per_minute(*tempo))));
    events.splice(..0, told);
    events.sort_by_key(|(tick, ..)| *tick);
    simultaneous::release_before_strike(&mut events);
    let events = master_volume::spread(events)?;
    let map = TempoMap::new(header.timing, &tempos)?;
    let timed = |(tick, channel, kind)| SongEvent { seconds: map.seconds(tick), channel, kind };
    Ok((Song { events: events.into_iter().map(timed).collect(), seconds: map.seconds(last_tick) }, repairs))
}

#[cfg(test)]
mod tests;
