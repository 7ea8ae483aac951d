//! Implicit (backward) Euler: position and velocity both from the new state. First order; shrinks with any step.

use super::integrator::Integrator;
use crate::error::{Error, Result};
use crate::lab::system::{State, System};

/// Maximum number of Newton steps of a nonlinear solution.
const ITERATIONS: usize = 50;
/// A nonlinear solution is accepted when the relative change of the velocity is below this.
const TOLERANCE: f64 = 1e-14;

/// `y⁺ = y + h f(y⁺, t + h)`.
pub(super) struct ImplicitEuler {
    pub(super) system: System,
    pub(super) h: f64,
}

impl ImplicitEuler {
    /// The solution for a linear spring: `v⁺ (1 + h c/m + h² k/m) = v + h (f − k d)/m`.
    fn closed(&self, State { x, v }: State, t: f64) -> State {
        let Self { system, h } = self;
        let pull = system.spring_force(x) + system.force.at(t + h);
        let divisor = system.mass + h * system.damping + h * h * system.stiffness;
        let v = (system.mass * v + h * pull) / divisor;
        State { x: x + h * v, v }
    }

    /// Newton's method on `g(v⁺) = v⁺ − v − h a(x + h v⁺, v⁺, t + h)`.
    fn iterated(&self, State { x, v }: State, t: f64) -> Result<State> {
        let Self { system, h } = self;
        let mut next = v;
        for _ in 0..ITERATIONS {
            let ahead = State { x: x + h * next, v: next };
            let residual = next - v - h * system.acceleration(ahead, t + h);
            let slope = 1.0 + h * (system.damping - h * system.spring_gradient(ahead.x)) / system.mass;
            let change = residual / slope;
            next -= change;
            if change.abs() <= TOLERANCE * (next.abs() + v.abs() + f64::MIN_POSITIVE) {
                return Ok(State { x: x + h * next, v: next });
            }
        }
        Err(Error::value(
            "implicit-euler",
            format!(
                "the solve at t = {t} s did not converge in {ITERATIONS} iterations; a step shorter than {h} s may"
            ),
        ))
    }
}

impl Integrator for ImplicitEuler {
    fn step(&self, state: State, t: f64) -> Result<State> {
        if self.system.is_linear() { Ok(self.closed(state, t)) } else { self.iterated(state, t) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::system::Spring;

    #[test]
    fn the_solution_satisfies_the_implicit_equation() {
        for spring in [Spring::Linear, Spring::Duffing { cubic: 200.0 }, Spring::Pendulum] {
            let system = System { spring, target: 0.1, ..System::linear(2.0, 50.0, 0.7).unwrap() };
            let (h, start) = (0.05, State { x: 0.5, v: -1.0 });
            let next = ImplicitEuler { system, h }.step(start, 0.0).unwrap();
            let slope = system.derivative(next, h);
            assert!((next.x - start.x - h * slope.x).abs() < 1e-14, "{spring:?}");
            assert!((next.v - start.v - h * slope.v).abs() < 1e-13, "{spring:?}");
        }
    }

    #[test]
    fn iteration_and_closed_form_agree_on_a_linear_spring() {
        let stepper = ImplicitEuler { system: System::linear(1.0, 50.0, 0.3).unwrap(), h: 0.15 };
        let start = State { x: 0.5, v: 2.0 };
        let (a, b) = (stepper.closed(start, 0.0), stepper.iterated(start, 0.0).unwrap());
        assert!((a.x - b.x).abs() < 1e-15 && (a.v - b.v).abs() < 1e-14);
    }

    #[test]
    fn a_solve_that_fails_says_so() {
        let system = System { spring: Spring::Pendulum, ..System::linear(1.0, 50.0, 0.0).unwrap() };
        let stepper = ImplicitEuler { system, h: 1.0 };
        let failed = (0..200).find_map(|n| stepper.step(State { x: 0.05 * f64::from(n), v: 3.0 }, 0.25).err());
        let message = failed.expect("some start sends Newton's method round in circles").to_string();
        assert!(message.contains("t = 0.25 s") && message.contains("50 iterations"), "{message}");
    }
}
