//! The incoming sound, which drives the modes of a voice.

use super::line::Line;
use crate::dsp::CONTROL_FRAMES;

/// Force per second of an input of 1 at a level of 0 dB: one sample at 48 kHz has the force of a hundredth of a full strike.
const FORCE_PER_SECOND: f32 = 480.0;

/// Samples are clamped to this magnitude, so that no input can make the modes overflow.
const MOST: f32 = 8.0;

/// The gain of the incoming sound. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Input(Line);

impl Input {
    /// No input.
    pub(super) const OFF: Self = Self(Line::ZERO);

    /// Whether the gain is not 0, or is about to change from 0.
    pub(super) fn is_on(&self) -> bool {
        !self.0.is_zero()
    }

    /// Starts a ramp to a gain, which ends in `frames` frames.
    pub(super) fn control(&mut self, gain: f32, sample_rate: f64, frames: usize) {
        if gain != 0.0 || self.is_on() {
            self.0.aim(gain * (FORCE_PER_SECOND / sample_rate as f32), frames);
        }
    }

    /// Adds the next `frames` frames of the input to a force; missing samples count as silence.
    pub(super) fn add_to(&mut self, force: &mut [f32; CONTROL_FRAMES], input: &[f32], frames: usize) {
        for (frame, (force, sample)) in force[..frames].iter_mut().zip(input).enumerate() {
            let sample = if sample.is_nan() { 0.0 } else { sample.clamp(-MOST, MOST) };
            *force += self.0.at(frame) * sample;
        }
        self.0.advance(frames);
    }
}
