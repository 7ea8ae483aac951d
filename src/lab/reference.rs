//! The true motion to which trajectories are compared.
//!
//! It is the closed form or, for a nonlinear spring, an integration so fine that a finer one gives the same result.

use super::closed_form::ClosedForm;
use super::energy::greatest_stiffness;
use super::method::Method;
use super::system::{State, System};
use crate::error::{Error, Result};
use libm::sqrt;

/// Refinement ends when the change from one refinement to the next, relative to the largest displacement, is below
/// this.
const TOLERANCE: f64 = 1e-11;
/// Maximum number of steps of the finest integration.
const MOST_STEPS: f64 = 1e7;

/// The states at `0, h, … count·h` seconds. Returns an error if there is no reference, because the motion is so
/// sensitive (chaotic, or very long) that refinements do not converge.
pub fn states(system: &System, start: State, h: f64, count: usize) -> Result<Vec<State>> {
    system.validate()?;
    if let Ok(motion) = ClosedForm::new(system, start) {
        return Ok((0..=count).map(|n| motion.at(n as f64 * h)).collect());
    }
    // 1/200 rad of the fastest oscillation per step: an error of about 1e−12 per radian, before any refinement.
    let angle = sqrt(greatest_stiffness(system, start) / system.mass) * h;
    let mut substeps = (200.0 * angle).ceil().max(4.0);
    let steps = count as f64 * substeps;
    if steps.is_nan() || steps > MOST_STEPS {
        let message = format!(
            "is {steps:.1e} steps away for a reference of this nonlinear motion, and at most {MOST_STEPS:.0e} are tried: \
             choose an earlier one, a softer spring or a greater mass"
        );
        return Err(Error::value("end", message));
    }
    let mut coarse = integrated(system, start, h, count, substeps as usize)?;
    while count as f64 * substeps <= MOST_STEPS {
        substeps *= 2.0;
        let fine = integrated(system, start, h, count, substeps as usize)?;
        let size = fine.iter().fold(0.0_f64, |size, state| size.max(state.x.abs()));
        let change = fine.iter().zip(&coarse).fold(0.0_f64, |most, (a, b)| most.max((a.x - b.x).abs()));
        if change <= TOLERANCE * size {
            return Ok(fine);
        }
        coarse = fine;
    }
    Err(Error::value("end", "is too far for a reference of this nonlinear motion: choose an earlier one"))
}

/// Runge–Kutta integration with `substeps` steps in each `h`.
fn integrated(system: &System, start: State, h: f64, count: usize, substeps: usize) -> Result<Vec<State>> {
    let step = h / substeps as f64;
    let method = Method::RungeKutta4.integrator(system, step)?;
    let mut states = Vec::with_capacity(count + 1);
    let mut state = start;
    states.push(state);
    for n in 0..count {
        for sub in 0..substeps {
            state = method.step(state, n as f64 * h + sub as f64 * step)?;
        }
        states.push(state);
    }
    Ok(states)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::system::{Force, Spring};

    #[test]
    fn the_fine_integration_of_a_linear_spring_is_the_closed_form() {
        let force = Force { amplitude: 1.0, frequency: 0.8, phase: 0.0 };
        let linear = System { force, ..System::linear(1.0, 50.0, 0.4).unwrap() };
        let start = State { x: 0.5, v: 0.0 };
        let exact = states(&linear, start, 0.05, 100).unwrap();
        let nearly = System { spring: Spring::Duffing { cubic: 0.0 }, ..linear };
        let fine = states(&nearly, start, 0.05, 100).unwrap();
        assert_eq!((exact.len(), fine.len()), (101, 101));
        for (a, b) in exact.iter().zip(fine) {
            assert!((a.x - b.x).abs() < 1e-11 && (a.v - b.v).abs() < 1e-10);
        }
    }

    #[test]
    fn a_reference_that_would_take_for_ever_is_refused_before_it_begins() {
        for stiffness in [1e20, f64::MAX] {
            let stiff = System { spring: Spring::Pendulum, ..System::linear(1.0, stiffness, 0.5).unwrap() };
            let message = states(&stiff, State { x: 0.5, v: 0.0 }, 0.01, 500).unwrap_err().to_string();
            assert!(message.contains("steps away"), "{message}");
        }
    }

    #[test]
    fn chaos_has_no_reference() {
        let force = Force { amplitude: 60.0, frequency: 1.0, phase: 0.0 };
        let chaotic = System { force, spring: Spring::Pendulum, ..System::linear(1.0, 50.0, 0.5).unwrap() };
        let message = states(&chaotic, State { x: 3.1, v: 0.0 }, 0.1, 1150).unwrap_err().to_string();
        assert!(message.starts_with("end:"), "{message}");
    }
}
