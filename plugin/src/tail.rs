//! How long the sound goes on if nothing more happens, without counting it in every block.

use nice_plug::prelude::ProcessStatus;
use sprung::engine::Synth;

/// Frames between counts while the host plays in real time: counting takes some microseconds for each voice that
/// something has happened to.
const RECOUNT: usize = 4096;

/// What the host is told of the tail. Between two counts it shrinks by what has been rendered. Real-time safe.
pub(crate) struct Tail {
    frames: u64,
    /// Nothing has happened since the count.
    holds: bool,
    /// Frames since the count.
    since: usize,
    /// Whether the host renders to a file: then it is counted whenever it must.
    offline: bool,
}

impl Tail {
    /// A tail that is not known yet.
    pub(crate) fn new(offline: bool) -> Self {
        Self { frames: 0, holds: false, since: RECOUNT, offline }
    }

    /// Something has happened.
    pub(crate) fn forget(&mut self) {
        self.holds = false;
    }

    /// What the host is told after a block of so many frames.
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
