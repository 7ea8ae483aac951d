//! Settings that move linearly to their targets in 20 ms, and a limit for samples.

use crate::dsp::ramp::Ramp;

/// Ramp time in seconds.
const SECONDS: f64 = 0.02;

/// A setting with a linear ramp to its target. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Smoothed {
    ramp: Ramp,
    target: f32,
    /// Frames until the end of the ramp.
    left: u32,
    frames: u32,
}

impl Smoothed {
    /// A constant setting.
    pub(crate) fn new(value: f32, sample_rate: f64) -> Self {
        Self { ramp: Ramp::at_rest(value), target: value, left: 0, frames: (SECONDS * sample_rate).max(1.0) as u32 }
    }

    /// The target of the ramp.
    pub(crate) fn target(&self) -> f32 {
        self.target
    }

    /// Starts a ramp to `value`, unless that is the target already. NaN changes nothing.
    pub(crate) fn set(&mut self, value: f32) {
        if value != self.target && !value.is_nan() {
            self.target = value;
            self.ramp.set(value, self.frames);
            self.left = self.frames;
        }
    }

    /// Sets the value at once.
    pub(crate) fn jump(&mut self, value: f32) {
        (self.ramp, self.target, self.left) = (Ramp::at_rest(value), value, 0);
    }

    pub(crate) fn is_moving(&self) -> bool {
        self.left > 0
    }

    /// Frames until the end of the ramp.
    pub(crate) fn frames_left(&self) -> u32 {
        self.left
    }

    /// Length of a ramp in frames.
    pub(crate) fn frames(&self) -> u32 {
        self.frames
    }

    /// Whether the value is constant at `value`.
    pub(crate) fn rests_at(&self, value: f32) -> bool {
        self.left == 0 && self.target == value
    }

    /// The value `frames` frames from now.
    pub(crate) fn after(&self, frames: usize) -> f32 {
        self.ramp.after(frames as u32)
    }

    /// Advances by some frames.
    pub(crate) fn advance(&mut self, frames: usize) {
        if self.left > 0 {
            self.ramp.advance(frames as u32);
            self.left = self.left.saturating_sub(frames as u32);
        }
    }
}

/// A sample for a processor with memory: NaN becomes 0, and the magnitude is limited to 10⁶, so that squares cannot
/// overflow.
pub(crate) fn held(sample: f32) -> f32 {
    if sample.is_nan() { 0.0 } else { sample.clamp(-1e6, 1e6) }
}
