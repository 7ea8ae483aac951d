//! Symplectic (semi-implicit) Euler, both orders: first order, but the energy stays within a bound below ω·h = 2.
//!
//! The two are adjoint: each is the other run backwards. They do not preserve `½ m v² + ½ k x²` but that `∓ ½ h k x v`.

use super::integrator::Integrator;
use crate::error::Result;
use crate::lab::system::{State, System};

/// `v⁺ = v + h a(x, v, t)`, then `x⁺ = x + h v⁺`.
pub(super) struct VelocityFirst {
    pub(super) system: System,
    pub(super) h: f64,
}

/// `x⁺ = x + h v`, then `v⁺ = v + h a(x⁺, v, t + h)`: the step that the mass-spring notebook lists as "explicit".
pub(super) struct PositionFirst {
    pub(super) system: System,
    pub(super) h: f64,
}

impl Integrator for VelocityFirst {
    fn step(&self, State { x, v }: State, t: f64) -> Result<State> {
        let v = v + self.h * self.system.acceleration(State { x, v }, t);
        Ok(State { x: x + self.h * v, v })
    }
}

impl Integrator for PositionFirst {
    fn step(&self, State { x, v }: State, t: f64) -> Result<State> {
        let x = x + self.h * v;
        Ok(State { x, v: v + self.h * self.system.acceleration(State { x, v }, t + self.h) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_the_other_run_backwards() {
        let system = System::linear(1.3, 50.0, 0.0).unwrap();
        let start = State { x: 0.3, v: 1.1 };
        let there = VelocityFirst { system, h: 0.1 }.step(start, 0.0).unwrap();
        let back = PositionFirst { system, h: -0.1 }.step(there, 0.1).unwrap();
        assert!((back.x - start.x).abs() < 1e-15 && (back.v - start.v).abs() < 1e-14);
    }

    #[test]
    fn the_energy_that_they_keep_is_a_modified_one() {
        let (k, h) = (50.0, 0.2);
        let system = System::linear(1.0, k, 0.0).unwrap();
        let methods: [(Box<dyn Integrator>, f64); 2] =
            [(Box::new(VelocityFirst { system, h }), -1.0), (Box::new(PositionFirst { system, h }), 1.0)];
        for (method, sign) in methods {
            let kept = |s: State| 0.5 * s.v * s.v + 0.5 * k * s.x * s.x + sign * 0.5 * h * k * s.x * s.v;
            let mut state = State { x: 0.5, v: 0.0 };
            let start = kept(state);
            for n in 0..1000 {
                state = method.step(state, f64::from(n) * h).unwrap();
                assert!((kept(state) / start - 1.0).abs() < 1e-12);
            }
        }
    }
}
