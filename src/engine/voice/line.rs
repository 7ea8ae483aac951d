//! A number that moves in a straight line from control tick to control tick.

/// A number on its way to where it is to be at the next control tick. Real-time safe.
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

    /// A number that stays where it is.
    pub(super) fn at_rest(number: f32) -> Self {
        Self { from: number, to: number, ..Self::ZERO }
    }

    /// Sets out for `to`, to be there in `frames` frames.
    pub(super) fn aim(&mut self, to: f32, frames: usize) {
        let from = self.now();
        *self = Self { from, to, step: (to - from) / frames.max(1) as f32, frames: frames as u32, passed: 0 };
    }

    /// Where it is: after the last frame exactly where it was to be.
    pub(super) fn now(&self) -> f32 {
        if self.passed < self.frames { self.from + self.passed as f32 * self.step } else { self.to }
    }

    /// Where it is to be at the next control tick.
    pub(super) fn end(&self) -> f32 {
        self.to
    }

    /// Whether it is 0 and stays there.
    pub(super) fn is_zero(&self) -> bool {
        self.to == 0.0 && (self.from == 0.0 || self.passed >= self.frames)
    }

    /// Where it was at its start, its change a frame, and the frames that have passed since.
    pub(super) fn parts(&self) -> ([f32; 2], u32) {
        ([self.from, self.step], self.passed)
    }

    /// Where it is after `frame` frames more, and the one that follows.
    pub(super) fn at(&self, frame: usize) -> f32 {
        self.from + (self.passed as f32 + (frame + 1) as f32) * self.step
    }

    /// Lets frames pass.
    pub(super) fn advance(&mut self, frames: usize) {
        self.passed += frames as u32;
    }
}
