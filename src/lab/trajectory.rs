//! Runs a method over a period of time and compares it with the true motion.

use super::method::Method;
use super::reference;
use super::system::{State, System};
use crate::error::{Error, Result};

/// Maximum number of states of one run that are kept in memory: 160 MB together with the true states.
pub(crate) const MOST_STEPS: usize = 5_000_000;

/// The states of a run at `0, h, 2h, …`, and the true states.
#[derive(Clone, Debug)]
pub struct Trajectory {
    /// The method.
    pub method: Method,
    /// Step in seconds.
    pub h: f64,
    /// One state per step, including the start; fewer if the numbers overflow.
    pub states: Vec<State>,
    /// The true states at the same times, up to the end.
    pub truth: Vec<State>,
    /// Largest difference in position, in m. Infinite if the numbers overflow.
    pub worst_error: f64,
    /// Difference in position at the end, in m. Infinite if the numbers overflow.
    pub end_error: f64,
}

impl Trajectory {
    /// Time in seconds at which the numbers overflowed, if they did.
    pub(crate) fn overflow(&self) -> Option<f64> {
        (self.states.len() < self.truth.len()).then_some(self.states.len() as f64 * self.h)
    }

    /// Differences in position from the true motion, in m.
    pub(crate) fn errors(&self) -> impl Iterator<Item = f64> {
        self.states.iter().zip(&self.truth).map(|(state, truth)| state.x - truth.x)
    }
}

/// Number of steps of `h` that reach `end`, rounded up. Returns an error if `h` or `end` is not positive, and for more
/// steps than memory should hold.
pub(crate) fn step_count(h: f64, end: f64) -> Result<usize> {
    if !(h > 0.0 && h.is_finite()) {
        return Err(Error::value("steps", format!("a step must be longer than 0 s, got {h}")));
    }
    if !(end > 0.0 && end.is_finite()) {
        return Err(Error::value("end", format!("must be later than 0 s, got {end}")));
    }
    let steps = (end / h - 1e-9).ceil().max(1.0);
    if steps > MOST_STEPS as f64 {
        let message = format!(
            "{end} s in steps of {h} s are {steps:.0} steps; at most {MOST_STEPS} fit in memory: choose a step of at \
             least {:.3e} s or an earlier end",
            end / MOST_STEPS as f64
        );
        return Err(Error::value("steps", message));
    }
    Ok(steps as usize)
}

/// The true states for [`run_against`]: at `0, h, …` up to `end` seconds.
pub(crate) fn truth(system: &System, start: State, h: f64, end: f64) -> Result<Vec<State>> {
    if !start.is_finite() {
        return Err(Error::value("start", "position and velocity must be finite numbers"));
    }
    reference::states(system, start, h, step_count(h, end)?)
}

/// Runs `method` from `start` at time 0 to `end` seconds.
pub fn run(method: Method, system: &System, start: State, h: f64, end: f64) -> Result<Trajectory> {
    run_against(method, system, h, truth(system, start, h, end)?)
}

