//! The modes of a free body, the modes of two joined bodies, and the damped sinusoids that are heard.

use super::complex::Complex;
use crate::error::{Error, Result};

/// One mode of a free body. The shapes are for a modal mass of 1 kg; see `BodyMode::with_mass`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMode {
    /// Angular frequency of the damped oscillation, in radians per second: `2π f`. (Without damping it would be `√(ω² + σ²)`.)
    pub angular_frequency: f64,
    /// Decay rate in nepers per second: `ln 1000 / T60`.
    pub decay_rate: f64,
    /// Mode shape where the other body is joined.
    pub joint: f64,
    /// Mode shape where the body is struck.
    pub strike: f64,
    /// Mode shape where the body is heard.
    pub pickup: f64,
}

impl BodyMode {
    /// The mode with a modal mass in kg: its shapes are divided by `√mass`.
    #[must_use]
    pub(crate) fn with_mass(self, mass: f64) -> Self {
        let scale = 1.0 / mass.sqrt();
        Self { joint: self.joint * scale, strike: self.strike * scale, pickup: self.pickup * scale, ..self }
    }

    /// Returns an error that names the first number that is out of range.
    pub(super) fn check(&self) -> Result<()> {
        let refused = |name, value: f64, wanted| Err(Error::value(name, format!("{value} is not {wanted}")));
        if !(1e-3..=1e9).contains(&self.angular_frequency) {
            return refused("angular frequency of a mode", self.angular_frequency, "between 0.001 and 1e9 rad/s");
        }
        if !(0.0..=1e9).contains(&self.decay_rate) {
            return refused("decay rate of a mode", self.decay_rate, "between 0 and 1e9 per second");
        }
        for (name, shape) in [("joint", self.joint), ("strike", self.strike), ("pick-up", self.pickup)] {
            if shape.is_nan() || shape.abs() > 1e9 {
                return Err(Error::value("mode shape", format!("{shape} at the {name} is not between −1e9 and 1e9")));
            }
        }
        Ok(())
    }
}

/// One mode of two bodies that act on each other: a damped sinusoid with complex mode shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoupledMode {
    /// Angular frequency of the damped oscillation, in radians per second. Zero for an overdamped motion, a plain exponential,
    /// which occurs only with strong damping in the joint.
    pub angular_frequency: f64,
    /// Decay rate in nepers per second; never negative.
    pub decay_rate: f64,
    /// Mode shapes where the first body and the second body are struck.
    pub(crate) strike: [Complex; 2],
    /// Mode shapes where the two bodies are heard, scaled so that `strike · pickup` is the complex amplitude.
    pub(crate) pickup: [Complex; 2],
}

/// The two parts of a damped sinusoid: at time `t` in seconds it is `e^(−σt) (cosine · cos ωt + sine · sin ωt)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Partial {
    /// The value at the start.
    pub cosine: f64,
    /// The value a quarter period later, without decay.
    pub sine: f64,
}

impl CoupledMode {
    /// A mode of one body on which the other does not act.
    pub(super) fn free(frequency: f64, rate: f64, strike: [f64; 2], pickup: [f64; 2]) -> Self {
        // The displacement after an impulse is sin(ωt)/ω.
        Self {
            angular_frequency: frequency,
            decay_rate: rate,
            strike: strike.map(|shape| Complex::new(shape, 0.0)),
            pickup: pickup.map(|shape| Complex::new(0.0, -(shape / frequency))),
        }
    }

    /// The contribution of this mode to the displacement that is heard after a strike with a momentum of 1 N s.
    ///
    /// `struck` is the fraction of the strike on each body, and `heard` is the output gain of each body:
    /// `[1.0, 0.0]` for the first body alone.
    pub(crate) fn displacement(&self, struck: [f64; 2], heard: [f64; 2]) -> Partial {
        let amplitude = self.amplitude(struck, heard);
        Partial { cosine: amplitude.re, sine: -amplitude.im }
    }

    /// The same for the velocity that is heard.
    pub fn velocity(&self, struck: [f64; 2], heard: [f64; 2]) -> Partial {
        let pole = Complex::new(-self.decay_rate, self.angular_frequency);
        let amplitude = self.amplitude(struck, heard) * pole;
        Partial { cosine: amplitude.re, sine: -amplitude.im }
    }

    /// `A` in `Re(A e^(st))`.
    fn amplitude(&self, struck: [f64; 2], heard: [f64; 2]) -> Complex {
        let strike = self.strike[0].scale(struck[0]) + self.strike[1].scale(struck[1]);
        let pickup = self.pickup[0].scale(heard[0]) + self.pickup[1].scale(heard[1]);
        strike * pickup
    }
}
