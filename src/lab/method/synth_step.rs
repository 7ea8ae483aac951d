//! The synth's own step, `v −= v·ζ + x·ω²; x += v`, with the coefficients of the seed or with exact ones.
//!
//! The oscillator counts time in samples, and its velocity is not that of the mass. So the state is converted to the
//! oscillator's units before each step and back after it, and can be compared with the other methods.

use super::integrator::Integrator;
use crate::dsp::{Coefficients, HarmonicOscillator};
use crate::error::{Error, Result};
use crate::lab::closed_form::Transition;
use crate::lab::system::{State, System};
use std::f64::consts::TAU;

/// The oscillator and the conversion of units: its velocity is `a d + b v`.
pub(super) struct SynthStep {
    system: System,
    mass: HarmonicOscillator<f64>,
    a: f64,
    b: f64,
    /// Velocity in m/s that a force of 1 N adds in a step.
    kick: f64,
    h: f64,
    /// Whether half of the force acts before and half after the step (second order), or all of it at once (first
    /// order).
    halves: bool,
}

impl SynthStep {
    /// Coefficients as first published, in single precision, from the undamped frequency `ω/2π` and the −60 dB time of
    /// `λ̄`. First order. Returns an error without a spring, because there is no frequency.
    pub(super) fn seed(system: &System, h: f64) -> Result<Self> {
        let frequency = system.omega()? / TAU;
        let decay_frames = -crate::dsp::coefficients::LN_MINUS_60_DB / (system.decay_rate() * h);
        let coefficients = Coefficients::seed(frequency as f32, decay_frames as f32, 1.0, (1.0 / h) as f32);
        let mass = HarmonicOscillator::new(&coefficients);
        Ok(Self { system: *system, mass, a: 0.0, b: h, kick: h / system.mass, h, halves: false })
    }

    /// Exact coefficients. Returns an error if the step is a whole number of half periods, because the samples of the
    /// displacement then contain no information about the velocity.
    pub(super) fn exact(system: &System, h: f64) -> Result<Self> {
        let transition = Transition::over(system, h);
        let coefficients = Coefficients::mass_spring(system.mass, system.damping, system.stiffness, 0.0, 0.0, h);
        let keep = 1.0 - coefficients.zeta;
        // One step leads to x₁ = x₀ (1−ω²) + u₀ (1−ζ). Solved for the oscillator's velocity u₀.
        let (from_position, _) = transition.apply(1.0, 0.0);
        let b = transition.reach / keep;
        if !b.is_finite() {
            return Err(Error::value("damping", format!("leaves no velocity at all after a step of {h} s")));
        }
        if b.abs() < 1e-9 * h {
            let message =
                format!("a step of {h} s is a whole number of half periods, from which no velocity can be told");
            return Err(Error::value("steps", message));
        }
        let a = (from_position - (1.0 - coefficients.omega2)) / keep;
        let mass = HarmonicOscillator::new(&coefficients);
        Ok(Self { system: *system, mass, a, b, kick: 0.5 * h / system.mass, h, halves: true })
    }
}

impl Integrator for SynthStep {
    fn step(&self, State { x, v }: State, t: f64) -> Result<State> {
        let struck = v + self.kick * self.system.force.at(t);
        let d = x - self.system.target;
        let mut mass = self.mass;
        (mass.x, mass.v) = (d, self.a * d + self.b * struck);
        mass.step();
        let mut v = (mass.v - self.a * mass.x) / self.b;
        if self.halves {
            v += self.kick * self.system.force.at(t + self.h);
        }
        Ok(State { x: self.system.target + mass.x, v })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lab's steps, in physical units, are the samples that the instrument plays.
    #[test]
    fn it_is_the_oscillator_sample_for_sample() {
        let (frequency, t60, rate) = (440.0, 0.5, 48_000.0);
        let system = System::from_note(frequency, t60).unwrap();
        let exact = SynthStep::exact(&system, 1.0 / rate).unwrap();
        let mut mass = HarmonicOscillator::<f64>::new(&Coefficients::exact(frequency, t60, 0.5, rate));
        let mut state = State { x: 0.0, v: 0.5 * TAU * frequency };
        for n in 0..10_000 {
            state = exact.step(state, f64::from(n) / rate).unwrap();
            assert!((state.x - mass.step()).abs() < 1e-10, "frame {n}");
        }
    }

    #[test]
    fn half_a_period_is_refused() {
        let system = System::linear(1.0, 1.0, 0.0).unwrap();
        let message = SynthStep::exact(&system, std::f64::consts::PI).err().map(|error| error.to_string());
        assert!(message.is_some_and(|message| message.contains("half periods")));
    }
}
