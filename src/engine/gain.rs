//! Stereo gain with a pan, which changes smoothly.

use crate::dsp::ramp::Ramp;
use crate::params::Param;
use crate::units::gain_from_db;
use libm::sqrtf;

/// Controllers and expressions change in steps; a ramp of this length smooths them.
const SLOPE_SECONDS: f64 = 0.01;

/// A left and a right gain with a ramp each. Real-time safe.
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

    /// Starts a ramp to an amplitude ratio at a pan from 0 (left) to 1 (right).
    pub(crate) fn aim(&mut self, gain: f32, position: f32) {
        let (left, right) = pan_gains(position);
        self.sides[0].set(gain * left, self.slope_frames);
        self.sides[1].set(gain * right, self.slope_frames);
    }

    /// Sets the gains to their targets at once.
    pub(crate) fn land(&mut self) {
        self.sides = self.sides.map(|side| Ramp::at_rest(side.after(u32::MAX)));
    }

    /// Left and right gain `frames` frames from now.
    pub(crate) fn after(&self, frames: u32) -> [f32; 2] {
        self.sides.map(|side| side.after(frames))
    }

    /// Advances the ramps by `frames` frames.
    pub(crate) fn advance(&mut self, frames: u32) {
        self.sides.iter_mut().for_each(|side| side.advance(frames));
    }

    /// Length of a ramp in frames.
    pub(crate) fn slope_frames(&self) -> u32 {
        self.slope_frames
    }
}

/// Gains for a pan from 0 (left) to 1 (right): constant power, and exactly 1 and 1 in the centre.
pub(crate) fn pan_gains(position: f32) -> (f32, f32) {
    (sqrtf(2.0 * (1.0 - position)), sqrtf(2.0 * position))
}

/// The gain of an exciter's level in decibels. All exciters have the same lowest level, at which they are off.
pub(crate) fn exciter_gain(db: f64) -> f64 {
    if db > f64::from(Param::MalletLevel.info().min) { gain_from_db(db) } else { 0.0 }
}
