//! Heun's method: the mean of the slopes before and after an explicit Euler step. Second order; still grows, slowly.

use super::integrator::Integrator;
use crate::error::Result;
use crate::lab::system::{State, System};

/// `y⁺ = y + h/2 (f(y, t) + f(y + h f(y, t), t + h))`.
pub(super) struct Heun {
    pub(super) system: System,
    pub(super) h: f64,
}

impl Integrator for Heun {
    fn step(&self, State { x, v }: State, t: f64) -> Result<State> {
        let Self { system, h } = self;
        let before = system.derivative(State { x, v }, t);
        let after = system.derivative(State { x: x + h * before.x, v: v + h * before.v }, t + h);
        Ok(State { x: x + 0.5 * h * (before.x + after.x), v: v + 0.5 * h * (before.v + after.v) })
    }
}
