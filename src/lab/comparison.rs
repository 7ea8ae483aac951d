//! Compares several methods with several steps on one system, for the figure, the table and the report.

use super::energy::Energy;
use super::method::Method;
use super::system::{State, System};
use super::trajectory::{MOST_STEPS, Trajectory, run_against, step_count, truth};
use crate::error::{Error, Result};
use std::io::{self, Write};

/// The settings of a comparison.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The system.
    pub system: System,
    /// State at time 0.
    pub start: State,
    /// Seconds to integrate.
    pub end: f64,
    /// Step sizes in seconds.
    pub steps: Vec<f64>,
    /// The methods.
    pub methods: Vec<Method>,
}

/// All runs of a [`Setup`].
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The settings.
    pub setup: Setup,
    /// The true motion, finely sampled from time 0 to the end.
    pub truth: Vec<State>,
    /// Time between the samples of `truth`, in seconds.
    pub truth_step: f64,
    /// The runs of each method in the order of the setup, one per step.
    pub runs: Vec<Vec<Trajectory>>,
}

/// Minimum number of samples of the true motion in figures.
const FINE: f64 = 1000.0;

impl Comparison {
    /// Runs all methods with all steps. Returns an error for impossible values, for a method that cannot integrate the
    /// system, and for more states than memory should hold.
    pub fn new(setup: Setup) -> Result<Self> {
        let Setup { system, start, end, steps, methods } = &setup;
        system.validate()?;
        if steps.is_empty() || methods.is_empty() {
            return Err(Error::value(if steps.is_empty() { "steps" } else { "methods" }, "need at least one"));
        }
        let mut states = 0;
        for h in steps {
            states += (step_count(*h, *end)? + 1) * (methods.len() + 1);
        }
        if states > MOST_STEPS {
            let message = format!(
                "{} methods at these steps make {states} states; at most {MOST_STEPS} fit in memory: choose longer steps, \
                 fewer methods or an earlier end",
                methods.len()
            );
            return Err(Error::value("steps", message));
        }
        let mut runs = vec![Vec::with_capacity(steps.len()); methods.len()];
        for h in steps {
            let truth = truth(system, *start, *h, *end)?;
            for (runs, method) in runs.iter_mut().zip(methods) {
                runs.push(run_against(*method, system, *h, truth.clone())?);
            }
        }
        // Forty points per period draw a smooth curve.
        let turns = system.omega().unwrap_or(0.0) / std::f64::consts::TAU + system.force.frequency;
        let truth_step = end / (40.0 * turns * end).clamp(FINE, 50.0 * FINE).ceil();
        let truth = truth(system, *start, truth_step, *end)?;
        Ok(Self { truth, truth_step, runs, setup })
    }

    /// Largest distance of the true motion from 0, in m.
    pub fn size(&self) -> f64 {
        self.truth.iter().fold(0.0, |size, state| state.x.abs().max(size))
    }

    /// Energy at the end divided by the energy of the true motion at the end. Infinite if the numbers overflow, NaN if
    /// the true motion has no energy left.
    pub fn energy_ratio(&self, run: &Trajectory) -> f64 {
        if run.overflow().is_some() {
            return f64::INFINITY;
        }
        let total = |state: Option<&State>| Energy::of(&self.setup.system, *state.unwrap_or(&State::default())).total();
        let (got, truth) = (total(run.states.last()), total(run.truth.last()));
        if truth > 0.0 { got / truth } else { f64::NAN }
    }

    /// The factor by which the amplitude changes from the first to the last fifth of the run, divided by the same
    /// factor of the true motion. Above 1 it grows, below 1 it shrinks. Infinite if the numbers overflow.
    pub fn swell(&self, run: &Trajectory) -> f64 {
        if run.overflow().is_some() {
            return f64::INFINITY;
        }
        let target = self.setup.system.target;
        let reach = |states: &[State]| states.iter().fold(f64::MIN_POSITIVE, |most, s| (s.x - target).abs().max(most));
        let change = |states: &[State]| {
            let fifth = states.len().div_ceil(5);
            reach(&states[states.len() - fifth..]) / reach(&states[..fifth])
        };
        change(&run.states) / change(&run.truth)
    }

    /// Writes one row per method, step and state.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "method,step_s,t_s,x_m,v_m_per_s,true_x_m,true_v_m_per_s,error_m,energy_j")?;
        for run in self.runs.iter().flatten() {
            for (n, (state, truth)) in run.states.iter().zip(&run.truth).enumerate() {
                let energy = Energy::of(&self.setup.system, *state).total();
                let (key, h, t) = (run.method.key(), run.h, n as f64 * run.h);
                let error = state.x - truth.x;
                writeln!(out, "{key},{h},{t},{},{},{},{},{error},{energy}", state.x, state.v, truth.x, truth.v)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setup() -> Setup {
        Setup {
            system: System::linear(1.0, 50.0, 0.0).unwrap(),
            start: State { x: 0.5, v: 0.0 },
            end: 5.0,
            steps: vec![0.01, 0.05, 0.15],
            methods: Method::ALL.to_vec(),
        }
    }

    #[test]
    fn every_method_is_there_at_every_step() {
        let comparison = Comparison::new(setup()).unwrap();
        assert_eq!(comparison.runs.len(), 12);
        assert!(comparison.runs.iter().all(|runs| runs.len() == 3));
        assert!((comparison.size() - 0.5).abs() < 1e-12);
        let mut csv = Vec::new();
        comparison.write_csv(&mut csv).unwrap();
        let csv = String::from_utf8(csv).unwrap();
        assert_eq!(csv.lines().count(), 1 + 12 * (501 + 101 + 35));
        assert!(csv.contains("\nrk4,0.05,0,0.5,0,0.5,0,0,6.25\n"));
        let ratio = |method: usize| comparison.energy_ratio(&comparison.runs[method][0]);
        let swell = |method: usize| comparison.swell(&comparison.runs[method][0]);
        assert!(swell(0) > 1.5 && swell(1) < 0.6 && (swell(2) - 1.0).abs() < 0.01 && (swell(9) - 1.0).abs() < 1e-9);
        assert!(ratio(0) > 10.0 && ratio(1) < 0.1 && (ratio(9) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn what_cannot_be_compared_is_an_error() {
        for (setup, says) in [
            (Setup { steps: vec![], ..setup() }, "steps: need at least one"),
            (Setup { methods: vec![], ..setup() }, "methods: need at least one"),
            (Setup { steps: vec![1e-5], ..setup() }, "fit in memory"),
            (Setup { start: State { x: f64::NAN, v: 0.0 }, ..setup() }, "start:"),
        ] {
            let message = Comparison::new(setup).unwrap_err().to_string();
            assert!(message.contains(says), "{message}");
        }
    }
}
