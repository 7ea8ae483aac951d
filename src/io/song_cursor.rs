//! The position in a song that is being played: it gives each block's events with their frames.

use super::song::Song;
use crate::engine::Event;
use std::borrow::Borrow;

/// After the end of a song, silence is checked at multiples of this number of frames: often enough for an exact end,
/// and at frames that do not depend on the block size.
pub const SILENCE_INTERVAL: u64 = 64;

/// A position in a song, which may be owned or borrowed. Real-time safe after [`SongCursor::new`].
#[derive(Clone, Debug)]
pub struct SongCursor<S> {
    song: S,
    sample_rate: f64,
    next: usize,
    frame: u64,
    song_frames: u64,
}

impl<S: Borrow<Song>> SongCursor<S> {
    /// The start of a song, at a sample rate in Hz.
    pub fn new(song: S, sample_rate: f64) -> Self {
        let song_frames = song.borrow().frames(sample_rate);
        Self { song, sample_rate, next: 0, frame: 0, song_frames }
    }

    /// Frames since the start of the song.
    pub fn frame(&self) -> u64 {
        self.frame
    }

    /// Length of the song in frames; after [`SongCursor::halt`], the length up to that point.
    pub fn song_frames(&self) -> u64 {
        self.song_frames
    }

    /// The largest number of events in any block of at most `frames` frames. Takes time in proportion to the number of
    /// events.
    pub fn densest_block(&self, frames: usize) -> usize {
        let events = &self.song.borrow().events;
        let frame = |index: usize| events[index].frame(self.sample_rate);
        let (mut first, mut most) = (0, 0);
        for last in 0..events.len() {
            while frame(first).saturating_add(frames as u64) <= frame(last) {
                first += 1;
            }
            most = most.max(last + 1 - first);
        }
        most
    }

    /// Appends the events of the next `frames` frames to `events`. Allocates only if `events` has not enough room.
    pub fn advance(&mut self, frames: usize, events: &mut Vec<Event>) {
        let end = self.frame.saturating_add(frames as u64);
        while let Some(event) = self.song.borrow().events.get(self.next) {
            let at = event.frame(self.sample_rate);
            if at >= end {
                break;
            }
            events.push(event.at(at.saturating_sub(self.frame) as u32));
            self.next += 1;
        }
        self.frame = end;
    }

    /// Ends the song at the present position.
    pub fn halt(&mut self) {
        self.next = self.song.borrow().events.len();
        self.song_frames = self.song_frames.min(self.frame);
    }

    /// Whether the end was reached and all events were returned.
    pub fn is_over(&self) -> bool {
        self.frame >= self.song_frames && self.next == self.song.borrow().events.len()
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
        assert_eq!((cursor.densest_block(4096), cursor.densest_block(48)), (4, 3));
        let mut events = Vec::new();
        cursor.advance(50, &mut events);
        cursor.halt();
        assert!(cursor.is_over());
        cursor.advance(1000, &mut events);
        assert_eq!(events.len(), 3);
        assert_eq!(SongCursor::new(Song::default(), 48_000.0).densest_block(4096), 0);
    }
}
