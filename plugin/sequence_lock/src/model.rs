//! The lock under loom, which tries every order of loads and stores that the memory model allows.

use crate::SequenceLock;
use loom::model::Builder;
use loom::sync::atomic::{AtomicU32, Ordering};
use loom::sync::{Arc, Mutex};
use loom::thread;

/// A lock of two words, and a knob that is written with them; both are the number of the writing.
#[derive(Default)]
struct Shared {
    lock: SequenceLock<2>,
    knob: AtomicU32,
    /// Number of the last writing; held while it is written.
    writer: Mutex<u32>,
}

impl Shared {
    fn write(&self) {
        let mut number = self.writer.lock().unwrap();
        *number += 1;
        self.lock.write([*number; 2], || self.knob.store(*number, Ordering::Relaxed));
    }

    /// Knob first or last, as no order among them is promised.
    fn read(&self, knob_first: bool) -> Option<(u32, Vec<u32>)> {
        self.lock.read(|generation| {
            let knob = || self.knob.load(Ordering::Relaxed);
            let first = knob_first.then(knob);
            let mut numbers: Vec<u32> = self.lock.words().collect();
            numbers.push(first.unwrap_or_else(knob));
            (generation, numbers)
        })
    }
}

/// What is read is of one writing: the one that the generation counts.
fn assert_whole((generation, numbers): (u32, Vec<u32>)) {
    assert_eq!(numbers, [generation / 2; 3], "generation {generation}");
}

/// Tries every order in which threads are switched up to so many times where they need not be.
fn check(switches: usize, run: impl Fn() + Sync + Send + 'static) {
    let mut builder = Builder::new();
    builder.preemption_bound = Some(switches);
    builder.check(run);
}

#[test]
fn what_is_written_is_read_and_the_rest_stays() {
    check(3, || {
        let lock = SequenceLock::<3>::default();
        let read = || lock.read(|generation| (generation, lock.words().collect::<Vec<_>>()));
        assert_eq!(read(), Some((0, vec![0, 0, 0])));
        lock.write([1, 2, 3, 4], || assert_eq!(read(), None, "nothing is read while it is written"));
        assert_eq!(read(), Some((2, vec![1, 2, 3])));
        lock.write([5], || {});
        assert_eq!(read(), Some((4, vec![5, 2, 3])));
    });
}

#[test]
fn the_generation_may_overflow() {
    check(3, || {
        let lock = SequenceLock::<1>::default();
        lock.generation.store(u32::MAX - 1, Ordering::Relaxed);
        lock.write([7], || assert_eq!(lock.read(|_| ()), None));
        assert_eq!(lock.read(|generation| (generation, lock.words().next())), Some((0, Some(7))));
    });
}

#[test]
fn a_reader_gets_one_whole_writing_or_none() {
    for knob_first in [false, true] {
        check(3, move || {
            let shared = Arc::new(Shared::default());
            let writing = shared.clone();
            let writer = thread::spawn(move || {
                writing.write();
                writing.write();
            });
            if let Some(read) = shared.read(knob_first) {
                assert_whole(read);
            }
            writer.join().unwrap();
            assert_eq!(shared.read(knob_first), Some((4, vec![2; 3])), "the last writing, once it is over");
        });
    }
}

#[test]
fn generations_never_go_back() {
    check(3, || {
        let shared = Arc::new(Shared::default());
        let writing = shared.clone();
        let writer = thread::spawn(move || writing.write());
        let read = [shared.read(false), shared.read(false)];
        let generations: Vec<u32> = read.iter().flatten().map(|(generation, _)| *generation).collect();
        assert!(generations.is_sorted(), "{generations:?}");
        read.into_iter().flatten().for_each(assert_whole);
        writer.join().unwrap();
    });
}

#[test]
fn writers_in_turn_and_two_readers_do_no_harm() {
    check(2, || {
        let shared = Arc::new(Shared::default());
        let threads = [true, false].map(|writes| {
            let shared = shared.clone();
            thread::spawn(
                move || if writes { shared.write() } else { shared.read(false).into_iter().for_each(assert_whole) },
            )
        });
        shared.write();
        shared.read(true).into_iter().for_each(assert_whole);
        threads.into_iter().for_each(|thread| thread.join().unwrap());
        assert_eq!(shared.read(false), Some((4, vec![2; 3])));
    });
}

/// The model finds what the lock is there for: words that are read without it are mixed.
#[test]
#[should_panic(expected = "mixed")]
fn words_without_the_lock_are_mixed() {
    check(3, || {
        let shared = Arc::new(Shared::default());
        let writing = shared.clone();
        let writer = thread::spawn(move || writing.write());
        let words: Vec<u32> = shared.lock.words().collect();
        assert_eq!(words[0], words[1], "mixed");
        writer.join().unwrap();
    });
}
