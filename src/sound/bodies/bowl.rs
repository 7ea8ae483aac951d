//! A singing bowl: half a sphere with a wall of even thickness. Also the ratios of a ring, which bells start from.

use super::partial::{Pair, Partial};
use libm::{cos, pow, tan};
use std::f64::consts::PI;

/// Lord Rayleigh, "On the infinitesimal bending of surfaces of revolution" (1881; "The Theory of Sound", §235): the
/// wall of a sphere bends without stretching. At the polar angle φ it moves tangentially round the axis by `sin φ
/// tan^s(φ/2) sin sθ`, along the meridian by `−sin φ tan^s(φ/2) cos sθ` and outwards by `(s + cos φ) tan^s(φ/2) cos
/// sθ`. Half a sphere has the ratios 1 : 2.8102 : 5.4316. Strike and pickup use the outward movement; `x` is φ, from
/// the bottom (0) to the rim (1).
pub(super) fn partials(count: usize) -> Vec<Partial> {
    let first = omega(2, moving(2));
    let modes = (2..2 + count as u32).map(|s| (s, moving(s))).map(|(s, moving)| (s, moving, omega(s, moving) / first));
    // Integrals of higher and higher powers take long, and such high modes are inaudible.
    let modes = modes.take_while(|(.., ratio)| *ratio <= HIGHEST);
    let partial = |(s, moving, ratio): (u32, f64, f64)| {
        // The mean over the half sphere, whose area is 2π; cos² and sin² of s θ have the mean ½.
        let scale = (2.0 / moving).sqrt();
        let out = move |x: f64| {
            let phi = 0.5 * PI * x;
            (f64::from(s) + cos(phi)) * pow(tan(0.5 * phi), f64::from(s))
        };
        Partial::new(ratio, Pair::Diameters(s), move |at| scale * out(at.x))
    };
    modes.map(partial).collect()
}

/// Modes with a higher ratio are left out.
const HIGHEST: f64 = 1000.0;

/// `ω² ∝ (s³ − s)² ∫ tan^2s(φ/2) / sin³φ dφ / ∫ ((s + cos φ)² + 2 sin²φ) tan^2s(φ/2) sin φ dφ`, from 0 to π/2. With `t
/// = tan(φ/2)` the first integral is a polynomial; `moving` is the second.
fn omega(s: u32, moving: f64) -> f64 {
    let s = f64::from(s);
    let bending = 0.25 * (1.0 / (2.0 * s - 2.0) + 1.0 / s + 1.0 / (2.0 * s + 2.0));
    (s * s * s - s) * (bending / moving).sqrt()
}

/// The second integral, by Simpson's rule in `y = tan²(φ/2)`: `2 ∫ y^s ((s + 1 + (s − 1) y)² + 8 y) / (1 + y)⁴ dy` from
/// 0 to 1. The number of points grows with `s`.
fn moving(s: u32) -> f64 {
    let (steps, s) = (32 * (2 + s as usize), f64::from(s));
    let term = |i: usize| {
        let y = i as f64 / steps as f64;
        let (out, whole) = (s + 1.0 + (s - 1.0) * y, (1.0 + y) * (1.0 + y));
        let value = 2.0 * pow(y, s) * (out * out + 8.0 * y) / (whole * whole);
        value * if i == 0 || i == steps { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 }
    };
    (0..=steps).map(term).sum::<f64>() / (3.0 * steps as f64)
}

/// Ratio of a ring's mode with `n` nodal diameters to its lowest mode, `n = 2`: `ω ∝ n (n² − 1) / √(n² + 1)` (Hoppe
/// 1871; Rayleigh, "The Theory of Sound", §233).
pub(super) fn ring_ratio(n: u32) -> f64 {
    let omega = |n: f64| n * (n * n - 1.0) / (n * n + 1.0).sqrt();
    omega(f64::from(n)) / omega(2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_sphere_has_the_ratios_that_rayleigh_gives() {
        let ratio = |s: u32| omega(s, moving(s)) / omega(2, moving(2));
        assert!((ratio(3) - 2.8102).abs() < 1e-4);
        assert!((ratio(4) - 5.4316).abs() < 1e-4);
    }
}
