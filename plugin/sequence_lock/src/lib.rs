//! A sequence lock: words that one thread at a time writes, and that any thread reads whole or not at all.
//!
//! A writer makes the generation odd, writes, and makes it even again. A reader that finds the generation odd, or
//! changed after it has read, takes nothing. Readers never wait, and nothing is allocated. The words are atomics, so
//! that a read that a write overlaps is discarded and not undefined.
//!
//! The orderings are those of H.-J. Boehm, "Can Seqlocks Get Along With Programming Language Memory Models?", MSPC 2012,
//! section 4: relaxed words between a release fence and a release store, and between an acquire load and an acquire
//! fence.

#[cfg(all(test, loom))]
mod model;

#[cfg(all(test, loom))]
use loom::sync::atomic::{AtomicU32, Ordering, fence};
use std::array::from_fn;
#[cfg(not(all(test, loom)))]
use std::sync::atomic::{AtomicU32, Ordering, fence};

/// `WORDS` words of one writing.
#[derive(Debug)]
pub struct SequenceLock<const WORDS: usize> {
    generation: AtomicU32,
    words: [AtomicU32; WORDS],
}

impl<const WORDS: usize> Default for SequenceLock<WORDS> {
    fn default() -> Self {
        Self { generation: AtomicU32::new(0), words: from_fn(|_| AtomicU32::new(0)) }
    }
}

impl<const WORDS: usize> SequenceLock<WORDS> {
    /// Writes as many of `words` as there is room for, from the first word on; the words beyond keep what they hold.
    /// Runs `meanwhile` before readers may read again: what it stores in atomics of the caller's, a reader finds
    /// within [`SequenceLock::read`] together with the words.
    ///
    /// One thread at a time may write: the caller holds a lock of its own.
    pub fn write(&self, words: impl IntoIterator<Item = u32>, meanwhile: impl FnOnce()) {
        let generation = self.generation.load(Ordering::Relaxed);
        self.generation.store(generation.wrapping_add(1), Ordering::Relaxed);
        fence(Ordering::Release);
        for (word, bits) in self.words.iter().zip(words) {
            word.store(bits, Ordering::Relaxed);
        }
        meanwhile();
        self.generation.store(generation.wrapping_add(2), Ordering::Release);
    }

    /// Runs `read` and gives what it gave, unless a writer was at work meanwhile; `read` is told the generation, which
    /// is another one after each writing. Real-time safe if `read` is.
    pub fn read<T>(&self, read: impl FnOnce(u32) -> T) -> Option<T> {
        let generation = self.generation.load(Ordering::Acquire);
        if !generation.is_multiple_of(2) {
            return None;
        }
        let result = read(generation);
        fence(Ordering::Acquire);
        (self.generation.load(Ordering::Relaxed) == generation).then_some(result)
    }

    /// The words, from the first. They are of one writing only within [`SequenceLock::read`], or while the caller keeps
    /// others from writing. Real-time safe.
    pub fn words(&self) -> impl Iterator<Item = u32> {
        self.words.iter().map(|word| word.load(Ordering::Relaxed))
    }
}
