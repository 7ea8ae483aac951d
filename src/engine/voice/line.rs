//! A number that moves linearly from control tick to control tick.

/// A linear ramp to a value at the next control tick. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    from: f32,
    to: f32,
    step: f32,
    frames: u32,
    passed: u32,
}

impl Line {
    pub(super) const ZERO: Self = Self { from: 0.0, to: 0.0, step: 0.0, frames: 0, passed: 0 };

    /// A constant value.
    pub(super) fn at_rest(number: f32) -> Self {
        Self { from: number, to: number, ..Self::ZERO }
    }

    /// Starts a ramp to `to`, which ends in `frames` frames.
    pub(super) fn aim(&mut self, to: f32, frames: usize) {
        let from = self.now();
        *self = Self { from, to, step: (to - from) / frames.max(1) as f32, frames: frames as u32, passed: 0 };
    }

    /// The current value: exactly the target after the last frame.
    pub(super) fn now(&self) -> f32 {
        if self.has_arrived() { self.to } else { self.from + self.passed as f32 * self.step }
    }

    /// Whether the ramp has ended.
    pub(super) fn has_arrived(&self) -> bool {
        self.passed >= self.frames
    }

    /// The target, at the next control tick.
    pub(super) fn end(&self) -> f32 {
        self.to
    }

    /// Whether the value is 0 and stays 0.
    pub(super) fn is_zero(&self) -> bool {
        self.to == 0.0 && (self.from == 0.0 || self.has_arrived())
    }

    /// The start value with the change per frame, and the frames since the start.
    pub(super) fn parts(&self) -> ([f32; 2], u32) {
        ([self.from, self.step], self.passed)
    }

    /// The value `frame + 1` frames from now. Not exact after the end of the ramp.
    pub(super) fn at(&self, frame: usize) -> f32 {
        self.from + (self.passed as f32 + (frame + 1) as f32) * self.step
    }

    /// Advances by some frames.
    pub(super) fn advance(&mut self, frames: usize) {
        self.passed += frames as u32;
    }
}
