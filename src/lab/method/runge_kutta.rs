//! The classical Runge–Kutta method. Fourth order; loses `(ωh)⁶/144` of the amplitude per step, up to ω·h = 2√2.

use super::integrator::Integrator;
use crate::error::Result;
use crate::lab::system::{State, System};

/// `y⁺ = y + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄)`.
pub(super) struct RungeKutta4 {
    pub(super) system: System,
    pub(super) h: f64,
}

impl Integrator for RungeKutta4 {
    fn step(&self, state: State, t: f64) -> Result<State> {
        let Self { system, h } = self;
        let ahead = |by: f64, slope: State| {
            system.derivative(State { x: state.x + by * slope.x, v: state.v + by * slope.v }, t + by)
        };
        let k1 = system.derivative(state, t);
        let k2 = ahead(0.5 * h, k1);
        let k3 = ahead(0.5 * h, k2);
        let k4 = ahead(*h, k3);
        Ok(State {
            x: state.x + h / 6.0 * (k1.x + 2.0 * k2.x + 2.0 * k3.x + k4.x),
            v: state.v + h / 6.0 * (k1.v + 2.0 * k2.v + 2.0 * k3.v + k4.v),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// For a linear spring, the step is the Taylor series of the exponential map up to h⁴.
    #[test]
    fn a_step_is_the_taylor_polynomial() {
        let (h, omega2) = (0.1_f64, 50.0_f64);
        let got = RungeKutta4 { system: System::linear(1.0, omega2, 0.0).unwrap(), h }
            .step(State { x: 1.0, v: 0.0 }, 0.0)
            .unwrap();
        let z = h * h * omega2;
        assert!((got.x - (1.0 - z / 2.0 + z * z / 24.0)).abs() < 1e-14);
        assert!((got.v - -h * omega2 * (1.0 - z / 6.0)).abs() < 1e-14);
    }
}
