//! The exact motion of a linear spring, in every damping regime: the reference for all methods.
//!
//! Source: "Damped Harmonic Oscillator", its general form `(I τ₀ + M τ₁) e^(−λ̄t)` with `M = [[λ̄, 1], [−ω², −λ̄]]` and
//! `σ² = λ̄² − ω²`. `τ₀` and `τ₁` are the even and the odd part of `e^(σt)`, the latter divided by `σ`: `cos κt`, `1`
//! or `cosh αt`, and `sin κt/κ`, `t` or `sinh αt/α`.

use super::system::{State, System};
use crate::error::{Error, Result};
use libm::{cos, exp, expm1, sin, sqrt};
use std::f64::consts::TAU;

/// `σ² = λ̄² − ω²`; negative if the system rings.
fn sigma_squared(system: &System) -> f64 {
    system.decay_rate() * system.decay_rate() - system.stiffness / system.mass
}

/// The matrix that maps `(x − target, v)` at one time to a later time, without a force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Transition {
    rows: [[f64; 2]; 2],
    /// `τ₁ e^(−λ̄t)`: the displacement per unit of initial velocity.
    pub reach: f64,
}

impl Transition {
    /// The transition of a linear system over `t` seconds.
    pub(crate) fn over(system: &System, t: f64) -> Self {
        let lambda = system.decay_rate();
        let omega_squared = system.stiffness / system.mass;
        let squared = sigma_squared(system);
        let scale = sqrt(squared.abs());
        // Both are multiplied by e^(−λ̄t) analytically, so that a large cosh or sinh does not overflow before the
        // product is taken.
        let (tau0, tau1) = if squared < 0.0 {
            let decay = exp(-lambda * t);
            (decay * cos(scale * t), decay * sin(scale * t) / scale)
        } else if squared > 0.0 {
            let slow = exp(-omega_squared / (lambda + scale) * t);
            let shrink = expm1(-2.0 * scale * t);
            (slow * (1.0 + 0.5 * shrink), -slow * shrink / (2.0 * scale))
        } else {
            let decay = exp(-lambda * t);
            (decay, decay * t)
        };
        Self { rows: [[tau0 + lambda * tau1, tau1], [-omega_squared * tau1, tau0 - lambda * tau1]], reach: tau1 }
    }

    /// The state after this time, from the displacement `d = x − target` and the velocity.
    #[inline]
    pub(crate) fn apply(&self, d: f64, v: f64) -> (f64, f64) {
        let [[a, b], [c, e]] = self.rows;
        (a * d + b * v, c * d + e * v)
    }
}

/// The exact motion from a state at time 0, with a force.
#[derive(Clone, Copy, Debug)]
pub struct ClosedForm {
    system: System,
    /// The initial state minus that of the forced motion.
    free: State,
}

impl ClosedForm {
    /// The motion of a linear `system` from `start`. Returns an error for a spring that has no closed form here.
    ///
    /// The forced part is exact. Within a relative 1e−8 of an undamped resonance, but not exactly on it, it loses
    /// digits.
    pub fn new(system: &System, start: State) -> Result<Self> {
        if !system.is_linear() {
            return Err(Error::value("spring", "has no closed form unless it is linear"));
        }
        let forced = forced_motion(system, 0.0);
        Ok(Self { system: *system, free: State { x: start.x - system.target - forced.x, v: start.v - forced.v } })
    }

    /// The state at `t` seconds.
    pub(crate) fn at(&self, t: f64) -> State {
        let (d, v) = Transition::over(&self.system, t).apply(self.free.x, self.free.v);
        let forced = forced_motion(&self.system, t);
        State { x: self.system.target + d + forced.x, v: v + forced.v }
    }
}

