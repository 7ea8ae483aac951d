//! The song of a request: a MIDI file, read strictly or leniently, and what of it is played.

use crate::engine::EventKind;
use crate::engine::banks::DRUM_CHANNEL;
use crate::engine::midi::controller::PORTAMENTO_CONTROL;
use crate::engine::midi::seven_bits;
use crate::error::{Error, Result};
use crate::io::{Inputs, MidiFile, Reading, Song, SongEvent, SongTime};
use crate::text::counted;
use std::path::Path;

/// Maximum number of repairs that are reported one by one.
const MOST_REPAIRS: usize = 10;

/// How a song is read, and what of it is played.
#[derive(Clone, Debug)]
pub struct SongRequest {
    /// Whether to repair a MIDI file that strays from the standard.
    pub lenient: bool,
    /// Factor of the tempo, above 0.
    pub tempo: f64,
    /// Semitones by which the notes of all channels but that of drums are moved.
    pub transpose: i32,
    /// The channels, from 1, whose notes are played; all if there are none.
    pub solo: Vec<u8>,
    /// The channels, from 1, whose notes are left out.
    pub mute: Vec<u8>,
    /// Where the rendering begins; at the start if there is none. Seconds are those of the song as it is played.
    pub from: Option<SongTime>,
    /// Where the song ends; at its own end if there is none.
    pub to: Option<SongTime>,
    /// The pattern to play of a file of type 2, from 1.
    pub pattern: Option<u16>,
}

impl Default for SongRequest {
    fn default() -> Self {
        let [solo, mute] = [const { Vec::new() }; 2];
        Self { lenient: false, tempo: 1.0, transpose: 0, solo, mute, from: None, to: None, pattern: None }
    }
}

impl SongRequest {
    /// Reads the song; `-` is stdin. `warn` is called for each repair, and for notes that cannot be played.
    ///
    /// # Errors
    /// As [`Song::read`].
    pub fn read(&self, path: &Path, inputs: &mut Inputs, warn: &mut dyn FnMut(&str)) -> Result<Song> {
        self.read_part(path, inputs, warn).map(|(song, _)| song)
    }

    /// As [`SongRequest::read`]; also returns where the rendering begins, in seconds.
    pub(super) fn read_part(
        &self,
        path: &Path,
        inputs: &mut Inputs,
        warn: &mut dyn FnMut(&str),
    ) -> Result<(Song, f64)> {
        let MidiFile { mut song, places, .. } = if path == Path::new("-") {
            self.parse(inputs.stdin()?.lock(), "stdin", warn)?
        } else {
            self.parse(inputs.open(path)?, &path.display().to_string(), warn)?
        };
        self.select(&mut song);
        self.transpose(&mut song, warn);
        self.stretch(&mut song);
        let seconds = |option: &str, time: Option<SongTime>| match time {
            None => Ok(None),
            Some(SongTime::Seconds(seconds)) => Ok(Some(seconds)),
            Some(bar) => match places.seconds(bar) {
                Ok(seconds) => Ok(Some(seconds / self.tempo)),
                Err(message) => Err(Error::value(option, message)),
            },
        };
        let (from, to) = (seconds("--from", self.from)?.unwrap_or(0.0), seconds("--to", self.to)?);
        if let Some(to) = to {
            if to > song.seconds {
                warn(&format!("--to: the song ends before {to:.3} s, at {:.3} s", song.seconds));
            }
            song.end_at(to);
        }
        if from > 0.0 && from >= song.seconds {
            let message = format!("{from:.3} s is not before the end, at {:.3} s", song.seconds);
            return Err(Error::value("--from", message));
        }
        let is_strike = |event: &&SongEvent| matches!(event.kind, EventKind::NoteOn { .. });
        let last = song.events.iter().rfind(is_strike);
        if from > 0.0 && last.is_some_and(|last| last.seconds < from) {
            warn(&format!(
                "no note begins from {from:.3} s to {:.3} s: expected another part of the song",
                song.seconds
            ));
        }
        Ok((song, from))
    }

