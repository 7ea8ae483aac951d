//! The longest step with which a method stays stable.
//!
//! Runs each method to find the region of `ω·h` and damping ratio `ζ` in which it stays bounded, and computes the
//! theoretical limit.

use super::amplification::Amplification;
use super::method::Method;
use super::system::System;
use crate::error::{Error, Result};
use libm::{exp, hypot, sqrt};

/// Longest `ω·h` that is tried. A method that is still stable there counts as stable for every step.
pub(crate) const LONGEST: f64 = 100.0;
/// Shortest `ω·h` that is tried. A method that is unstable there counts as never stable.
pub(crate) const SHORTEST: f64 = 0.01;

/// One method with one step and one damping ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Undamped angle per step in rad.
    pub omega_h: f64,
    /// Damping ratio `c / 2√(km)`.
    pub zeta: f64,
    /// Growth in nepers per step; NaN if the method refuses the step.
    pub growth: f64,
    /// Whether every state stays bounded.
    pub bounded: bool,
}

/// The matrix of a step of `omega_h` for a spring with `ω = 1`, `m = 1` and damping ratio `zeta`.
fn amplification(method: Method, omega_h: f64, zeta: f64) -> Result<Amplification> {
    Amplification::of(method, &System::linear(1.0, 1.0, 2.0 * zeta)?, omega_h)
}

/// Runs a method at one point of the plane. A step that the method refuses counts as bounded, since it is not an
/// explosion. (The synth refuses whole half turns, and steps after which rounding leaves no velocity.)
///
/// # Errors
/// [`Error::Value`] for a step that is not positive, and for a negative damping ratio.
pub fn cell(method: Method, omega_h: f64, zeta: f64) -> Result<Cell> {
    if !(omega_h > 0.0 && omega_h.is_finite()) {
        return Err(Error::value("omega_h", format!("must be greater than 0 rad, got {omega_h}")));
    }
    check(zeta)?;
    Ok(amplification(method, omega_h, zeta).map_or(Cell { omega_h, zeta, growth: f64::NAN, bounded: true }, |step| {
        Cell { omega_h, zeta, growth: step.growth(), bounded: step.is_bounded() }
    }))
}

fn check(zeta: f64) -> Result<()> {
    if zeta >= 0.0 && zeta.is_finite() {
        return Ok(());
    }
    Err(Error::value("zeta", format!("a damping ratio must be 0 or more, got {zeta}")))
}

/// The largest `ω·h` with which a method stays bounded, found numerically: 0 if it never does, infinite if it always
/// does.
pub fn limit(method: Method, zeta: f64) -> Result<f64> {
    check(zeta)?;
    // As in [`cell`], a step that the method refuses is not an explosion.
    let explodes = |omega_h: f64| amplification(method, omega_h, zeta).is_ok_and(|step| !step.is_bounded());
    Ok(first(explodes, 1.02))
}

/// The first value of `ω·h` between [`SHORTEST`] and [`LONGEST`] for which `explodes` is true, searched in steps of
/// `ratio` and then by bisection. 0 if it is true from the start, infinite if it is never true.
fn first(explodes: impl Fn(f64) -> bool, ratio: f64) -> f64 {
    if explodes(SHORTEST) {
        return 0.0;
    }
    let mut outside = SHORTEST;
    while !explodes(outside) {
        outside *= ratio;
        if outside > LONGEST {
            return f64::INFINITY;
        }
    }
    let mut inside = outside / ratio;
    for _ in 0..50 {
        let middle = 0.5 * (inside + outside);
        *(if explodes(middle) { &mut outside } else { &mut inside }) = middle;
    }
    inside
}

/// The limit of `ω·h` according to theory: 0 if never stable, infinite if always stable.
pub fn theory(method: Method, zeta: f64) -> f64 {
    match method {
        // |1 + z| < 1 for both eigenvalues z = ωh (−ζ ± √(ζ²−1)).
        Method::ExplicitEuler if zeta <= 1.0 => 2.0 * zeta,
        Method::ExplicitEuler => 2.0 / (zeta + sqrt(zeta * zeta - 1.0)),
        Method::ImplicitEuler | Method::ChouImplicit | Method::SynthExact | Method::Exponential => f64::INFINITY,
        // Jury criterion: trace > −(1 + det) with det = 1 − 2ζωh, trace = 2 − 2ζωh − (ωh)².
        Method::SymplecticEuler | Method::SymplecticEulerPositionFirst | Method::ChouSemiImplicit => {
            2.0 / (sqrt(zeta * zeta + 1.0) + zeta)
        }
        Method::Heun => polynomial_limit(zeta, &[1.0, 1.0, 0.5]),
        Method::RungeKutta4 => polynomial_limit(zeta, &[1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0]),
        // The same with det = 1 − ζ₂, trace = 2 − ζ₂ − (ωh)², ζ₂ = 2 (1 − e^(−ζωh)): ωh = 2 e^(−ζωh/2).
        Method::SynthSeed => first(|omega_h| omega_h > 2.0 * exp(-0.5 * zeta * omega_h), 1.02),
        Method::Verlet => 2.0,
    }
}

