//! Draws trajectories against the true motion, their differences, phase planes and energies: one row per method.

use super::super::comparison::Comparison;
use super::super::energy::Energy;
use super::super::system::State;
use super::super::trajectory::Trajectory;
use super::legend;
use crate::figure::panel::{Axis, Panel, Stroke, line};
use crate::figure::{Area, Drawn, Picture, colour, text};
use crate::text::number::short;
use plotters::prelude::*;
use std::ops::Range;

/// The figure of a comparison.
pub struct ComparisonFigure<'a>(pub &'a Comparison);

/// Height of a method's row in pixels.
const ROW: u32 = 230;
/// Maximum number of drawn states of a run.
const MOST_POINTS: usize = 5000;
/// Height of the title and legend.
const HEAD: u32 = 74;
/// Energies above this multiple of the largest true energy are outside the panel.
const ENERGY_SPAN: f64 = 2.5;

const TRUTH: Stroke = Stroke { colour: colour::INK, width: 1, dashed: false };

impl Picture for ComparisonFigure<'_> {
    fn size(&self) -> (u32, u32) {
        (1640, HEAD + ROW * self.0.runs.len() as u32)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<B> {
        let setup = &self.0.setup;
        let system = &setup.system;
        let title = format!(
            "A mass of {} kg on a spring of {} N/m, damping {} kg/s, from {} m and {} m/s",
            short(system.mass),
            short(system.stiffness),
            short(system.damping),
            short(setup.start.x),
            short(setup.start.v)
        );
        area.draw_text(&title, &text(20), (20, 10))?;
        let steps = setup.steps.iter().enumerate();
        let strokes = std::iter::once((TRUTH, "truth".to_owned()))
            .chain(steps.map(|(n, h)| (step_stroke(n), format!("steps of {} s", short(*h)))));
        for (n, entry) in strokes.enumerate() {
            legend(area, &[entry], (24 + 210 * n as i32, 54))?;
        }
        let (_, body) = area.split_vertically(HEAD);
        for (runs, row) in self.0.runs.iter().zip(body.split_evenly((self.0.runs.len(), 1))) {
            self.row(&row, runs)?;
        }
        Ok(())
    }
}

/// The stroke of the `n`-th step size.
fn step_stroke(n: usize) -> Stroke {
    let (colour, dashed) = colour::series(n);
    Stroke { colour, width: 2, dashed }
}

impl ComparisonFigure<'_> {
    fn row<B: DrawingBackend>(&self, area: &Area<B>, runs: &[Trajectory]) -> Drawn<B> {
        let comparison = self.0;
        let title = runs.first().map_or("", |run| run.method.title());
        let seconds = Axis::linear(0.0..comparison.setup.end, "time / s");
        let step = comparison.truth_step;
        let (positions, rest) = area.split_horizontally(500);
        let (differences, rest) = rest.split_horizontally(440);
        let (phase, energies) = rest.split_horizontally(300);

        let x = span(comparison.truth.iter().map(|state| state.x), 0.5);
        let panel = Panel { x: seconds.clone(), y: Axis::linear(x.clone(), "position / m"), title };
        let mut chart = panel.draw(&positions)?;
        for (n, run) in runs.iter().enumerate() {
            line(&mut chart, &over_time(&run.states, run.h, |s| s.x), step_stroke(n))?;
        }
        line(&mut chart, &over_time(&comparison.truth, step, |s| s.x), TRUTH)?;

        let most = runs.iter().map(|run| run.worst_error).fold(0.0, f64::max).min(3.0 * comparison.size()).max(1e-17);
        let panel = Panel {
            x: seconds.clone(),
            y: Axis::linear(-1.1 * most..1.1 * most, "difference / m"),
            title: "difference from the truth",
        };
        let mut chart = panel.draw(&differences)?;
        for (n, run) in runs.iter().enumerate() {
            let errors = run.errors().enumerate().step_by(stride(run.states.len()));
            let points: Vec<_> = errors.map(|(n, error)| (n as f64 * run.h, error)).collect();
            line(&mut chart, &points, step_stroke(n))?;
        }

        let v = span(comparison.truth.iter().map(|state| state.v), 0.5);
        let panel =
            Panel { x: Axis::linear(v, "velocity / (m/s)"), y: Axis::linear(x, "position / m"), title: "phase plane" };
        let mut chart = panel.draw(&phase)?;
        for (n, run) in runs.iter().enumerate() {
            line(&mut chart, &plane(&run.states), step_stroke(n))?;
        }
        line(&mut chart, &plane(&comparison.truth), TRUTH)?;

        let energy = |state: &State| Energy::of(&comparison.setup.system, *state).total();
        let greatest = comparison.truth.iter().map(energy).fold(f64::MIN_POSITIVE, f64::max);
        let panel =
            Panel { x: seconds, y: Axis::linear(0.0..ENERGY_SPAN * greatest, "energy / J"), title: "total energy" };
        let mut chart = panel.draw(&energies)?;
        for (n, run) in runs.iter().enumerate() {
            line(&mut chart, &over_time(&run.states, run.h, energy), step_stroke(n))?;
        }
        line(&mut chart, &over_time(&comparison.truth, step, energy), TRUTH)
    }
}

fn over_time(states: &[State], h: f64, value: impl Fn(&State) -> f64) -> Vec<(f64, f64)> {
    let stride = stride(states.len());
    states.iter().enumerate().step_by(stride).map(|(n, state)| (n as f64 * h, value(state))).collect()
}

/// Only every n-th state of a run is drawn: returns this n.
fn stride(states: usize) -> usize {
    states.div_ceil(MOST_POINTS).max(1)
}

/// Velocity to the right and position upwards, so that positions line up with the trajectory beside it.
fn plane(states: &[State]) -> Vec<(f64, f64)> {
    states.iter().step_by(stride(states.len())).map(|state| (state.v, state.x)).collect()
}

/// The range of some values, extended by a share of its length at either end; never empty.
fn span(values: impl Iterator<Item = f64>, share: f64) -> Range<f64> {
    let (low, high) =
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    let width = high - low;
    if width > 1e-9 * high.abs().max(1e-300) {
        low - share * width..high + share * width
    } else {
        low - low.abs().max(1.0)..high + high.abs().max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::comparison::Setup;
    use crate::lab::method::Method;
    use crate::lab::system::System;

    #[test]
    fn rows_and_units_are_drawn_also_of_a_mass_that_rests() {
        for x0 in [0.5, 0.0] {
            let setup = Setup {
                system: System::linear(1.0, 50.0, 0.0).unwrap(),
                start: State { x: x0, v: 0.0 },
                end: 2.0,
                steps: vec![0.05, 0.3],
                methods: vec![Method::ExplicitEuler, Method::SynthExact],
            };
            let comparison = Comparison::new(setup).unwrap();
            let document = crate::figure::svg(&ComparisonFigure(&comparison)).unwrap();
            for label in ["explicit Euler", "synth step, exact", "position / m", "energy / J", "steps of 0.3 s"] {
                assert!(document.contains(label), "{label}");
            }
        }
    }

    #[test]
    fn spans_are_never_empty() {
        assert_eq!(span([1.0, 3.0].into_iter(), 0.5), 0.0..4.0);
        assert_eq!(span([0.0, 0.0].into_iter(), 0.5), -1.0..1.0);
        assert_eq!(span([2.0].into_iter(), 0.1), 0.0..4.0);
    }
}
