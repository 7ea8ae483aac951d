//! Knobs: a parameter's value as a position of its travel, and back.

use super::{Curve, ParamInfo};
use libm::{exp10, floor, log, log10, pow, round};

impl ParamInfo {
    /// Knob position 0–1 of a value.
    pub fn normalise(&self, value: f32) -> f64 {
        let (value, min, max) = (f64::from(self.clamp(value)), f64::from(self.min), f64::from(self.max));
        match self.curve {
            Curve::Linear => (value - min) / (max - min),
            Curve::Logarithmic => log(value / min) / log(max / min),
        }
    }

    /// Value of a knob position 0–1, out of a grid of short decimal numbers: five significant digits of the value where
    /// steps are of equal ratio, of the range where they are equal. So a number that a person has set comes back as
    /// that very number from a position in single precision, which is what plugin hosts keep.
    pub fn denormalise(&self, position: f64) -> f32 {
        let (min, max) = (f64::from(self.min), f64::from(self.max));
        let position = position.clamp(0.0, 1.0);
        let (value, size) = match self.curve {
            Curve::Linear => (min + position * (max - min), max - min),
            Curve::Logarithmic => {
                let value = min * pow(max / min, position);
                (value, value)
            }
        };
        // 10^(4 − ⌊log₁₀ size⌋): steps of 1/10,000 to 1/100,000.
        let steps_per_unit = exp10(4.0 - floor(log10(size)));
        self.clamp((round(value * steps_per_unit) / steps_per_unit) as f32)
    }
}