    /// Leaves out the notes of channels that are not to be heard. Their controllers stay, since MPE’s master channels have some for
    /// others.
    fn select(&self, song: &mut Song) {
        let is_heard = |channel: u8| {
            let number = channel + 1;
            (self.solo.is_empty() || self.solo.contains(&number)) && !self.mute.contains(&number)
        };
        song.events.retain(|event| !matches!(event.kind, EventKind::NoteOn { .. }) || is_heard(event.channel));
    }

    fn transpose(&self, song: &mut Song, warn: &mut dyn FnMut(&str)) {
        let mut beyond = 0;
        song.events.retain_mut(|event| {
            let by = if event.channel == DRUM_CHANNEL { 0 } else { self.transpose };
            let moved = |key: u8| u8::try_from(i32::from(key).saturating_add(by)).ok().filter(|key| *key < 128);
            let key = match &mut event.kind {
                EventKind::NoteOn { key, .. }
                | EventKind::NoteOff { key, .. }
                | EventKind::PolyPressure { key, .. } => key,
                EventKind::Tune { key, pitch, .. } => {
                    *pitch += by as f32;
                    key
                }
                // The key to glide from.
                EventKind::Control { controller: PORTAMENTO_CONTROL, value } => {
                    let there = moved(seven_bits(*value));
                    *value = there.map_or(*value, |key| f32::from(key) / 127.0);
                    return there.is_some();
                }
                _ => return true,
            };
            let Some(there) = moved(*key) else {
                beyond += usize::from(matches!(event.kind, EventKind::NoteOn { .. }));
                return false;
            };
            *key = there;
            true
        });
        if beyond > 0 {
            let notes = counted(beyond, "note");
            warn(&format!("--transpose {} takes {notes} beyond the keyboard: left out", self.transpose));
        }
    }

    fn stretch(&self, song: &mut Song) {
        for event in &mut song.events {
            event.seconds /= self.tempo;
            if let EventKind::Tempo(beats_per_minute) = &mut event.kind {
                *beats_per_minute *= self.tempo as f32;
            }
        }
        song.seconds /= self.tempo;
    }

    fn parse(&self, reader: impl std::io::Read, origin: &str, warn: &mut dyn FnMut(&str)) -> Result<MidiFile> {
        let file = MidiFile::read(reader, origin, Reading { lenient: self.lenient, pattern: self.pattern })?;
        for repair in file.repairs.iter().take(MOST_REPAIRS) {
            warn(&format!("{origin}: {repair}"));
        }
        if file.repairs.len() > MOST_REPAIRS {
            warn(&format!("{origin}: {} repairs more", file.repairs.len() - MOST_REPAIRS));
        }
        if let Some(unheeded) = &file.unheeded {
            warn(&format!("{origin}: {unheeded}"));
        }
        Ok(file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::SongEvent;

    #[test]
    fn tunings_and_keys_to_glide_from_move_with_the_notes() {
        let glide = |key: u8| EventKind::Control { controller: PORTAMENTO_CONTROL, value: f32::from(key) / 127.0 };
        let tune = |key, pitch| EventKind::Tune { key, pitch, sounding: false };
        let volume = EventKind::Control { controller: 7, value: 0.5 };
        for (channel, kind, moved) in [
            (0, tune(60, 60.5), Some(tune(67, 67.5))),
            (0, tune(121, 121.5), None),
            (0, glide(48), Some(glide(55))),
            (0, glide(121), None),
            (0, volume, Some(volume)),
            (DRUM_CHANNEL, glide(48), Some(glide(48))),
        ] {
            let event = |kind| SongEvent { seconds: 0.0, channel, kind };
            let mut song = Song { events: vec![event(kind)], seconds: 1.0 };
            let request = SongRequest { transpose: 7, ..SongRequest::default() };
            request.transpose(&mut song, &mut |message| panic!("{message}"));
            assert_eq!(song.events, Vec::from_iter(moved.map(event)));
        }
    }
}
