//! The system that is integrated: a mass on a spring, with a damper and a force.

use crate::error::{Error, Result};
use libm::{cos, sin, sqrt};
use std::f64::consts::TAU;

/// Position and velocity at one time: a point of the phase plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// Position in m (in rad for a pendulum).
    pub x: f64,
    /// Velocity in m/s.
    pub v: f64,
}

impl State {
    /// Whether both numbers are finite, so that the next step can be computed.
    pub(crate) fn is_finite(&self) -> bool {
        self.x.is_finite() && self.v.is_finite()
    }
}

/// The law of the restoring force, as a function of the stretch `d = x − target`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spring {
    /// Hooke: `−k d`.
    Linear,
    /// Duffing (1918): `−k d − cubic · d³`, a spring that stiffens with `cubic > 0`, in N/m³.
    Duffing {
        /// Coefficient of the cubic force.
        cubic: f64,
    },
    /// Pendulum: `−k sin d`, where `k = m g / length` and `d` is in radians.
    Pendulum,
}

/// An external force `f(t) = amplitude · cos(2π frequency t + phase)`; at a frequency of 0 it is constant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Force {
    /// Amplitude in N.
    pub amplitude: f64,
    /// Frequency in Hz.
    pub frequency: f64,
    /// Phase in rad.
    pub phase: f64,
}

impl Force {
    /// Force in N at `t` seconds.
    pub(crate) fn at(&self, t: f64) -> f64 {
        self.amplitude * cos(TAU * self.frequency * t + self.phase)
    }
}

/// `m ẍ + c ẋ + k s(x − target) = f(t)`, with `s` the law of the spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct System {
    /// `m` in kg.
    pub mass: f64,
    /// `k` in N/m.
    pub stiffness: f64,
    /// `c` in kg/s.
    pub damping: f64,
    /// Rest position of the spring, in m.
    pub target: f64,
    /// Law of the spring.
    pub spring: Spring,
    /// External force.
    pub force: Force,
}

impl System {
    /// A linear spring without a force. Returns an error if the mass is not positive, or stiffness or damping is
    /// negative.
    pub fn linear(mass: f64, stiffness: f64, damping: f64) -> Result<Self> {
        let system = Self { mass, stiffness, damping, target: 0.0, spring: Spring::Linear, force: Force::default() };
        system.validate()?;
        Ok(system)
    }

    /// The linear system with a mass of 1 kg that oscillates at `frequency` Hz and decays by 60 dB in `t60` seconds
    /// (infinite: no decay).
    pub(crate) fn from_note(frequency: f64, t60: f64) -> Result<Self> {
        if !(frequency > 0.0 && frequency.is_finite()) {
            return Err(Error::value("frequency", format!("must be greater than 0 Hz, got {frequency}")));
        }
        if t60.is_nan() || t60 <= 0.0 {
            return Err(Error::value("t60", format!("must be greater than 0 s, got {t60}")));
        }
        let lambda = -crate::dsp::coefficients::LN_MINUS_60_DB / t60;
        let ringing = TAU * frequency;
        Self::linear(1.0, ringing * ringing + lambda * lambda, 2.0 * lambda)
    }

