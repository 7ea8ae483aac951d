//! The amplification matrix of a method: the effect of one step on every state of a linear spring.
//!
//! The 2 × 2 matrix is found by stepping two states. Growth, pitch and decay follow from it.

use super::method::Method;
use super::system::{Force, State, System};
use crate::dsp::{Coefficients, HarmonicOscillator};
use crate::error::{Error, Result};
use libm::{atan2, log, sqrt};

/// The matrix of one step on `(x, v/ω)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Amplification {
    rows: [[f64; 2]; 2],
}

/// The tone that follows from a step's eigenvalues.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Tone {
    /// A pair of eigenvalues `e^(−decay ± i angle)`: decay in nepers per step (negative: growth), angle in rad per
    /// step.
    Rings {
        /// Nepers per step.
        decay: f64,
        /// Radians per step.
        angle: f64,
    },
    /// Two real eigenvalues, so there is no pitch.
    Silent,
}

impl Amplification {
    /// The matrix of a method with steps of `h` seconds, for a linear system with a spring. Ignores target and force.
    pub(crate) fn of(method: Method, system: &System, h: f64) -> Result<Self> {
        if !system.is_linear() {
            return Err(Error::value("spring", "must be linear: the step of another depends on the amplitude"));
        }
        let omega = system.omega()?;
        let integrator = method.integrator(&System { target: 0.0, force: Force::default(), ..*system }, h)?;
        let displaced = integrator.step(State { x: 1.0, v: 0.0 }, 0.0)?;
        let moving = integrator.step(State { x: 0.0, v: omega }, 0.0)?;
        Ok(Self { rows: [[displaced.x, moving.x], [displaced.v / omega, moving.v / omega]] })
    }

    /// The matrix of the oscillator's own step on `(x, v)`, in the oscillator's units.
    pub(crate) fn of_step(coefficients: &Coefficients) -> Self {
        let step = |x: f64, v: f64| {
            let mut mass = HarmonicOscillator::new(&Coefficients { x0: x, v0: v, ..*coefficients });
            mass.step();
            (mass.x, mass.v)
        };
        let (displaced, moving) = (step(1.0, 0.0), step(0.0, 1.0));
        Self { rows: [[displaced.0, moving.0], [displaced.1, moving.1]] }
    }

    /// Determinant: the factor by which a step scales areas of the phase plane.
    pub(crate) fn determinant(&self) -> f64 {
        let [[a, b], [c, d]] = self.rows;
        a * d - b * c
    }

    /// Growth in nepers per step of the fastest-growing state. The matrix is squared 40 times, which gives the
    /// logarithm of Gelfand's `‖Mⁿ‖^(1/n)` at n = 2⁴⁰.
    pub(crate) fn growth(&self) -> f64 {
        let mut matrix = self.rows;
        let (mut growth, mut share) = (0.0, 1.0);
        for _ in 0..=40 {
            let norm = matrix.iter().flatten().fold(0.0_f64, |norm, entry| norm.max(entry.abs()));
            if norm == 0.0 || !norm.is_finite() {
                return if norm == 0.0 { f64::NEG_INFINITY } else { f64::INFINITY };
            }
            growth += share * log(norm);
            share *= 0.5;
            let [[a, b], [c, d]] = matrix.map(|row| row.map(|entry| entry / norm));
            matrix = [[a * a + b * c, b * (a + d)], [c * (a + d), b * c + d * d]];
        }
        growth
    }

    /// Whether every state stays bounded. The limit allows for rounding and for growth that is only linear.
    pub(crate) fn is_bounded(&self) -> bool {
        self.growth() < 1e-10
    }

    /// Pitch and decay of the eigenvalues, computed without the cancellation in `trace² − 4 det`.
    pub(crate) fn tone(&self) -> Tone {
        let [[a, b], [c, d]] = self.rows;
        let half_difference = 0.5 * (a - d);
        let discriminant = half_difference * half_difference + b * c;
        if discriminant < 0.0 {
            Tone::Rings { decay: -0.5 * log(self.determinant()), angle: atan2(sqrt(-discriminant), 0.5 * (a + d)) }
        } else {
            Tone::Silent
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_is_the_logarithm_of_the_largest_eigenvalue() {
        for (rows, expected) in [
            ([[2.0, 0.0], [0.0, 0.5]], log(2.0)),
            ([[0.0, 0.9], [-0.9, 0.0]], log(0.9)),
            ([[1.0, 1.0], [0.0, 1.0]], 0.0),
            ([[3.0, -5.0], [1.0, -1.0]], 0.5 * log(2.0)),
        ] {
            let growth = Amplification { rows }.growth();
            assert!((growth - expected).abs() < 1e-10, "{rows:?}: {growth}");
        }
        assert_eq!(Amplification { rows: [[0.0; 2]; 2] }.growth(), f64::NEG_INFINITY);
    }

    /// Eigenvalues `1 ± iωh` of explicit Euler, and their inverses for implicit Euler; symplectic Euler preserves
    /// areas.
    #[test]
    fn matrices_are_the_textbook_ones() {
        let system = System::linear(2.0, 8.0, 0.0).unwrap();
        let of = |method| Amplification::of(method, &system, 0.1).unwrap();
        let Tone::Rings { decay, angle } = of(Method::ExplicitEuler).tone() else { panic!("explicit Euler rings") };
        assert!((decay + 0.5 * log(1.04)).abs() < 1e-15 && (angle - atan2(0.2, 1.0)).abs() < 1e-15);
        let Tone::Rings { decay, angle } = of(Method::ImplicitEuler).tone() else { panic!("implicit Euler rings") };
        assert!((decay - 0.5 * log(1.04)).abs() < 1e-15 && (angle - atan2(0.2, 1.0)).abs() < 1e-15);
        assert!((of(Method::SymplecticEuler).determinant() - 1.0).abs() < 1e-15);
        assert!((of(Method::Verlet).determinant() - 1.0).abs() < 1e-15);
        assert_eq!(Amplification::of(Method::SymplecticEuler, &system, 1.5).unwrap().tone(), Tone::Silent);
    }
}
