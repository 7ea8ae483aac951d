//! Störmer–Verlet in kick–drift–kick form: second order, with one force per step and no drift of the energy.
//!
//! With damping this is the scheme of Brünger, Brooks & Karplus (1984): the first half kick uses the damper's force
//! from the velocity before it, the second the force from the velocity after it. It equals central differences, and its
//! limit is still ω·h = 2.

use super::integrator::Integrator;
use crate::error::Result;
use crate::lab::system::{State, System};

/// `v½ = v + h/2 a(x, v, t)`, `x⁺ = x + h v½`, `v⁺ = v½ + h/2 a(x⁺, v⁺, t + h)`.
pub(super) struct Verlet {
    pub(super) system: System,
    pub(super) h: f64,
}

impl Integrator for Verlet {
    fn step(&self, State { x, v }: State, t: f64) -> Result<State> {
        let Self { system, h } = self;
        let half = v + 0.5 * h * system.acceleration(State { x, v }, t);
        let x = x + h * half;
        let pull = (system.spring_force(x) + system.force.at(t + h)) / system.mass;
        Ok(State { x, v: (half + 0.5 * h * pull) / (1.0 + 0.5 * h * system.damping / system.mass) })
    }
}
