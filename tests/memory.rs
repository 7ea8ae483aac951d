//! What an ensemble holds in memory.

use sprung::engine::{Ensemble, Synth};
use sprung::patch::Patch;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Counts the bytes that are allocated.
struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);

// SAFETY: everything is the system's allocator's; the counter is beside it.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        HELD.fetch_add(layout.size(), Relaxed);
        // SAFETY: the caller's promises are those that it asks for.
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

/// Bytes that are held while `made` lives.
fn held<T>(made: impl FnOnce() -> T) -> usize {
    let before = HELD.load(Relaxed);
    let made = made();
    let held = HELD.load(Relaxed) - before;
    drop(made);
    held
}

/// One test, so that no other allocates beside it.
#[test]
fn an_ensemble_takes_less_than_16_megabytes() {
    let patch = Patch::default();
    let ensemble = held(|| Ensemble::new(48_000.0, 0, &patch, &[]));
    let synth = held(|| Synth::new(48_000.0, 0));
    println!("ensemble: {:.1} MB; synth: {:.1} MB", ensemble as f64 / 1e6, synth as f64 / 1e6);
    assert!(ensemble < 16_000_000, "{ensemble}");
    assert!(synth < ensemble, "{synth}");
}