/// The first `ω·h` at which a stability polynomial `R` exceeds `|R(z)| = 1`, for eigenvalues `z` with damping ratio
/// `zeta`.
fn polynomial_limit(zeta: f64, coefficients: &[f64]) -> f64 {
    let size = |re: f64, im: f64| {
        let (value_re, value_im) = coefficients
            .iter()
            .rev()
            .fold((0.0, 0.0), |(a, b), coefficient| (a * re - b * im + coefficient, a * im + b * re));
        hypot(value_re, value_im)
    };
    let largest = |omega_h: f64| {
        if zeta <= 1.0 {
            size(-zeta * omega_h, sqrt(1.0 - zeta * zeta) * omega_h)
        } else {
            let spread = sqrt(zeta * zeta - 1.0);
            size(-(zeta + spread) * omega_h, 0.0).max(size(-omega_h / (zeta + spread), 0.0))
        }
    };
    // The threshold lies above rounding errors and below Heun's (ωh)⁴/8.
    first(|omega_h| largest(omega_h) > 1.0 + 1e-12, 1.02)
}

/// Evenly spaced values from `from` to `to`, both included.
pub fn spaced(from: f64, to: f64, count: usize) -> Vec<f64> {
    let last = count.max(2) - 1;
    (0..=last).map(|n| from + (to - from) * n as f64 / last as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::system::State;

    #[test]
    fn undamped_limits_are_the_known_ones_within_a_percent() {
        for (method, known) in [
            (Method::ExplicitEuler, 0.0),
            (Method::ImplicitEuler, f64::INFINITY),
            (Method::SymplecticEuler, 2.0),
            (Method::SymplecticEulerPositionFirst, 2.0),
            (Method::Heun, 0.0),
            (Method::RungeKutta4, 2.0 * sqrt(2.0)),
            (Method::ChouSemiImplicit, 2.0),
            (Method::ChouImplicit, f64::INFINITY),
            (Method::SynthSeed, 2.0),
            (Method::SynthExact, f64::INFINITY),
            (Method::Verlet, 2.0),
            (Method::Exponential, f64::INFINITY),
        ] {
            let found = limit(method, 0.0).unwrap();
            assert!(found == known || (found / known - 1.0).abs() < 0.01, "{method:?}: {found}, known {known}");
            let theory = theory(method, 0.0);
            assert!(theory == known || (theory / known - 1.0).abs() < 1e-6, "{method:?}: theory {theory}");
        }
    }

    #[test]
    fn damped_limits_are_those_of_theory() {
        for method in Method::ALL {
            for zeta in [0.05, 0.3, 0.9, 1.0, 1.4] {
                let (found, theory) = (limit(method, zeta).unwrap(), theory(method, zeta));
                assert!(found == theory || (found / theory - 1.0).abs() < 0.01, "{method:?} {zeta}: {found} {theory}");
            }
        }
    }

    /// Compares the limits from the matrix with 200,000 plain steps on either side of each finite limit.
    #[test]
    fn runs_explode_beyond_the_limit_and_not_before() {
        for method in Method::ALL {
            let limit = limit(method, 0.1).unwrap();
            if !limit.is_finite() {
                continue;
            }
            let greatest = |omega_h: f64| {
                let integrator = method.integrator(&System::linear(1.0, 1.0, 0.2).unwrap(), omega_h).unwrap();
                let mut state = State { x: 1.0, v: 0.3 };
                (0..200_000).fold(0.0_f64, |most, n| {
                    state = integrator.step(state, f64::from(n) * omega_h).unwrap();
                    most.max(state.x.abs())
                })
            };
            assert!(greatest(0.99 * limit) < 100.0, "{method:?} below {limit}");
            assert!(greatest(1.01 * limit) > 1e6, "{method:?} above {limit}");
        }
    }

    #[test]
    fn a_step_that_is_refused_is_no_explosion() {
        for (omega_h, zeta) in [(std::f64::consts::PI, 0.0), (20.0, 1.0), (100.0, 2.0)] {
            let cell = cell(Method::SynthExact, omega_h, zeta).unwrap();
            assert!(cell.bounded && cell.growth.is_nan(), "{cell:?}");
        }
        assert!(cell(Method::SynthExact, 0.0, 0.5).unwrap_err().to_string().starts_with("omega_h:"));
    }

    #[test]
    fn a_negative_damping_ratio_is_an_error() {
        assert!(cell(Method::Heun, 0.5, -0.1).unwrap_err().to_string().contains("must be 0 or more"));
        assert!(limit(Method::Heun, -0.1).unwrap_err().to_string().contains("must be 0 or more"));
    }
}
