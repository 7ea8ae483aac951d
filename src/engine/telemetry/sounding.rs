//! The sounding notes, written by the audio thread and read by a display without locks.

use crate::engine::atomic::AtomicF32;
use crate::engine::snapshot::{SHOWN_NOTES, SoundingNote};
use crate::params::{PARAMS, Param};
use crate::patch::routes::{MAX_ROUTES, Source};
use std::sync::atomic::Ordering::{Acquire, Relaxed, Release};
use std::sync::atomic::{AtomicU32, AtomicU64, fence};

/// How often a reader tries to read without a write at the same time.
const TRIES: usize = 4;

/// The notes with a sequence number that is odd during a write. If the number differs before and after a reading, the
/// reader may have mixed two writes, and reads again. Only one thread may write.
#[derive(Default)]
pub(super) struct Sounding {
    sequence: AtomicU32,
    notes: [Cell; SHOWN_NOTES],
}

/// One place for a note, which may be empty.
#[derive(Default)]
struct Cell {
    /// Channel and key plus 1; 0 for none.
    key: AtomicU32,
    velocity: AtomicF32,
    pitch: AtomicF32,
    age: AtomicF32,
    /// The number of the parameter plus 1, and below it the bits of its value; 0 for none.
    moved: [AtomicU64; MAX_ROUTES],
    sources: [AtomicF32; Source::ALL.len()],
    progress: [AtomicF32; 5],
}

impl Sounding {
    /// Real-time safe.
    pub(super) fn write(&self, notes: &[Option<SoundingNote>; SHOWN_NOTES]) {
        let sequence = self.sequence.load(Relaxed);
        self.sequence.store(sequence.wrapping_add(1), Relaxed);
        fence(Release);
        for (cell, note) in self.notes.iter().zip(notes) {
            cell.write(note.as_ref());
        }
        self.sequence.store(sequence.wrapping_add(2), Release);
    }

    /// The notes of the last write; no notes if each try coincided with a write.
    pub(super) fn read(&self) -> [Option<SoundingNote>; SHOWN_NOTES] {
        (0..TRIES).find_map(|_| self.try_to_read()).unwrap_or([None; SHOWN_NOTES])
    }

    /// None if a write took place at the same time.
    fn try_to_read(&self) -> Option<[Option<SoundingNote>; SHOWN_NOTES]> {
        let before = self.sequence.load(Acquire);
        let notes = self.notes.each_ref().map(Cell::read);
        fence(Acquire);
        (before.is_multiple_of(2) && self.sequence.load(Relaxed) == before).then_some(notes)
    }
}

impl Cell {
    fn write(&self, note: Option<&SoundingNote>) {
        let Some(note) = note else {
            self.key.store(0, Relaxed);
            return;
        };
        self.key.store(1 + u32::from(note.key) + (u32::from(note.channel) << 8), Relaxed);
        self.velocity.store(note.velocity);
        self.pitch.store(note.pitch);
        self.age.store(note.age);
        for (cell, moved) in self.moved.iter().zip(note.moved) {
            let packed = |(param, value): (Param, f32)| (1 + param as u64) << 32 | u64::from(value.to_bits());
            cell.store(moved.map_or(0, packed), Relaxed);
        }
        self.sources.iter().zip(note.sources).for_each(|(cell, value)| cell.store(value));
        self.progress.iter().zip(note.progress).for_each(|(cell, value)| cell.store(value));
    }

    fn read(&self) -> Option<SoundingNote> {
        let key = self.key.load(Relaxed).checked_sub(1)?;
        let moved = self.moved.each_ref().map(|cell| {
            let packed = cell.load(Relaxed);
            let param = PARAMS.get((packed >> 32).checked_sub(1)? as usize)?.param;
            Some((param, f32::from_bits(packed as u32)))
        });
        let (channel, key) = ((key >> 8) as u8, key as u8);
        let (velocity, pitch, age) = (self.velocity.load(), self.pitch.load(), self.age.load());
        let (sources, progress) =
            (self.sources.each_ref().map(AtomicF32::load), self.progress.each_ref().map(AtomicF32::load));
        Some(SoundingNote { channel, key, velocity, pitch, age, moved, sources, progress })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;

    /// Notes whose every number is the same.
    fn notes(number: u8) -> [Option<SoundingNote>; SHOWN_NOTES] {
        let value = f32::from(number);
        let moved = std::array::from_fn(|_| Some((PARAMS[usize::from(number)].param, value)));
        let (sources, progress) = ([value; Source::ALL.len()], [value; 5]);
        let (channel, key, velocity, pitch, age) = (number % 16, number, value, value, value);
        let note = SoundingNote { channel, key, velocity, pitch, age, moved, sources, progress };
        [Some(note); SHOWN_NOTES]
    }

    #[test]
    fn what_is_written_is_read() {
        let sounding = Sounding::default();
        assert_eq!(sounding.read(), [None; SHOWN_NOTES]);
        let mut some = notes(0);
        (some[1], some[0]) = (None, notes(100)[0]);
        some[0].as_mut().unwrap().moved[3] = None;
        sounding.write(&some);
        assert_eq!(sounding.read(), some);
    }

    #[test]
    fn a_reader_sees_the_notes_of_one_write() {
        let (sounding, is_over) = (Arc::new(Sounding::default()), Arc::new(AtomicBool::new(false)));
        let writer = {
            let (sounding, is_over) = (sounding.clone(), is_over.clone());
            std::thread::spawn(move || {
                let mut written = 0_u32;
                while !is_over.load(Relaxed) {
                    sounding.write(&notes((written % 100) as u8));
                    written += 1;
                    // At the low rate of a display, so that a reader can succeed, but at any time during a reading.
                    (0..written % 4096).for_each(|_| std::hint::spin_loop());
                }
            })
        };
        let mut found = std::collections::BTreeSet::new();
        let (start, mut reads) = (std::time::Instant::now(), 0);
        // On a busy machine the writer may start late.
        while (reads < 20_000 || found.len() < 2) && start.elapsed().as_secs() < 60 {
            reads += 1;
            let Some(read) = sounding.try_to_read() else { continue };
            let Some(first) = read[0] else { continue };
            assert_eq!(read, notes(first.key), "parts of two");
            found.insert(first.key);
        }
        is_over.store(true, Relaxed);
        writer.join().unwrap();
        assert!(found.len() > 1, "{found:?}");
    }
}
