//! Reports the tail's length to the host, without computing it in every block.

use nice_plug::prelude::ProcessStatus;
use sprung::engine::Synth;

/// Frames between two computations of the tail in real time: a computation takes some microseconds for each voice that
/// has changed.
const RECOUNT: usize = 4096;

/// The tail that is reported to the host. Between two computations it shrinks by the rendered frames. Real-time safe.
pub(crate) struct Tail {
    frames: u64,
    /// Whether no event or change has happened since the last computation.
    holds: bool,
    /// Frames since the last computation.
    since: usize,
    /// Whether the host renders to a file. The tail is then computed after every change.
    offline: bool,
}

impl Tail {
    /// A tail that has not been computed yet.
    pub(crate) fn new(offline: bool) -> Self {
        Self { frames: 0, holds: false, since: RECOUNT, offline }
    }

    /// Marks the tail as out of date, after an event or a change.
    pub(crate) fn forget(&mut self) {
        self.holds = false;
    }

    /// The status to report to the host after a block of `frames` frames.
    pub(crate) fn status(&mut self, synth: &mut Synth, frames: usize) -> ProcessStatus {
        self.since = self.since.saturating_add(frames);
        self.frames = self.frames.saturating_sub(frames as u64);
        if synth.is_silent() {
            return ProcessStatus::Normal;
        }
        if self.since >= RECOUNT || (self.offline && !self.holds) {
            (self.frames, self.holds, self.since) = (synth.tail_frames(), true, 0);
        }
        match self.frames {
            frames if self.holds => ProcessStatus::Tail(frames.clamp(1, u64::from(u32::MAX) - 1) as u32),
            _ => ProcessStatus::KeepAlive,
        }
    }
}
