//! Chou's damped springs with a target, semi-implicit and implicit. First order.
//!
//! Source: A. Chou (2015), "Precise Control over Numeric Springing", as listed in "I turned jiggle physics code into a
//! synthesizer". A force `f(t)` is treated as a moving target: `target + f/k`.

use super::integrator::Integrator;
use crate::error::Result;
use crate::lab::system::{State, System};
use libm::sqrt;

/// A spring in Chou's form: damping ratio `ζ` and undamped angular frequency `ω`.
pub(super) struct Spring {
    system: System,
    zeta: f64,
    omega: f64,
    h: f64,
}

impl Spring {
    /// Returns an error without a spring, since `ω` would be 0 and `ζ` infinite.
    pub(super) fn new(system: &System, h: f64) -> Result<Self> {
        let omega = system.omega()?;
        let zeta = 0.5 * system.damping / sqrt(system.stiffness * system.mass);
        Ok(Self { system: *system, zeta, omega, h })
    }

    fn target(&self, t: f64) -> f64 {
        self.system.target + self.system.force.at(t) / self.system.stiffness
    }
}

/// `SpringSemiImplicit`.
pub(super) struct SemiImplicit(pub(super) Spring);

/// `SpringImplicit`.
pub(super) struct Implicit(pub(super) Spring);

impl Integrator for SemiImplicit {
    fn step(&self, State { x, v }: State, t: f64) -> Result<State> {
        let Spring { zeta, omega, h, .. } = self.0;
        let v = v + (-2.0 * h * zeta * omega * v + h * omega * omega * (self.0.target(t) - x));
        Ok(State { x: x + h * v, v })
    }
}

impl Integrator for Implicit {
    fn step(&self, State { x, v }: State, t: f64) -> Result<State> {
        let Spring { zeta, omega, h, .. } = self.0;
        let target = self.0.target(t + h);
        let f = 1.0 + 2.0 * h * zeta * omega;
        let oo = omega * omega;
        let hoo = h * oo;
        let hhoo = h * hoo;
        let det_inverse = 1.0 / (f + hhoo);
        let det_x = f * x + h * v + hhoo * target;
        let det_v = v + hoo * (target - x);
        Ok(State { x: det_x * det_inverse, v: det_v * det_inverse })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::method::Method;
    use crate::lab::system::Force;

    /// In physical units, Chou's springs are symplectic Euler and implicit Euler, also with damping, target and force.
    #[test]
    fn they_are_the_euler_methods_in_other_units() {
        let force = Force { amplitude: 3.0, frequency: 1.2, phase: 0.4 };
        let system = System { target: 0.3, force, ..System::linear(2.0, 70.0, 1.7).unwrap() };
        for (chou, euler) in
            [(Method::ChouSemiImplicit, Method::SymplecticEuler), (Method::ChouImplicit, Method::ImplicitEuler)]
        {
            let (a, b) = (chou.integrator(&system, 0.02).unwrap(), euler.integrator(&system, 0.02).unwrap());
            let (mut left, mut right) = (State { x: 0.5, v: 0.1 }, State { x: 0.5, v: 0.1 });
            for n in 0..500 {
                let t = f64::from(n) * 0.02;
                (left, right) = (a.step(left, t).unwrap(), b.step(right, t).unwrap());
                assert!((left.x - right.x).abs() < 1e-12 && (left.v - right.v).abs() < 1e-11, "{chou:?} at {t}");
            }
        }
    }
}
