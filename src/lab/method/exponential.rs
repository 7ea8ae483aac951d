//! The exact exponential map: applies the closed form's transition over one step repeatedly.
//!
//! Exact except for rounding. A force is evaluated at the middle of the step, which makes its part second order.

use super::integrator::Integrator;
use crate::error::Result;
use crate::lab::closed_form::{ClosedForm, Transition};
use crate::lab::system::{Force, State, System};

/// `y⁺ = e^(Ah) y`, plus the effect of the force at `t + h/2` as if it were constant during the step.
pub(super) struct Exponential {
    system: System,
    transition: Transition,
    /// Displacement and velocity after one step from rest under a force of 1 N.
    response: (f64, f64),
    h: f64,
}

impl Exponential {
    pub(super) fn new(system: &System, h: f64) -> Self {
        let transition = Transition::over(system, h);
        let constant = Force { amplitude: 1.0, ..Default::default() };
        let pushed = System { target: 0.0, force: constant, ..*system };
        let response =
            ClosedForm::new(&pushed, State::default()).map_or((0.0, 0.0), |motion| (motion.at(h).x, motion.at(h).v));
        Self { system: *system, transition, response, h }
    }
}

impl Integrator for Exponential {
    fn step(&self, State { x, v }: State, t: f64) -> Result<State> {
        let (d, v) = self.transition.apply(x - self.system.target, v);
        let force = self.system.force.at(t + 0.5 * self.h);
        Ok(State { x: self.system.target + d + force * self.response.0, v: v + force * self.response.1 })
    }
}
