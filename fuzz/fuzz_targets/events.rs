//! Any patch and any stream of events: nothing panics, all that comes out is finite and within what the strikes bring.
//!
//! The case, its bound and the comparison are those of `tests/engine/storm`, which also replays this target's kept corpus.

#![no_main]

#[path = "../../tests/engine/storm/bound.rs"]
mod bound;
#[path = "../../tests/engine/storm/case.rs"]
mod case;
#[path = "../../tests/engine/storm/check.rs"]
mod check;
#[path = "../../tests/engine/storm/gains.rs"]
mod gains;
#[path = "../../tests/engine/storm/heard_by.rs"]
mod heard_by;
#[path = "../../tests/engine/storm/noise.rs"]
mod noise;
#[path = "../../tests/engine/storm/reach.rs"]
mod reach;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    if let Err(failure) = check::check(&case::decode(bytes)) {
        panic!("{failure}");
    }
});
