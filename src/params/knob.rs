//! Converts a parameter's value to a knob position and back.

use super::{Curve, ParamInfo, Unit};
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

    /// A value, moved by an offset in knob travel.
    pub fn moved(&self, value: f32, offset: f32) -> f32 {
        if offset == 0.0 { value } else { self.denormalise(self.normalise(value) + f64::from(offset)) }
    }

    /// The knob travel from the default to a value.
    pub fn travel(&self, value: f32) -> f32 {
        (self.normalise(value) - self.normalise(self.default)) as f32
    }

    /// Value at a knob position 0–1, rounded to a short decimal number: to five significant digits of the value on a
    /// logarithmic knob, of the range on a linear one. Plugin hosts store positions in single precision; because of the
    /// rounding, a number that a person has set comes back exactly.
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

    /// The next round number above or below a value: a multiple of a step, which is 1, 2 or 5 times a power of ten. Of
    /// these, the step is the one nearest to the fraction `travel` of the knob's travel. Choices and counts change by
    /// one.
    pub fn stepped(&self, value: f32, up: bool, travel: f64) -> f32 {
        let direction = if up { 1.0 } else { -1.0 };
        if matches!(self.unit, Unit::Choice | Unit::Count) {
            return self.clamp(value + direction as f32);
        }
        let value = f64::from(self.clamp(value));
        let distance = match self.curve {
            Curve::Linear => f64::from(self.max - self.min) * travel,
            Curve::Logarithmic => value * (pow(f64::from(self.max) / f64::from(self.min), travel) - 1.0),
        };
        // The step in thirds of a decade: 1, 2, 5 and 10 are about a third of a decade apart.
        let thirds = round(log10(distance) * 3.0);
        let decade = floor(thirds / 3.0);
        // `scale` is a whole number for steps below 1 too: a multiple is then a quotient of whole numbers, rounded only
        // once.
        let mantissa = [1.0, 2.0, 5.0][(thirds - 3.0 * decade) as usize];
        let scale = exp10(decade.abs());
        let place = if decade < 0.0 { value * scale / mantissa } else { value / (scale * mantissa) };
        // A value that single precision has moved slightly off a multiple counts as that multiple.
        let next = if up { floor(place + 1e-4) + 1.0 } else { -floor(-place + 1e-4) - 1.0 };
        let next = next * mantissa;
        self.clamp(if decade < 0.0 { next / scale } else { next * scale } as f32)
    }
}

#[cfg(test)]
mod tests {
    use crate::params::{PARAMS, Param};

    #[test]
    fn steps_go_to_round_numbers() {
        for (param, value, up, travel, next) in [
            (Param::Gain, -12.37, true, 0.02, -12.0),
            (Param::Gain, -12.0, false, 0.02, -13.0),
            (Param::Decay, 0.5, true, 0.02, 0.6),
            (Param::Voices, 8.0, false, 0.02, 7.0),
        ] {
            assert_eq!(param.info().stepped(value, up, travel), next, "{param:?} {value}");
        }
    }

    #[test]
    fn every_step_moves_and_ends_at_the_ends() {
        for info in PARAMS {
            for (up, from, to) in [(true, info.min, info.max), (false, info.max, info.min)] {
                for travel in [0.002, 0.02] {
                    let (mut value, mut steps) = (from, 0);
                    while value != to {
                        let next = info.stepped(value, up, travel);
                        assert!(if up { next > value } else { next < value }, "{}: {value} to {next}", info.id);
                        let is_short = info.parse(&info.format(next)) == Ok(next);
                        assert!(is_short || travel < 0.01, "{}: {next} is not round", info.id);
                        (value, steps) = (next, steps + 1);
                        assert!(steps < 3_000, "{}", info.id);
                    }
                }
            }
        }
    }
}
