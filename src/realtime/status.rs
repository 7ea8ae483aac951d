//! What the device and the song are at, between threads and without locks.

use crate::engine::Telemetry;
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64};

/// What the audio thread tells, and is told. Writing and reading are real-time safe.
#[derive(Default)]
pub struct Status {
    telemetry: Arc<Telemetry>,
    xruns: AtomicU64,
    /// Bits of a float.
    delay: AtomicU32,
    song_over: AtomicBool,
    song_halted: AtomicBool,
}

impl Status {
    /// What sounds, and how the audio thread keeps up.
    pub fn telemetry(&self) -> &Arc<Telemetry> {
        &self.telemetry
    }

    /// Times that the device says it ran dry.
    pub fn xruns(&self) -> u64 {
        self.xruns.load(Relaxed)
    }

    /// Seconds from an event's time stamp to the frame in which it is heard.
    pub fn delay(&self) -> f64 {
        f32::from_bits(self.delay.load(Relaxed)).into()
    }

    /// Whether the song, if there is one, has come to its end.
    pub fn is_song_over(&self) -> bool {
        self.song_over.load(Relaxed)
    }

    /// Stops the song where it is.
    pub fn halt_song(&self) {
        self.song_halted.store(true, Relaxed);
    }

    pub(super) fn is_song_halted(&self) -> bool {
        self.song_halted.load(Relaxed)
    }

    pub(super) fn count_xrun(&self) {
        self.xruns.fetch_add(1, Relaxed);
    }

    pub(super) fn note_song(&self, is_over: bool) {
        self.song_over.store(is_over, Relaxed);
    }

    pub(super) fn note_delay(&self, seconds: f64) {
        self.delay.store((seconds.max(0.0) as f32).to_bits(), Relaxed);
    }
}
