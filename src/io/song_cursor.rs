//! The position in a song: each block's events with their frames, and at the end those that let go of what is down.

use super::song::Song;
use crate::engine::midi::controller::ALL_NOTES_OFF;
use crate::engine::pressed::Pressed;
use crate::engine::{Event, EventKind};
use std::borrow::Borrow;

/// After the end of a song, silence is checked at multiples of this number of frames: often enough for an exact end,
/// and at frames that do not depend on the block size.
pub(crate) const SILENCE_INTERVAL: u64 = 64;

/// Most events at the end of a song that let go of keys and pedals: all notes off and three pedals on each channel.
const MOST_LET_GO: usize = 16 * 4;

/// A position in a song, which may be owned or borrowed. Real-time safe after [`SongCursor::new`].
///
/// When the song ends, keys and pedals that it has left down are let go of, as a player's hands and feet would: otherwise an
/// organ's last key sounds for as long as the organ can.
#[derive(Clone, Debug)]
pub(crate) struct SongCursor<S> {
    song: S,
    sample_rate: f64,
    next: usize,
    frame: u64,
    song_frames: u64,
    /// What the song holds down now.
    pressed: Pressed,
}

impl<S: Borrow<Song>> SongCursor<S> {
    /// The start of a song, at a sample rate in Hz.
    pub(crate) fn new(song: S, sample_rate: f64) -> Self {
        let song_frames = song.borrow().frames(sample_rate);
        Self { song, sample_rate, next: 0, frame: 0, song_frames, pressed: Pressed::default() }
    }

    /// Frames since the start of the song.
    pub(crate) fn frame(&self) -> u64 {
        self.frame
    }

    /// Length of the song in frames; after [`SongCursor::halt`], the length up to that point.
    pub(crate) fn song_frames(&self) -> u64 {
        self.song_frames
    }

    /// An upper bound of the number of events in any block of at most `frames` frames. Takes time in proportion to the number
    /// of events.
    pub(crate) fn densest_block(&self, frames: usize) -> usize {
        let events = &self.song.borrow().events;
        let frame = |index: usize| events[index].frame(self.sample_rate);
        let (mut first, mut most) = (0, 0);
        for last in 0..events.len() {
            while frame(first).saturating_add(frames as u64) <= frame(last) {
                first += 1;
            }
            most = most.max(last + 1 - first);
        }
        most + if events.is_empty() { 0 } else { MOST_LET_GO }
    }

    /// Appends the events of the next `frames` frames to `events`. Allocates only if `events` has not enough room.
    pub(crate) fn advance(&mut self, frames: usize, events: &mut Vec<Event>) {
        let end = self.frame.saturating_add(frames as u64);
        while let Some(event) = self.song.borrow().events.get(self.next) {
            let at = event.frame(self.sample_rate);
            if at >= end {
                break;
            }
            events.push(event.at(at.saturating_sub(self.frame) as u32));
            self.pressed.follow(event.channel, &event.kind);
            self.next += 1;
        }
        if self.song_frames < end && self.next == self.song.borrow().events.len() && !self.pressed.is_none() {
            self.let_go(events);
        }
        self.frame = end;
    }

    /// Appends events that let go of everything that is down: at the end of the song, but after its last event, and now if that
    /// has passed.
    fn let_go(&mut self, events: &mut Vec<Event>) {
        let last = events.last().map_or(0, |event| event.frame);
        let frame = last.max(self.song_frames.saturating_sub(self.frame) as u32);
        for channel in 0..16 {
            // Not key by key: a monophonic voice would glide from each to the next.
            let keys = self.pressed.keys(channel).next().map(|_| ALL_NOTES_OFF);
            for controller in keys.into_iter().chain(self.pressed.pedals(channel)) {
                events.push(Event { frame, channel, kind: EventKind::Control { controller, value: 0.0 } });
            }
        }
        self.pressed = Pressed::default();
    }

    /// Ends the song at the present position. The next call of [`SongCursor::advance`] lets go of what is down.
    pub(crate) fn halt(&mut self) {
        self.next = self.song.borrow().events.len();
        self.song_frames = self.song_frames.min(self.frame);
    }

