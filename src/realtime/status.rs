//! The state of the device and the song, shared between threads without locks.

use crate::engine::Telemetry;
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64};

/// State reported by the audio thread, and requests to it. Reading and writing are real-time safe.
#[derive(Default)]
pub struct Status {
    telemetry: Arc<Telemetry>,
    xruns: AtomicU64,
    /// Bits of an `f32`.
    delay: AtomicU32,
    song_over: AtomicBool,
    song_halted: AtomicBool,
    fading: AtomicBool,
    faded: AtomicBool,
}

impl Status {
    /// A status that shares its telemetry with another reader, for this project's own displays.
    #[doc(hidden)]
    pub fn of(telemetry: Arc<Telemetry>) -> Self {
        Self { telemetry, ..Self::default() }
    }

    /// Requests that everything is faded out, for good.
    pub fn fade(&self) {
        self.fading.store(true, Relaxed);
    }

    /// Whether everything has been faded out.
    pub fn is_faded(&self) -> bool {
        self.faded.load(Relaxed)
    }

    /// The engine's state, and the processing load of the audio thread.
    pub fn telemetry(&self) -> &Arc<Telemetry> {
        &self.telemetry
    }

    /// Number of times that the device ran out of samples.
    pub fn xruns(&self) -> u64 {
        self.xruns.load(Relaxed)
    }

    /// Seconds from the time stamp of an event to the time at which it is heard.
    pub fn delay(&self) -> f64 {
        f32::from_bits(self.delay.load(Relaxed)).into()
    }

    /// Whether the song, if there is one, has ended.
    pub fn is_song_over(&self) -> bool {
        self.song_over.load(Relaxed)
    }

    /// Stops the song at its present position.
    pub(crate) fn halt_song(&self) {
        self.song_halted.store(true, Relaxed);
    }

    pub(super) fn is_song_halted(&self) -> bool {
        self.song_halted.load(Relaxed)
    }

    pub(super) fn is_fading(&self) -> bool {
        self.fading.load(Relaxed)
    }

    pub(super) fn note_faded(&self) {
        self.faded.store(true, Relaxed);
    }

    pub(super) fn count_xrun(&self) {
        self.xruns.fetch_add(1, Relaxed);
    }

    pub(super) fn note_song(&self, is_over: bool) {
        self.song_over.store(is_over, Relaxed);
    }

    /// Reports the time in seconds from the time stamp of an event to the time at which it is heard.
    pub fn note_delay(&self, seconds: f64) {
        self.delay.store((seconds.max(0.0) as f32).to_bits(), Relaxed);
    }
}
