//! Settings that move to where they are set in a straight line of 20 ms, and samples that stay within bounds.

use crate::dsp::ramp::Ramp;

/// Seconds that a value takes.
const SECONDS: f64 = 0.02;

/// A setting on its way. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Smoothed {
    ramp: Ramp,
    target: f32,
    /// Frames until it is there.
    left: u32,
    frames: u32,
}

impl Smoothed {
    /// One that rests at `value`.
    pub(super) fn new(value: f32, sample_rate: f64) -> Self {
        Self { ramp: Ramp::at_rest(value), target: value, left: 0, frames: (SECONDS * sample_rate).max(1.0) as u32 }
    }

    /// Where it is to be.
    pub(super) fn target(&self) -> f32 {
        self.target
    }

    /// Starts for `value`, unless it is there or on the way. What is no number changes nothing.
    pub(super) fn set(&mut self, value: f32) {
        if value != self.target && !value.is_nan() {
            self.target = value;
            self.ramp.set(value, self.frames);
            self.left = self.frames;
        }
    }

    /// Is at `value` at once.
    pub(super) fn jump(&mut self, value: f32) {
        (self.ramp, self.target, self.left) = (Ramp::at_rest(value), value, 0);
    }

    pub(super) fn is_moving(&self) -> bool {
        self.left > 0
    }

    /// Frames until it rests.
    pub(super) fn frames_left(&self) -> u32 {
        self.left
    }

    /// Frames that it takes from one value to another.
    pub(super) fn frames(&self) -> u32 {
        self.frames
    }

    /// Whether it rests at `value`.
    pub(super) fn rests_at(&self, value: f32) -> bool {
        self.left == 0 && self.target == value
    }

    /// The value `frames` frames from now.
    pub(super) fn after(&self, frames: usize) -> f32 {
        self.ramp.after(frames as u32)
    }

    /// Lets frames pass.
    pub(super) fn advance(&mut self, frames: usize) {
        if self.left > 0 {
            self.ramp.advance(frames as u32);
            self.left = self.left.saturating_sub(frames as u32);
        }
    }
}

/// A sample for what remembers: what is no number is silence, and what is beyond ±10⁶ is held there, so that its square has
/// room.
pub(super) fn held(sample: f32) -> f32 {
    if sample.is_nan() { 0.0 } else { sample.clamp(-1e6, 1e6) }
}