    /// Whether the end was reached, all events were returned, and nothing is down.
    pub(crate) fn is_over(&self) -> bool {
        self.frame >= self.song_frames && self.next == self.song.borrow().events.len() && self.pressed.is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::EventKind;
    use crate::io::SongEvent;

    fn song() -> Song {
        let event = |seconds: f64| SongEvent { seconds, channel: 0, kind: EventKind::Program(0) };
        Song { events: [0.0, 0.001, 0.001, 0.0015, 0.5].map(event).to_vec(), seconds: 0.75 }
    }

    #[test]
    fn events_come_at_their_frames_in_any_division() {
        for block in [1, 7, 24, 1000] {
            let mut cursor = SongCursor::new(song(), 48_000.0);
            let (mut found, mut start) = (Vec::new(), 0);
            while !cursor.is_over() {
                let mut events = Vec::new();
                cursor.advance(block, &mut events);
                found.extend(events.iter().map(|event| start + event.frame as usize));
                start += block;
            }
            assert_eq!(found, [0, 48, 48, 72, 24_000], "{block}");
            assert_eq!(start, 36_000_usize.next_multiple_of(block), "{block}");
        }
    }

    #[test]
    fn the_densest_block_is_known_and_a_halt_is_an_end() {
        let mut cursor = SongCursor::new(song(), 48_000.0);
        assert_eq!((cursor.densest_block(4096), cursor.densest_block(48)), (4 + MOST_LET_GO, 3 + MOST_LET_GO));
        let mut events = Vec::new();
        cursor.advance(50, &mut events);
        cursor.halt();
        assert!(cursor.is_over());
        cursor.advance(1000, &mut events);
        assert_eq!(events.len(), 3);
        assert_eq!(SongCursor::new(Song::default(), 48_000.0).densest_block(4096), 0);
    }

    /// What a song has down at its end, and before: on channels 1, 2, 3 and 16.
    fn left_down() -> Song {
        let on = |key| EventKind::NoteOn { key, detune: 0.0, velocity: 1.0, id: None };
        let control = |controller| EventKind::Control { controller, value: 1.0 };
        let events = [
            (0.0, 0, on(60)),
            (0.0, 1, control(64)),
            (0.0, 2, on(60)),
            (0.0, 15, on(1)),
            (0.001, 15, on(2)),
            (0.001, 15, control(66)),
            (0.001, 15, control(67)),
            (0.002, 2, EventKind::NoteOff { key: 60, velocity: 0.5, id: None }),
        ];
        let events = events.map(|(seconds, channel, kind)| SongEvent { seconds, channel, kind });
        Song { events: events.to_vec(), seconds: 0.01 }
    }

    #[test]
    fn keys_and_pedals_that_are_down_at_the_end_are_let_go_of() {
        for block in [1, 7, 96, 480, 1000] {
            let mut cursor = SongCursor::new(left_down(), 48_000.0);
            let mut found = Vec::new();
            while !cursor.is_over() {
                let (start, mut events) = (cursor.frame(), Vec::new());
                cursor.advance(block, &mut events);
                assert!(events.len() <= cursor.densest_block(block));
                found.extend(events.iter().map(|event| (start + u64::from(event.frame), event.channel, event.kind)));
            }
            let up = |(channel, controller)| (480, channel, EventKind::Control { controller, value: 0.0 });
            assert_eq!(found[8..], [(0, 123), (1, 64), (15, 123), (15, 66), (15, 67)].map(up), "{block}");
        }
    }

    #[test]
    fn a_song_that_is_halted_lets_go_of_what_is_down_then() {
        let mut cursor = SongCursor::new(left_down(), 48_000.0);
        let mut events = Vec::new();
        cursor.advance(10, &mut events);
        cursor.halt();
        assert!(!cursor.is_over());
        events.clear();
        cursor.advance(10, &mut events);
        assert!(cursor.is_over());
        let up =
            |(channel, controller)| Event { frame: 0, channel, kind: EventKind::Control { controller, value: 0.0 } };
        assert_eq!(events, [(0, 123), (1, 64), (2, 123), (15, 123)].map(up));
    }

    #[test]
    fn a_song_that_ends_with_nothing_down_has_no_further_events() {
        let mut song = left_down();
        song.events.truncate(1);
        song.events.push(SongEvent {
            seconds: 0.01,
            channel: 0,
            kind: EventKind::NoteOff { key: 60, velocity: 0.5, id: None },
        });
        let mut cursor = SongCursor::new(&song, 48_000.0);
        let mut events = Vec::new();
        cursor.advance(1000, &mut events);
        assert!(cursor.is_over() && events.len() == 2);
    }
}
