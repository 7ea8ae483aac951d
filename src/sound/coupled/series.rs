//! Two bodies in series: the first drives the second, but the second does not act on the first.

use super::complex::Complex;
use super::mode::{BodyMode, CoupledMode};

/// Poles of the two bodies are moved apart if their distance is below this share of the faster decay rate.
const APART: f64 = 1e-3;

pub(super) fn modes(first: &[BodyMode], second: &[BodyMode], stiffness: f64) -> Vec<CoupledMode> {
    let second = moved_apart(first, second);
    let driver = |mode: &BodyMode| {
        let along = transfer(&second, pole(mode), |mode| mode.joint * mode.pickup);
        let scale = Complex::new(0.0, -1.0 / mode.angular_frequency);
        CoupledMode {
            strike: [Complex::new(mode.strike, 0.0), Complex::ZERO],
            pickup: [scale.scale(mode.pickup), scale * along.scale(stiffness * mode.joint)],
            ..CoupledMode::free(mode.angular_frequency, mode.decay_rate, [0.0; 2], [0.0; 2])
        }
    };
    let driven = |mode: &BodyMode| {
        let along = transfer(first, pole(mode), |mode| mode.joint * mode.strike);
        let own = CoupledMode::free(mode.angular_frequency, mode.decay_rate, [0.0, mode.strike], [0.0, mode.pickup]);
        CoupledMode { strike: [along.scale(stiffness * mode.joint), own.strike[1]], ..own }
    };
    first.iter().map(driver).chain(second.iter().map(driven)).collect()
}

fn pole(mode: &BodyMode) -> Complex {
    Complex::new(-mode.decay_rate, mode.angular_frequency)
}

/// `Σ shape / q_k(s)`.
fn transfer(modes: &[BodyMode], s: Complex, shape: impl Fn(&BodyMode) -> f64) -> Complex {
    modes.iter().fold(Complex::ZERO, |sum, mode| {
        let from = s - pole(mode);
        let q = from * Complex::new(from.re, from.im + 2.0 * mode.angular_frequency);
        sum + q.reciprocal().scale(shape(mode))
    })
}

/// The second body's modes, each moved to a distance of at least [`APART`] from each mode of the first.
fn moved_apart(first: &[BodyMode], second: &[BodyMode]) -> Vec<BodyMode> {
    let apart = |mode: &BodyMode| {
        let mut mode = *mode;
        // Moves upwards past one mode after another, at most once for each mode of the first body.
        for _ in 0..=first.len() {
            let least = |other: &BodyMode| {
                let rate = mode.decay_rate.max(other.decay_rate);
                (APART * rate).max(1e-9 * mode.angular_frequency)
            };
            let near = first.iter().find(|other| (pole(&mode) - pole(other)).norm() < least(other));
            let Some(near) = near else { break };
            mode.angular_frequency = near.angular_frequency + 1.5 * least(near);
        }
        mode
    };
    second.iter().map(apart).collect()
}
