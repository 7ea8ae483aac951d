//! A song as it is played: its events by frame, from the start, as the offline renderer hands them out.

use super::player::MAX_BLOCK;
use crate::engine::Event;
use crate::io::Song;

/// Where in a song the playing is. Real-time safe after [`SongCursor::new`].
pub(super) struct SongCursor {
    song: Song,
    sample_rate: f64,
    next: usize,
    frame: u64,
    frames: u64,
}

impl SongCursor {
    /// At the start of a song.
    pub(super) fn new(song: Song, sample_rate: f64) -> Self {
        let frames = song.frames(sample_rate);
        Self { song, sample_rate, next: 0, frame: 0, frames }
    }

    /// Most events that fall into one block.
    pub(super) fn densest_block(&self) -> usize {
        let frame = |index: usize| self.song.events[index].frame(self.sample_rate);
        let (mut first, mut most) = (0, 0);
        for last in 0..self.song.events.len() {
            while frame(first).saturating_add(MAX_BLOCK as u64) <= frame(last) {
                first += 1;
            }
            most = most.max(last + 1 - first);
        }
        most
    }

    /// Appends the events of the next `frames`, at most [`MAX_BLOCK`], to `events`.
    pub(super) fn advance(&mut self, frames: usize, events: &mut Vec<Event>) {
        let end = self.frame.saturating_add(frames as u64);
        while let Some(event) = self.song.events.get(self.next) {
            let at = event.frame(self.sample_rate);
            if at >= end {
                break;
            }
            events.push(event.at(at.saturating_sub(self.frame) as u32));
            self.next += 1;
        }
        self.frame = end;
    }

    /// Plays no further.
    pub(super) fn halt(&mut self) {
        self.next = self.song.events.len();
        self.frames = self.frames.min(self.frame);
    }

    /// Whether the end has been reached.
    pub(super) fn is_over(&self) -> bool {
        self.frame >= self.frames && self.next == self.song.events.len()
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
        assert_eq!(cursor.densest_block(), 4);
        let mut events = Vec::new();
        cursor.advance(50, &mut events);
        cursor.halt();
        assert!(cursor.is_over());
        cursor.advance(1000, &mut events);
        assert_eq!(events.len(), 3);
        assert_eq!(SongCursor::new(Song::default(), 48_000.0).densest_block(), 0);
    }
}
