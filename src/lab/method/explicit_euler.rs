//! Explicit (forward) Euler: position and velocity both from the old state. First order; grows without damping.

use super::integrator::Integrator;
use crate::error::Result;
use crate::lab::system::{State, System};

/// `y⁺ = y + h f(y, t)`.
pub(super) struct ExplicitEuler {
    pub(super) system: System,
    pub(super) h: f64,
}

impl Integrator for ExplicitEuler {
    fn step(&self, State { x, v }: State, t: f64) -> Result<State> {
        let slope = self.system.derivative(State { x, v }, t);
        Ok(State { x: x + self.h * slope.x, v: v + self.h * slope.v })
    }
}