/// Runs `method` from the first state in `truth`, with as many steps as there are states in `truth`.
pub(crate) fn run_against(method: Method, system: &System, h: f64, truth: Vec<State>) -> Result<Trajectory> {
    let integrator = method.integrator(system, h)?;
    let mut states = Vec::with_capacity(truth.len());
    let mut state = truth.first().copied().unwrap_or_default();
    states.push(state);
    for n in 1..truth.len() {
        state = integrator.step(state, (n - 1) as f64 * h)?;
        if !state.is_finite() {
            break;
        }
        states.push(state);
    }
    let mut run = Trajectory { method, h, states, truth, worst_error: f64::INFINITY, end_error: f64::INFINITY };
    if run.overflow().is_none() {
        run.worst_error = run.errors().fold(0.0, |worst, error| error.abs().max(worst));
        run.end_error = run.errors().last().unwrap_or(0.0).abs();
    }
    Ok(run)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::energy::Energy;
    use libm::{pow, sqrt};

    fn spring() -> (System, State) {
        (System::linear(1.0, 50.0, 0.0).unwrap(), State { x: 0.5, v: 0.0 })
    }

    /// Energy after `steps` steps of `omega_h` rad relative to the initial energy, and the smallest and largest ratio
    /// on the way.
    fn energies(method: Method, omega_h: f64, steps: usize) -> (f64, f64, f64) {
        let (system, start) = spring();
        let h = omega_h / sqrt(50.0);
        let integrator = method.integrator(&system, h).unwrap();
        let first = Energy::of(&system, start).total();
        let (mut state, mut least, mut greatest) = (start, 1.0_f64, 1.0_f64);
        for n in 0..steps {
            state = integrator.step(state, n as f64 * h).unwrap();
            let ratio = Energy::of(&system, state).total() / first;
            (least, greatest) = (least.min(ratio), greatest.max(ratio));
        }
        (Energy::of(&system, state).total() / first, least, greatest)
    }

    #[test]
    fn explicit_euler_grows_and_implicit_euler_shrinks_at_their_known_rates() {
        let growth = pow(1.0 + 0.1 * 0.1, 1000.0);
        let (explicit, _, _) = energies(Method::ExplicitEuler, 0.1, 1000);
        let (implicit, _, _) = energies(Method::ImplicitEuler, 0.1, 1000);
        assert!((explicit / growth - 1.0).abs() < 1e-9, "{explicit}");
        assert!((implicit * growth - 1.0).abs() < 1e-9, "{implicit}");
    }

    #[test]
    fn symplectic_methods_keep_the_energy_within_a_bound_over_a_million_steps() {
        for omega_h in [0.1, 1.0] {
            for method in [Method::SymplecticEuler, Method::SymplecticEulerPositionFirst, Method::Verlet] {
                let (_, least, greatest) = energies(method, omega_h, 1_000_000);
                // The orbit is an ellipse of the modified energy: axes in the ratio of 1 ± ωh/2, squared and halved for
                // Verlet.
                let bound = (1.0 + 0.5 * omega_h) / (1.0 - 0.5 * omega_h);
                assert!(least > 0.999 / bound && greatest < 1.001 * bound, "{method:?}: {least} … {greatest}");
            }
        }
        for method in [Method::SynthExact, Method::Exponential] {
            let (_, least, greatest) = energies(method, 0.1, 1_000_000);
            assert!(least > 1.0 - 1e-9 && greatest < 1.0 + 1e-9, "{method:?}: {least} … {greatest}");
        }
    }

    #[test]
    fn runge_kutta_shrinks_at_its_known_rate() {
        for omega_h in [0.2, 0.5, 1.0] {
            let (last, _, _) = energies(Method::RungeKutta4, omega_h, 1000);
            let z = omega_h * omega_h;
            let known = pow(1.0 - z * z * z / 72.0 + z * z * z * z / 576.0, 1000.0);
            assert!(last < 1.0 && (last / known - 1.0).abs() < 1e-9, "{omega_h}: {last} {known}");
        }
    }

    #[test]
    fn the_notebook_figures_come_out() {
        let (system, start) = spring();
        for (h, count) in [(0.01, 501), (0.05, 101), (0.15, 35)] {
            let explicit = run(Method::ExplicitEuler, &system, start, h, 5.0).unwrap();
            assert_eq!((explicit.states.len(), explicit.truth.len()), (count, count));
            assert!(explicit.worst_error > 1.0, "explodes: {}", explicit.worst_error);
            let implicit = run(Method::ImplicitEuler, &system, start, h, 5.0).unwrap();
            assert!(implicit.states.last().unwrap().x.abs() < 0.25, "shrinks");
            assert!(run(Method::SynthExact, &system, start, h, 5.0).unwrap().worst_error < 1e-12);
        }
    }

    #[test]
    fn an_overflow_is_told() {
        let (system, start) = spring();
        let run = run(Method::SymplecticEuler, &system, start, 1.0, 2000.0).unwrap();
        assert!(run.overflow().is_some() && run.worst_error == f64::INFINITY);
        assert!(run.states.iter().all(State::is_finite));
    }

    #[test]
    fn step_counts_that_cannot_be_are_errors() {
        for (h, end, says) in [
            (0.0, 5.0, "longer than 0"),
            (-0.1, 5.0, "longer than 0"),
            (f64::NAN, 5.0, "longer than 0"),
            (0.1, 0.0, "end: must be later"),
            (1e-12, 5.0, "fit in memory"),
            (1e-300, 1e300, "fit in memory"),
        ] {
            let message = step_count(h, end).unwrap_err().to_string();
            assert!(message.contains(says), "{message}");
        }
        assert_eq!(step_count(0.01, 5.0).unwrap(), 500);
        assert_eq!(step_count(0.15, 5.0).unwrap(), 34);
    }
}
