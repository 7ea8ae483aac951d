//! The clock of a processor: it divides blocks of any size at control ticks of `TICK` frames.

/// Frames of a control tick of a body.
pub(super) const BODY_TICK: usize = 64;

/// Counts frames since a processor was created, reset or woken, so that control ticks fall on the same frames for all block sizes.
/// Real-time safe.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ticks<const TICK: u64> {
    frame: u64,
}

impl<const TICK: u64> Ticks<TICK> {
    /// Whether a control tick is due before the next frame.
    pub(super) fn is_due(self) -> bool {
        self.frame.is_multiple_of(TICK)
    }

    /// Whether no frame has passed.
    pub(super) fn is_start(self) -> bool {
        self.frame == 0
    }

    /// Whether the present control tick is one of every `ticks`-th.
    pub(super) fn is_due_every(self, ticks: u64) -> bool {
        self.frame.is_multiple_of(ticks * TICK)
    }

    /// Frames until the next of every `ticks`-th control tick.
    pub(super) fn frames_until_every(self, ticks: u64) -> u64 {
        self.frame.next_multiple_of(ticks * TICK) - self.frame
    }

    /// Number of frames, at most `frames`, before the next control tick.
    pub(super) fn frames_before(self, frames: usize) -> usize {
        frames.min((TICK - self.frame % TICK) as usize)
    }

    /// Advances by `frames` frames.
    pub(super) fn advance(&mut self, frames: usize) {
        self.frame += frames as u64;
    }
}
