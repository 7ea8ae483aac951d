//! Songs: events in order of time, from a MIDI file or from a chord.

use crate::engine::banks::Banks;
use crate::engine::{Event, EventKind, NoteId};

/// An event of a song.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SongEvent {
    /// Seconds from the start of the song.
    pub seconds: f64,
    /// MIDI channel, 0–15.
    pub channel: u8,
    /// The event.
    pub kind: EventKind,
}

impl SongEvent {
    /// The nearest frame at this sample rate in Hz.
    pub fn frame(&self, sample_rate: f64) -> u64 {
        frames(self.seconds, sample_rate)
    }

    /// The event, at a frame of a block.
    pub(crate) fn at(&self, frame: u32) -> Event {
        Event { frame, channel: self.channel, kind: self.kind }
    }
}

/// The number of frames nearest to a time in seconds, limited to the range of `u64`.
pub(crate) fn frames(seconds: f64, sample_rate: f64) -> u64 {
    (seconds * sample_rate).round() as u64
}

/// Events in order of time, and the length of the song.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Song {
    /// In order of time. Events at the same time are in the order of tracks, and of events in a track.
    pub events: Vec<SongEvent>,
    /// Length in seconds: the time of the last event, end-of-track marks included.
    pub seconds: f64,
}

impl Song {
    /// Notes that start together and are released together at the end. `keys` are fractional MIDI keys, and may be
    /// outside the keyboard. Each note takes the nearest key from 0 to 127 that no earlier note has, so that no note
    /// strikes the voice of another; the remaining distance becomes its detune. With more than 128 notes, keys are
    /// shared.
    pub fn chord(keys: &[f64], velocity: f32, seconds: f64) -> Self {
        let mut taken = [false; 128];
        let mut nearest_free = |key: f64| {
            let distance = |candidate: &u8| (f64::from(*candidate) - key).abs();
            let free = (0..128u8).filter(|candidate| !taken[usize::from(*candidate)]);
            let nearest =
                free.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(key.clamp(0.0, 127.0) as u8);
            taken[usize::from(nearest)] = true;
            nearest
        };
        let event = |seconds, kind| SongEvent { seconds, channel: 0, kind };
        let (mut on, mut off) = (Vec::new(), Vec::new());
        for (&pitch, id) in keys.iter().zip((0..).map(NoteId::new)) {
            let key = nearest_free(pitch);
            let detune = (pitch - f64::from(key)) as f32;
            on.push(event(0.0, EventKind::NoteOn { key, detune, velocity, id }));
            off.push(event(seconds, EventKind::NoteOff { key, velocity: 0.5, id }));
        }
        on.extend(off);
        Self { events: on, seconds }
    }

    /// Converts program changes, by bank, to places in a list of melodic sounds and drum kits: see `Banks`.
    pub fn select_by_bank(&mut self) {
        let mut banks = Banks::default();
        self.events.iter_mut().for_each(|event| event.kind = banks.resolve(event.channel, event.kind));
    }

    /// Ends the song at a time in seconds, if it is longer. Events from there on are left out.
    pub(crate) fn end_at(&mut self, seconds: f64) {
        self.seconds = self.seconds.min(seconds);
        self.events.truncate(self.events.partition_point(|event| event.seconds < seconds));
    }

    /// The song's length in frames.
    pub(crate) fn frames(&self, sample_rate: f64) -> u64 {
        frames(self.seconds, sample_rate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chord_is_struck_and_released_at_once() {
        let song = Song::chord(&[60.0, 69.25, 140.5, 60.25], 0.5, 2.0);
        // The nearest key of the last note is taken.
        let expected = [(60, 0.0, 0), (69, 0.25, 1), (127, 13.5, 2), (61, -0.75, 3)];
        assert_eq!(song.events.len(), 2 * expected.len());
        for ((on, off), (key, detune, id)) in song.events[..4].iter().zip(&song.events[4..]).zip(expected) {
            let id = NoteId::new(id);
            assert_eq!(
                *on,
                SongEvent { seconds: 0.0, channel: 0, kind: EventKind::NoteOn { key, detune, velocity: 0.5, id } }
            );
            assert_eq!(
                *off,
                SongEvent { seconds: 2.0, channel: 0, kind: EventKind::NoteOff { key, velocity: 0.5, id } }
            );
        }
        assert_eq!(song.frames(44_100.0), 88_200);
    }

    #[test]
    fn times_become_the_nearest_frame() {
        for (seconds, sample_rate, expected) in
            [(0.1, 44_100.0, 4410), (1.0 / 3.0, 48_000.0, 16_000), (0.00001, 48_000.0, 0), (1e300, 48_000.0, u64::MAX)]
        {
            assert_eq!(frames(seconds, sample_rate), expected);
        }
    }
}
