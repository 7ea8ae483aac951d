//! The energy of a state, and the Lagrangian from which the equation of motion follows.
//!
//! With the generalised coordinate `q = x`, `L = T − V = ½ m q̇² − V(q)`, and Euler–Lagrange,
//! `∂L/∂q = d/dt ∂L/∂q̇`, is `−V′(q) = m q̈`.

use super::system::{Spring, State, System};
use libm::{sin, sqrt};

/// Kinetic and potential energy in J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Energy {
    /// `½ m v²`.
    pub kinetic: f64,
    /// Energy stored in the spring: `½ k d²` for a linear spring.
    pub potential: f64,
}

impl Energy {
    /// Energy of a state. The force `f(t)` is external, so its work is not included.
    pub(crate) fn of(system: &System, state: State) -> Self {
        let d = state.x - system.target;
        let potential = match system.spring {
            Spring::Linear => 0.5 * system.stiffness * d * d,
            Spring::Duffing { cubic } => (0.5 * system.stiffness + 0.25 * cubic * d * d) * d * d,
            // Equals k (1 − cos d), but does not cancel at small angles.
            Spring::Pendulum => 2.0 * system.stiffness * sin(0.5 * d) * sin(0.5 * d),
        };
        Self { kinetic: 0.5 * system.mass * state.v * state.v, potential }
    }

    /// `T + V`: constant if there is no damper and no force.
    pub(crate) fn total(&self) -> f64 {
        self.kinetic + self.potential
    }
}

/// The largest stiffness in N/m on a motion through `state` without a force. It determines the shortest period.
pub(crate) fn greatest_stiffness(system: &System, state: State) -> f64 {
    match system.spring {
        Spring::Linear | Spring::Pendulum => system.stiffness,
        Spring::Duffing { cubic } => {
            // ¼ cubic d⁴ ≤ E limits the stretch, whatever the linear part is.
            let total = Energy::of(system, state).total();
            system.stiffness + 6.0 * sqrt(cubic * total)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::method::Method;

    fn systems() -> impl Iterator<Item = System> {
        [Spring::Linear, Spring::Duffing { cubic: 80.0 }, Spring::Pendulum].into_iter().map(|spring| System {
            spring,
            target: 0.1,
            ..System::linear(1.5, 50.0, 0.0).unwrap()
        })
    }

    /// Checks `∂L/∂q` by a difference quotient of `L = T − V`, and `d/dt ∂L/∂q̇` by one of the momentum `∂L/∂q̇ = m q̇` along
    /// the motion.
    #[test]
    fn the_motion_satisfies_euler_lagrange() {
        for system in systems() {
            let h = 1e-5;
            let step = Method::RungeKutta4.integrator(&system, h).unwrap();
            let back = State { x: 0.45, v: -0.7 };
            let here = step.step(back, 0.0).unwrap();
            let next = step.step(here, h).unwrap();
            let lagrangian = |x: f64| {
                let Energy { kinetic, potential } = Energy::of(&system, State { x, ..here });
                kinetic - potential
            };
            let slope = (lagrangian(here.x + h) - lagrangian(here.x - h)) / (2.0 * h);
            let rate = system.mass * (next.v - back.v) / (2.0 * h);
            assert!((slope - rate).abs() < 1e-6 * slope.abs().max(1.0), "{:?}: {slope} {rate}", system.spring);
        }
    }

    #[test]
    fn total_energy_is_constant_along_the_motion() {
        for system in systems() {
            let step = Method::RungeKutta4.integrator(&system, 1e-4).unwrap();
            let mut state = State { x: 0.6, v: 0.0 };
            let start = Energy::of(&system, state);
            assert_eq!(start.kinetic, 0.0);
            for n in 0..10_000 {
                state = step.step(state, f64::from(n) * 1e-4).unwrap();
                assert!((Energy::of(&system, state).total() / start.total() - 1.0).abs() < 1e-11);
            }
        }
    }
}