/// A motion that satisfies the equation with the force, with any initial state, as `d` and `v`.
fn forced_motion(system: &System, t: f64) -> State {
    let (m, c, k) = (system.mass, system.damping, system.stiffness);
    let force = system.force;
    if force.amplitude == 0.0 {
        return State::default();
    }
    let omega = TAU * force.frequency;
    // X = F / (k − mΩ² + i c Ω), the complex amplitude of the response to F e^(i(Ωt+φ)).
    let (re, im) = (k - m * omega * omega, c * omega);
    let size = re * re + im * im;
    let (sine, cosine) = (sin(omega * t + force.phase), cos(omega * t + force.phase));
    let f = force.amplitude;
    if size > 0.0 && (im > 0.0 || re.abs() > 1e-12 * k) {
        State { x: f * (re * cosine + im * sine) / size, v: omega * f * (im * cosine - re * sine) / size }
    } else if omega > 0.0 {
        // Undamped resonance: the amplitude grows with t.
        let growth = 0.5 * f / (m * omega);
        State { x: growth * t * sine, v: growth * (sine + omega * t * cosine) }
    } else if c > 0.0 {
        // A constant force on an unsprung mass: the terminal velocity.
        State { x: f * cosine / c * t, v: f * cosine / c }
    } else {
        State { x: 0.5 * f * cosine / m * t * t, v: f * cosine / m * t }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::system::Force;

    /// Stiffness and damping in each regime: undamped, under-, critically and over-damped, without a spring, without either.
    const REGIMES: [[f64; 2]; 6] = [[50.0, 0.0], [50.0, 0.8], [16.0, 8.0], [16.0, 20.0], [0.0, 3.0], [0.0, 0.0]];

    /// The motion must satisfy its own equation, `m ẍ + c ẋ + k (x − target) = f(t)`, and begin with the given state.
    #[test]
    fn the_equation_of_motion_holds_in_every_regime_with_and_without_a_force() {
        let start = State { x: 0.4, v: -0.6 };
        let resonance = 50.0_f64.sqrt() / TAU;
        for [k, c] in REGIMES {
            let plain = System::linear(1.0, k, c).unwrap();
            for (amplitude, frequency) in [(0.0, 0.0), (2.0, 0.0), (2.0, 0.7), (2.0, resonance)] {
                let force = Force { amplitude, frequency, phase: 0.3 };
                let system = System { target: 0.1, force, ..plain };
                let motion = ClosedForm::new(&system, start).unwrap();
                assert!((motion.at(0.0).x - start.x).abs() < 1e-14 && (motion.at(0.0).v - start.v).abs() < 1e-14);
                for t in [0.1, 0.73, 3.9] {
                    let (h, here) = (1e-4, motion.at(t));
                    let (before, after) = (motion.at(t - h), motion.at(t + h));
                    let (slope, acceleration) = ((after.x - before.x) / (2.0 * h), (after.v - before.v) / (2.0 * h));
                    assert!((slope - here.v).abs() < 1e-5, "{k}, {c}, force {amplitude} at {frequency}");
                    assert!((acceleration - system.acceleration(here, t)).abs() < 1e-4, "{k}, {c}, {amplitude}");
                }
            }
        }
    }

    #[test]
    fn special_cases_are_the_published_ones() {
        let (x0, v0, t) = (0.4, -0.6, 1.7);
        let at = |k: f64, c: f64| {
            ClosedForm::new(&System::linear(1.0, k, c).unwrap(), State { x: x0, v: v0 }).unwrap().at(t)
        };
        let check = |got: State, x: f64, v: f64| {
            assert!((got.x - x).abs() < 1e-14 && (got.v - v).abs() < 1e-13, "{got:?} {x} {v}");
        };
        let omega = sqrt(50.0);
        let (s, c) = (sin(omega * t), cos(omega * t));
        check(at(50.0, 0.0), x0 * c + v0 * s / omega, -omega * s * x0 + c * v0);
        check(at(0.0, 3.0), x0 + v0 * (1.0 - exp(-3.0 * t)) / 3.0, v0 * exp(-3.0 * t));
        check(at(0.0, 0.0), x0 + v0 * t, v0);
        let e = exp(-4.0 * t);
        check(at(16.0, 8.0), e * ((1.0 + 4.0 * t) * x0 + t * v0), e * (-16.0 * t * x0 + (1.0 - 4.0 * t) * v0));
    }

    #[test]
    fn heavy_damping_does_not_overflow() {
        let system = System::linear(1.0, 1.0, 1e6).unwrap();
        let state = ClosedForm::new(&system, State { x: 1.0, v: 0.0 }).unwrap().at(1e6);
        assert!((state.x - exp(-1.0)).abs() < 1e-9, "{state:?}");
    }
}
