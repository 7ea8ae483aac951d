//! A processor's own clock: blocks of any size, divided at control ticks of `TICK` frames.

/// Counts frames since a processor was made or reset, so that what happens now and then falls on the same frames however
/// frames are asked for. Real-time safe.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ticks<const TICK: u64> {
    frame: u64,
}

impl<const TICK: u64> Ticks<TICK> {
    /// Whether a control tick is due before the next frame.
    pub(super) fn is_due(self) -> bool {
        self.frame.is_multiple_of(TICK)
    }

    /// Whether the control tick that is due is one of those of which there is one every `ticks`.
    pub(super) fn is_due_every(self, ticks: u64) -> bool {
        self.frame.is_multiple_of(ticks * TICK)
    }

    /// Frames until the next of those.
    pub(super) fn frames_until_every(self, ticks: u64) -> u64 {
        self.frame.next_multiple_of(ticks * TICK) - self.frame
    }

    /// How many of `frames` frames there are before the next control tick.
    pub(super) fn frames_before(self, frames: usize) -> usize {
        frames.min((TICK - self.frame % TICK) as usize)
    }

    /// Lets `frames` frames pass.
    pub(super) fn advance(&mut self, frames: usize) {
        self.frame += frames as u64;
    }
}
