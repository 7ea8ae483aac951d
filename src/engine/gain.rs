//! Gain to the left and right, by level and position, that slides to where it is set.

use crate::dsp::ramp::Ramp;
use libm::sqrtf;

/// Controllers and expressions come in steps; this makes a slope of them.
const SLOPE_SECONDS: f64 = 0.01;

/// A gain and a position on their way. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StereoGain {
    sides: [Ramp; 2],
    slope_frames: u32,
}

impl StereoGain {
    /// Unity, in the centre.
    pub(crate) fn new(sample_rate: f64) -> Self {
        Self { sides: [Ramp::at_rest(1.0); 2], slope_frames: (SLOPE_SECONDS * sample_rate) as u32 }
    }

    /// Sets out for an amplitude ratio at a position from 0 (left) to 1 (right).
    pub(crate) fn aim(&mut self, gain: f32, position: f32) {
        let (left, right) = pan_gains(position);
        self.sides[0].set(gain * left, self.slope_frames);
        self.sides[1].set(gain * right, self.slope_frames);
    }

    /// Is where it was going, at once.
    pub(crate) fn land(&mut self) {
        self.sides = self.sides.map(|side| Ramp::at_rest(side.after(u32::MAX)));
    }

    /// Left and right gain `frames` frames from now.
    pub(crate) fn after(&self, frames: u32) -> [f32; 2] {
        self.sides.map(|side| side.after(frames))
    }

    /// Lets `frames` frames pass.
    pub(crate) fn advance(&mut self, frames: u32) {
        self.sides.iter_mut().for_each(|side| side.advance(frames));
    }

    /// Frames that it takes to arrive.
    pub(crate) fn slope_frames(&self) -> u32 {
        self.slope_frames
    }
}

/// Gains of a position from 0 (left) to 1 (right): of constant power, and exactly 1 and 1 in the centre.
pub(crate) fn pan_gains(position: f32) -> (f32, f32) {
    (sqrtf(2.0 * (1.0 - position)), sqrtf(2.0 * position))
}
