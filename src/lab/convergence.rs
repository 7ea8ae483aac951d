//! Error against step size, and the order of accuracy fitted to it.

use super::method::Method;
use super::system::{State, System};
use super::trajectory::{run_against, truth};
use crate::error::{Error, Result};
use libm::{exp, log};

/// A method's errors over a list of steps.
#[derive(Clone, Debug)]
pub struct Convergence {
    /// The method.
    pub method: Method,
    /// One per step, as given.
    pub points: Vec<Point>,
    /// Slope of log error over log step; `None` if fewer than three errors are clearly larger than rounding.
    pub order: Option<f64>,
}

/// The error of one step size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Step in seconds.
    pub h: f64,
    /// Largest position error of the run, in m.
    pub error: f64,
    /// Error that rounding alone can cause in as many steps, in m.
    pub rounding: f64,
    /// Whether the order is fitted to this point.
    pub fitted: bool,
}

/// `count` step sizes in seconds, each half of the one before; the first is `longest`.
pub fn halving(longest: f64, count: i32) -> Vec<f64> {
    (0..count).map(|n| longest * exp(-f64::from(n) * std::f64::consts::LN_2)).collect()
}

/// Measures each method at each step from `start` to `end` seconds.
pub fn converge(
    methods: &[Method],
    system: &System,
    start: State,
    steps: &[f64],
    end: f64,
) -> Result<Vec<Convergence>> {
    if steps.len() < 3 {
        return Err(Error::value("steps", format!("need at least 3 to fit an order to, got {}", steps.len())));
    }
    let mut points = vec![Vec::with_capacity(steps.len()); methods.len()];
    for &h in steps {
        let truth = truth(system, start, h, end)?;
        let size = truth.iter().fold(0.0_f64, |size, state| size.max(state.x.abs()));
        for (points, method) in points.iter_mut().zip(methods) {
            // One rounding per step, times a factor because a step has several operations. The seed computes the share
            // of velocity lost per step, 1 − exp(…), in single precision.
            let precision =
                if *method == Method::SynthSeed { 0.5 * f64::from(f32::EPSILON) } else { 8.0 * f64::EPSILON };
            let rounding = precision * truth.len() as f64 * size;
            let error = run_against(*method, system, h, truth.clone())?.worst_error;
            points.push(Point { h, error, rounding, fitted: error > 4.0 * rounding && error < size });
        }
    }
    Ok(methods.iter().zip(points).map(|(method, points)| fit(*method, points)).collect())
}

fn fit(method: Method, points: Vec<Point>) -> Convergence {
    let fitted: Vec<(f64, f64)> = points.iter().filter(|p| p.fitted).map(|p| (log(p.h), log(p.error))).collect();
    let order = (fitted.len() >= 3).then(|| slope(&fitted));
    Convergence { method, points, order }
}

/// Least-squares slope of `y` over `x`.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (mean_x, mean_y) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let covariance: f64 = points.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    covariance / points.iter().map(|(x, _)| (x - mean_x) * (x - mean_x)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::method::Order;
    use crate::lab::system::{Force, Spring};

    fn orders(system: &System, end: f64) -> Vec<(Method, Option<f64>, f64)> {
        let methods: Vec<_> =
            Method::ALL.into_iter().filter(|method| method.integrator(system, 0.01).is_ok()).collect();
        converge(&methods, system, State { x: 0.5, v: 0.0 }, &halving(0.01, 10), end)
            .unwrap()
            .into_iter()
            .map(|c| (c.method, c.order, c.points.iter().fold(0.0, |worst, p| p.error.max(worst))))
            .collect()
    }

    #[test]
    fn fitted_orders_are_the_known_ones() {
        for damping in [0.0, 2.0, 20.0] {
            for (method, order, worst) in orders(&System::linear(1.0, 50.0, damping).unwrap(), 1.0) {
                match (method.order(), order) {
                    (Order::Power(power), Some(order)) => {
                        assert!((order - f64::from(power)).abs() < 0.1, "{method:?}, damping {damping}: {order}");
                    }
                    (Order::Exact, None) => assert!(worst < 1e-10, "{method:?}, damping {damping}: {worst:e}"),
                    other => panic!("{method:?}, damping {damping}: {other:?}"),
                }
            }
        }
    }

    /// A force makes the exact methods second order and does not change the order of the others. So does a nonlinear
    /// spring.
    #[test]
    fn orders_hold_with_a_force_and_on_nonlinear_springs() {
        let force = Force { amplitude: 5.0, frequency: 0.9, phase: 0.5 };
        let forced = System { force, target: 0.1, ..System::linear(1.0, 50.0, 1.0).unwrap() };
        let duffing = System { spring: Spring::Duffing { cubic: 100.0 }, ..forced };
        let pendulum = System { spring: Spring::Pendulum, ..forced };
        for system in [forced, duffing, pendulum] {
            for (method, order, _) in orders(&system, 0.5) {
                let expected = if let Order::Power(power) = method.order() { f64::from(power) } else { 2.0 };
                let order = order.unwrap_or(f64::NAN);
                assert!((order - expected).abs() < 0.1, "{method:?} on {:?}: {order}", system.spring);
            }
        }
    }

    #[test]
    fn too_few_steps_are_an_error() {
        let system = System::linear(1.0, 50.0, 0.0).unwrap();
        assert!(converge(&Method::ALL, &system, State { x: 0.5, v: 0.0 }, &[0.1, 0.05], 1.0).is_err());
    }
}