    /// Returns an error that names the first invalid value of the mass, spring, damper or force.
    pub fn validate(&self) -> Result<()> {
        if !(self.mass > 0.0 && self.mass.is_finite()) {
            return Err(Error::value("mass", format!("must be greater than 0 kg, got {}", self.mass)));
        }
        for (name, value, unit) in [("stiffness", self.stiffness, "N/m"), ("damping", self.damping, "kg/s")] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(Error::value(name, format!("must be 0 {unit} or more, got {value}")));
            }
        }
        if let Spring::Duffing { cubic } = self.spring
            && !(cubic >= 0.0 && cubic.is_finite())
        {
            return Err(Error::value("cubic", format!("must be 0 N/m³ or more, got {cubic}")));
        }
        if !(self.force.frequency >= 0.0 && self.force.frequency.is_finite()) {
            let message = format!("must be 0 Hz (a constant force) or more, got {}", self.force.frequency);
            return Err(Error::value("force frequency", message));
        }
        for (name, value) in
            [("target", self.target), ("force", self.force.amplitude), ("force phase", self.force.phase)]
        {
            if !value.is_finite() {
                return Err(Error::value(name, format!("must be a finite number, got {value}")));
            }
        }
        Ok(())
    }

    /// Whether the force is proportional to the displacement, so that there is a closed form.
    pub fn is_linear(&self) -> bool {
        matches!(self.spring, Spring::Linear)
    }

    /// `ω = √(k/m)` in rad/s, of small undamped oscillations. Returns an error if there is no spring.
    pub(crate) fn omega(&self) -> Result<f64> {
        if self.stiffness > 0.0 {
            Ok(sqrt(self.stiffness / self.mass))
        } else {
            Err(Error::value("stiffness", "must be greater than 0 where ω = √(k/m) is asked for: no spring, no pitch"))
        }
    }

    /// `λ̄ = c / 2m` in 1/s: the decay rate.
    pub(crate) fn decay_rate(&self) -> f64 {
        0.5 * self.damping / self.mass
    }

    /// Force of the spring in N at position `x`: `−∂V/∂x`.
    pub(crate) fn spring_force(&self, x: f64) -> f64 {
        let d = x - self.target;
        match self.spring {
            Spring::Linear => -self.stiffness * d,
            Spring::Duffing { cubic } => -self.stiffness * d - cubic * d * d * d,
            Spring::Pendulum => -self.stiffness * sin(d),
        }
    }

    /// Derivative of [`System::spring_force`] with respect to `x`, in N/m.
    pub(crate) fn spring_gradient(&self, x: f64) -> f64 {
        let d = x - self.target;
        match self.spring {
            Spring::Linear => -self.stiffness,
            Spring::Duffing { cubic } => -self.stiffness - 3.0 * cubic * d * d,
            Spring::Pendulum => -self.stiffness * cos(d),
        }
    }

    /// `ẍ` in m/s².
    #[inline]
    pub(crate) fn acceleration(&self, state: State, t: f64) -> f64 {
        (self.spring_force(state.x) - self.damping * state.v + self.force.at(t)) / self.mass
    }

    /// `ẏ = f(y, t)` of the equivalent first-order system, `y = (x, v)`.
    #[inline]
    pub(crate) fn derivative(&self, state: State, t: f64) -> State {
        State { x: state.v, v: self.acceleration(state, t) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_cannot_be_are_named() {
        let good = System::linear(1.0, 50.0, 0.0).unwrap();
        for (system, name) in [
            (System { mass: -1.0, ..good }, "mass"),
            (System { mass: f64::NAN, ..good }, "mass"),
            (System { stiffness: -50.0, ..good }, "stiffness"),
            (System { damping: f64::INFINITY, ..good }, "damping"),
            (System { spring: Spring::Duffing { cubic: -1.0 }, ..good }, "cubic"),
            (System { target: f64::NAN, ..good }, "target"),
            (System { force: Force { frequency: -1.0, ..Force::default() }, ..good }, "force frequency"),
        ] {
            let message = system.validate().unwrap_err().to_string();
            assert!(message.starts_with(&format!("{name}: must be")), "{message}");
        }
        let message = System::linear(1.0, 0.0, 0.1).unwrap().omega().unwrap_err().to_string();
        assert!(message.contains("stiffness") && message.contains("ω"), "{message}");
    }

    #[test]
    fn the_gradient_is_that_of_the_force() {
        for spring in [Spring::Linear, Spring::Duffing { cubic: 30.0 }, Spring::Pendulum] {
            let system = System { spring, target: 0.2, ..System::linear(2.0, 50.0, 0.0).unwrap() };
            for x in [-1.3, 0.0, 0.2, 2.5] {
                let numeric = (system.spring_force(x + 1e-5) - system.spring_force(x - 1e-5)) / 2e-5;
                assert!((numeric - system.spring_gradient(x)).abs() < 1e-6, "{spring:?} at {x}");
            }
        }
    }
}
