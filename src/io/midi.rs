//! Reads Standard MIDI Files (types 0 and 1, and patterns of type 2) as songs: events in order of time.

mod container;
mod fault;
mod limits;
mod master;
mod reader;
mod simultaneous;
mod system_exclusive;
mod tuning_standard;
mod unheeded;

use super::bars::Places;
use super::song::{Song, SongEvent};
use super::tempo::TempoMap;
use crate::engine::EventKind;
use crate::error::Error;
use container::Container;
use midly::{Format, Header};
use reader::TrackReader;
use std::io::Read;

/// Maximum size of a MIDI file in bytes.
pub(crate) const MAX_FILE_SIZE: u64 = 64 << 20;

/// How a MIDI file is read.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Reading {
    /// Whether to repair known faults.
    pub(crate) lenient: bool,
    /// The pattern of a file of type 2, from 1.
    pub(crate) pattern: Option<u16>,
}

/// What a MIDI file has.
pub(crate) struct MidiFile {
    pub(crate) song: Song,
    /// Descriptions of the repairs.
    pub(crate) repairs: Vec<String>,
    /// A warning of what is not obeyed.
    pub(crate) unheeded: Option<String>,
    pub(crate) places: Places,
}

impl MidiFile {
    /// Reads a MIDI file to its end. `origin` names it in errors.
    ///
    /// # Errors
    /// As [`Song::read`].
    pub(crate) fn read(reader: impl Read, origin: &str, reading: Reading) -> crate::Result<Self> {
        Self::parse(&read_file(reader, origin)?, origin, reading)
    }

    fn parse(bytes: &[u8], origin: &str, reading: Reading) -> crate::Result<Self> {
        parse(bytes, reading).map_err(|mut message| {
            if !reading.lenient && parse(bytes, Reading { lenient: true, ..reading }).is_ok() {
                message += "; add --lenient to read it nevertheless";
            }
            Error::format(origin, message)
        })
    }
}

impl Song {
    /// Reads a MIDI file to its end. `origin` names it in errors.
    ///
    /// # Errors
    /// [`Error::Io`] if reading fails; [`Error::Format`] if the file is larger than 64 MiB, or as
    /// [`Song::parse`].
    pub fn read(reader: impl Read, origin: &str) -> crate::Result<Self> {
        Ok(MidiFile::read(reader, origin, Reading::default())?.song)
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
        Ok(MidiFile::parse(bytes, origin, Reading::default())?.song)
    }

    /// As [`Song::parse`], but repairs known faults, and returns a description of each. Running status continues after
    /// a meta or SysEx event; data bytes above 127 are taken as 127 where they are no key or program; messages of a MIDI
    /// cable, invalid meta events and tempos of 0 are ignored; a file that is cut off is read up to its end; wrong sizes,
    /// track counts and types are replaced by the real ones, and what stands between tracks is skipped. Where nothing can
    /// be made of a track, its rest is left out.
    ///
    /// # Errors
    /// [`Error::Format`] for all other faults.
    pub fn parse_leniently(bytes: &[u8], origin: &str) -> crate::Result<(Self, Vec<String>)> {
        let file = MidiFile::parse(bytes, origin, Reading { lenient: true, pattern: None })?;
        Ok((file.song, file.repairs))
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

fn parse(bytes: &[u8], Reading { lenient, pattern }: Reading) -> Result<MidiFile, String> {
    let Container { header, mut tracks, mut repairs } = Container::open(bytes, lenient)?;
    let first = pattern_track(&header, tracks.len(), pattern)?;
    // Check the division first, since the places in later errors depend on it.
    TempoMap::new(header.timing, &[])?;
    let mut reader = TrackReader::new(header.timing, lenient);
    if let Some(only) = first {
        tracks = tracks.drain(only..=only).collect();
    }
    for (track, number) in tracks.iter().zip(1 + first.unwrap_or(0)..) {
        reader.read(track, number)?;
    }
    repairs.extend(reader.repairs.iter().map(ToString::to_string));
    let TrackReader { mut events, mut tempos, mut tunings, unheeded, last_tick, bars, .. } = reader;
    // Stable sorts: at the same tick, tempo comes first, and the order of tracks and of events in a track stays.
    tempos.sort_by_key(|(tick, _)| *tick);
    let beats_per_minute = |tempo: u32| (6e7 / f64::from(tempo)) as f32;
    let told = tempos.iter().map(|(tick, tempo)| (*tick, 0, EventKind::Tempo(beats_per_minute(*tempo))));
    events.splice(..0, told);
    // A reset comes before all else at its tick, in whichever track it is.
    events.sort_by_key(|(tick, channel, kind)| (*tick, !master::is_reset(*channel, kind)));
    simultaneous::release_before_strike(&mut events);
    let events = master::spread(events)?;
    tunings.sort_by_key(|(tick, _)| *tick);
    let events = tuning_standard::spread(events, &tunings)?;
    let map = TempoMap::new(header.timing, &tempos)?;
    let timed = |(tick, channel, kind)| SongEvent { seconds: map.seconds(tick), channel, kind };
    let song = Song { events: events.into_iter().map(timed).collect(), seconds: map.seconds(last_tick) };
    Ok(MidiFile { song, repairs, unheeded: unheeded.warning(), places: Places { bars, tempos: map } })
}

/// The index of the track that is the pattern asked for; none if all tracks are one song.
fn pattern_track(header: &Header, tracks: usize, pattern: Option<u16>) -> Result<Option<usize>, String> {
    match (header.format, pattern) {
        (Format::Sequential, Some(pattern)) if (1..=tracks).contains(&pattern.into()) => {
            Ok(Some(usize::from(pattern) - 1))
        }
        (Format::Sequential, _) => {
            Err(format!("a MIDI file of type 2, whose tracks are patterns: expected --pattern 1 to {tracks}"))
        }
        (_, Some(_)) => {
            Err("only files of type 2 have patterns, and this is none: expected it without --pattern".to_owned())
        }
        (_, None) => Ok(None),
    }
}

#[cfg(test)]
mod tests;
