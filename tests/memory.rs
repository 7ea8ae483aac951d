//! Memory use of an ensemble.

use sprung::engine::{Ensemble, Synth};
use sprung::patch::Patch;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// An allocator that counts the allocated bytes.
struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);

// SAFETY: all calls go to the system's allocator; only the counter is added.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        HELD.fetch_add(layout.size(), Relaxed);
        // SAFETY: the caller fulfils the conditions of the system's allocator.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Bytes that are allocated while the result of `made` lives.
fn held<T>(made: impl FnOnce() -> T) -> usize {
    let before = HELD.load(Relaxed);
    let made = made();
    let held = HELD.load(Relaxed) - before;
    drop(made);
    held
}

/// Only one test in this program, so that no other allocates at the same time.
#[test]
fn an_ensemble_takes_less_than_16_megabytes() {
    let patch = Patch::default();
    let ensemble = held(|| Ensemble::new(48_000.0, 0, &patch, &[]));
    let synth = held(|| Synth::new(48_000.0, 0));
    println!("ensemble: {:.1} MB; synth: {:.1} MB", ensemble as f64 / 1e6, synth as f64 / 1e6);
    assert!(ensemble < 16_000_000, "{ensemble}");
    assert!(synth < ensemble, "{synth}");
}
