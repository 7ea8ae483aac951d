//! The note expressions of one note.

use super::event::{Expression, finite, unit};
use super::gain::StereoGain;

/// The expressions of a note. Each is neutral until it is set. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Expressions {
    /// Semitones.
    pub(crate) tuning: f32,
    /// 0–1.
    pub(crate) pressure: f32,
    /// 0–1.
    pub(crate) vibrato: f32,
    /// −0.5 to 0.5.
    pub(crate) brightness: f32,
    volume: f32,
    swell: f32,
    pan: f32,
    /// Amplitude ratio and pan of the note's pad.
    pad: (f32, f32),
    gain: StereoGain,
}

impl Expressions {
    /// Neutral expressions.
    pub(crate) fn new(sample_rate: f64) -> Self {
        Self::neutral(StereoGain::new(sample_rate))
    }

    fn neutral(gain: StereoGain) -> Self {
        let (volume, swell, pan, pad) = (1.0, 1.0, 0.5, (1.0, 0.0));
        Self { tuning: 0.0, pressure: 0.0, vibrato: 0.0, brightness: 0.0, volume, swell, pan, pad, gain }
    }

    fn aim(&mut self) {
        let (gain, pan) = self.pad;
        self.gain.aim(self.volume * self.swell * self.swell * gain, (self.pan + 0.5 * pan).clamp(0.0, 1.0));
    }

    /// Sets one expression. A value out of range is clamped; NaN counts as zero.
    pub(crate) fn set(&mut self, expression: Expression, value: f32) {
        let value = finite(value);
        match expression {
            Expression::Tuning => self.tuning = value.clamp(-128.0, 128.0),
            Expression::Pressure => self.pressure = unit(value),
            Expression::Vibrato => self.vibrato = unit(value),
            Expression::Brightness => self.brightness = unit(value) - 0.5,
            Expression::Volume => self.volume = value.clamp(0.0, 4.0),
            Expression::Swell => self.swell = unit(value),
            Expression::Pan => self.pan = value.clamp(-1.0, 1.0) * 0.5 + 0.5,
        }
        if matches!(expression, Expression::Volume | Expression::Swell | Expression::Pan) {
            self.aim();
        }
    }

    /// Resets all expressions for a new note whose pad has an amplitude ratio and a pan from −1 to 1. Gains change
    /// smoothly.
    pub(crate) fn begin(&mut self, gain: f32, pan: f32) {
        *self = Self { pad: (gain, pan), ..Self::neutral(self.gain) };
        self.aim();
    }

    /// Sets the gains to their targets at once, for a note that has not sounded yet.
    pub(crate) fn land(&mut self) {
        self.gain.land();
    }

    /// Left and right gain `frames` frames from now.
    pub(crate) fn gains_after(&self, frames: u32) -> [f32; 2] {
        self.gain.after(frames)
    }

    /// Advances the gains by `frames` frames.
    pub(crate) fn advance(&mut self, frames: u32) {
        self.gain.advance(frames);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_slide_while_a_note_sounds_and_land_before_it_does() {
        let mut told = Expressions::new(48_000.0);
        assert_eq!(told.gains_after(0), [1.0; 2]);
        told.set(Expression::Volume, 2.0);
        told.set(Expression::Swell, 0.5);
        assert_eq!(told.gains_after(240), [0.75; 2], "half way from 1 to 2 · 0.5²");
        told.advance(480);
        assert_eq!(told.gains_after(0), [0.5; 2]);
        told.set(Expression::Pan, -1.0);
        told.land();
        assert_eq!(told.gains_after(0), [0.5 * std::f32::consts::SQRT_2, 0.0]);
    }

    #[test]
    fn numbers_out_of_range_become_the_nearest_within() {
        let mut told = Expressions::new(48_000.0);
        for (expression, value) in [
            (Expression::Tuning, f32::INFINITY),
            (Expression::Pressure, -1.0),
            (Expression::Brightness, 7.0),
            (Expression::Vibrato, f32::NAN),
        ] {
            told.set(expression, value);
        }
        assert_eq!((told.tuning, told.pressure, told.brightness, told.vibrato), (128.0, 0.0, 0.5, 0.0));
    }
}
