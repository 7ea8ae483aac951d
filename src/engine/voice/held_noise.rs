//! Noise that drives the modes of a voice for as long as its note is held.

use super::line::Line;
use super::values::StruckValues;
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::coefficients::LN_MINUS_60_DB;
use crate::dsp::exciter::Colour;
use crate::dsp::random::{key, uniform};
use crate::params::Param;
use libm::sqrt;

/// Number of the stream of random numbers, which differs from that of bursts.
const STREAM: u64 = 0x48_454c_4400;

/// The noise that a voice holds. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct HeldNoise {
    gain: Line,
    /// The force of the strike.
    strike: f64,
    colour: Colour,
    key: u64,
    drawn: u64,
}

impl HeldNoise {
    /// No noise.
    pub(super) const OFF: Self = Self { gain: Line::ZERO, strike: 0.0, colour: Colour::WHITE, key: 0, drawn: 0 };

    /// Reads the noise's parameters at a strike, which has a stream of random numbers and a force.
    pub(super) fn strike(&mut self, values: &StruckValues, stream: u64, force: f64) {
        self.colour = Colour::new(values.share(Param::NoiseColour), values.instrument.sample_rate);
        (self.key, self.drawn, self.strike) = (key(stream, STREAM), 0, force);
    }

    /// Whether there is noise, or about to be.
    pub(super) fn is_on(&self) -> bool {
        !self.gain.is_zero()
    }

    /// Starts a ramp to a gain, which ends in `frames` frames. At a gain and a force of 1, white noise keeps a mode with a T60 of 1 s at an
    /// expected amplitude of 1: each frame adds as much energy as the mode loses.
    pub(super) fn control(&mut self, gain: f32, sample_rate: f64, frames: usize) {
        if gain != 0.0 || self.is_on() {
            // The numbers have a variance of 1/3.
            let force = self.strike * sqrt(-2.0 * LN_MINUS_60_DB / sample_rate * 3.0);
            self.gain.aim(gain * force as f32, frames);
        }
    }

    /// Adds the next `frames` frames to a force.
    pub(super) fn add_to(&mut self, force: &mut [f32; CONTROL_FRAMES], frames: usize) {
        for (frame, force) in force[..frames].iter_mut().enumerate() {
            *force += self.gain.at(frame) * self.colour.filter(uniform(self.key, self.drawn));
            self.drawn += 1;
        }
        self.gain.advance(frames);
    }
}
