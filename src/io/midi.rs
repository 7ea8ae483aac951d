//! Standard MIDI Files (types 0 and 1) as songs: events in the order of their time.

use super::song::{Song, SongEvent};
use super::tempo::TempoMap;
use crate::engine::EventKind;
use crate::error::Error;
use midly::live::LiveEvent;
use midly::{Format, Header, MetaMessage, MidiMessage, PitchBend, TrackEventKind};
use std::io::Read;

/// Largest MIDI file that is read, in bytes.
pub const MAX_FILE_SIZE: u64 = 64 << 20;

/// Most events that a song can have: 32 bytes of memory each.
pub const MAX_EVENTS: usize = 8_000_000;

impl Song {
    /// Reads a MIDI file to its end. `origin` names it in errors.
    ///
    /// # Errors
    /// [`Error::Io`] if reading fails; [`Error::Format`] if there is more than [`MAX_FILE_SIZE`] or [`Song::parse`]
    /// refuses it.
    pub fn read(reader: impl Read, origin: &str) -> crate::Result<Self> {
        let mut bytes = Vec::new();
        reader.take(MAX_FILE_SIZE + 1).read_to_end(&mut bytes).map_err(|source| Error::io(origin, source))?;
        if bytes.len() as u64 > MAX_FILE_SIZE {
            let limit = MAX_FILE_SIZE >> 20;
            return Err(Error::format(origin, format!("too large for a MIDI file: expected at most {limit} MiB")));
        }
        Self::parse(&bytes, origin)
    }

    /// Reads the bytes of a MIDI file of type 0 or 1. `origin` names it in errors.
    ///
    /// Reading is strict: a file that breaks off or strays from the standard is an error that names the track,
    /// instead of a song that silently misses notes. Two liberties are granted, because nothing is lost by them:
    /// tracks may lack their end mark, and whatever follows the declared number of tracks is not looked at.
    ///
    /// # Errors
    /// [`Error::Format`].
    pub fn parse(bytes: &[u8], origin: &str) -> crate::Result<Self> {
        parse(bytes).map_err(|message| Error::format(origin, message))
    }
}

fn parse(bytes: &[u8]) -> Result<Song, String> {
    // A division of 0x80xx would overflow inside midly, which negates that byte as an i8.
    if bytes.windows(13).any(|window| window.starts_with(b"MThd") && window[12] == 0x80) {
        return Err("not a valid MIDI file: expected 24, 25, 29 or 30 SMPTE frames per second, found 128".to_owned());
    }
    let invalid = |error: midly::Error| format!("not a valid MIDI file: {}", error.kind().message());
    let (header, tracks) = midly::parse(bytes).map_err(invalid)?;
    let Header { format, timing } = header;
    if format == Format::Sequential {
        return Err("a MIDI file of type 2 (independent patterns): expected type 0 or 1".to_owned());
    }
    let declared = tracks.size_hint().0;
    let mut reader = TrackReader::default();
    let mut found = 0;
    for track in tracks.take(declared) {
        found += 1;
        let track = track.map_err(|error| {
            let reason = error.kind().message();
            format!("not a whole MIDI file: track {found} of {declared} is cut off or damaged ({reason})")
        })?;
        reader.track(track).map_err(|message| format!("track {found}: {message}"))?;
    }
    if found < declared || declared == 0 {
        return Err(format!("not a whole MIDI file: it declares {declared} tracks and has {found}"));
    }
    let TrackReader { mut events, mut tempos, last_tick } = reader;
    // Stable sorts: at one tick, the order of tracks and of events in them stays, after the tempo.
    tempos.sort_by_key(|(tick, _)| *tick);
    let beats_per_minute = |tempo: u32| (6e7 / f64::from(tempo)) as f32;
    let told = tempos.iter().map(|(tick, tempo)| (*tick, 0, EventKind::Tempo(beats_per_minute(*tempo))));
    events.splice(..0, told);
    events.sort_by_key(|(tick, ..)| *tick);
    let map = TempoMap::new(timing, &tempos)?;
    let timed = |(tick, channel, kind)| SongEvent { seconds: map.seconds(tick), channel, kind };
    Ok(Song { events: events.into_iter().map(timed).collect(), seconds: map.seconds(last_tick) })
}

/// What the tracks so far have in them, by tick.
#[derive(Default)]
struct TrackReader {
    events: Vec<(u64, u8, EventKind)>,
    tempos: Vec<(u64, u32)>,
    last_tick: u64,
}

impl TrackReader {
    fn track(&mut self, events: midly::EventIter) -> Result<(), String> {
        let mut tick = 0u64;
        for (index, event) in events.enumerate() {
            let event = event.map_err(|_| {
                format!("event {} (after tick {tick}) is malformed or the file breaks off in it", index + 1)
            })?;
            tick += u64::from(event.delta.as_int());
            self.last_tick = self.last_tick.max(tick);
            match event.kind {
                TrackEventKind::Midi { channel, message } => {
                    self.events.push((tick, channel.as_int(), translate(message)));
                }
                TrackEventKind::Meta(MetaMessage::Tempo(tempo)) => self.tempos.push((tick, tempo.as_int())),
                TrackEventKind::Meta(MetaMessage::EndOfTrack) => break,
                _ => {}
            }
            if self.events.len() + self.tempos.len() > MAX_EVENTS {
                return Err(format!("too many events: expected at most {MAX_EVENTS} in the file"));
            }
        }
        Ok(())
    }
}

/// The channel and event of one complete MIDI message, as a port delivers them; none for what is not a channel
/// message. Real-time safe.
pub fn parse_message(bytes: &[u8]) -> Option<(u8, EventKind)> {
    match LiveEvent::parse(bytes) {
        Ok(LiveEvent::Midi { channel, message }) => Some((channel.as_int(), translate(message))),
        _ => None,
    }
}

fn translate(message: MidiMessage) -> EventKind {
    let unit = |value: midly::num::u7| f32::from(value.as_int()) / 127.0;
    match message {
        // A note-on of velocity 0 is a note-off whose velocity the controller does not tell (MIDI 1.0).
        MidiMessage::NoteOn { key, vel } if vel == 0 => EventKind::NoteOff { key: key.as_int(), velocity: 0.5, id: -1 },
        MidiMessage::NoteOn { key, vel } => {
            EventKind::NoteOn { key: key.as_int(), detune: 0.0, velocity: unit(vel), id: -1 }
        }
        MidiMessage::NoteOff { key, vel } => EventKind::NoteOff { key: key.as_int(), velocity: unit(vel), id: -1 },
        MidiMessage::Aftertouch { key, vel } => EventKind::PolyPressure { key: key.as_int(), pressure: unit(vel) },
        MidiMessage::ChannelAftertouch { vel } => EventKind::ChannelPressure(unit(vel)),
        MidiMessage::Controller { controller, value } => {
            EventKind::Control { controller: controller.as_int(), value: unit(value) }
        }
        MidiMessage::ProgramChange { program } => EventKind::Program(program.as_int()),
        MidiMessage::PitchBend { bend } => EventKind::PitchBend(bend_position(bend)),
    }
}

/// −8192…8191 as −1…1: both ends and the centre are exact, so the upper half has steps of its own.
fn bend_position(bend: PitchBend) -> f32 {
    let steps = f32::from(bend.as_int());
    if steps < 0.0 { steps / 8192.0 } else { steps / 8191.0 }
}

#[cfg(test)]
mod tests;
