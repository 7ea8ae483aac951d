//! A single mass on its spring.

use super::material::LN_1000;
use super::partial::{Pair, Partial};
use std::f64::consts::PI;

pub(super) fn partials() -> Vec<Partial> {
    vec![Partial::new(1.0, Pair::Directions, |_| 1.0)]
}

/// Frequency in Hz and T60 in seconds of a mass in kg with a damper in N·s/m on a spring in N/m; `None` if it does not
/// ring.
///
/// `x″ + 2λ x′ + ω₀² x = 0` with `λ = c/2m` and `ω₀² = k/m` rings at `√(ω₀² − λ²)` and decays as `e^(−λ t)`. At
/// critical damping and above it does not ring, so a mode cannot represent it.
pub fn ringing(mass: f64, damping: f64, stiffness: f64) -> Option<(f64, f64)> {
    let lambda = damping / (2.0 * mass);
    let omega2 = stiffness / mass - lambda * lambda;
    let rings = mass > 0.0 && damping >= 0.0 && omega2 > 0.0 && omega2.is_finite();
    rings.then(|| (omega2.sqrt() / (2.0 * PI), LN_1000 / lambda))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mass_rings_as_its_equation_says() {
        let (frequency, t60) = ringing(0.01, 0.02, 1000.0).unwrap();
        assert!((frequency - (1e5_f64 - 1.0).sqrt() / (2.0 * PI)).abs() < 1e-9);
        assert!((t60 - LN_1000).abs() < 1e-12);
        assert_eq!(ringing(1.0, 0.0, 1.0).unwrap().1, f64::INFINITY);
        for (mass, damping, stiffness) in
            [(1.0, 2.0, 1.0), (1.0, 5.0, 1.0), (0.0, 0.0, 1.0), (1.0, -1.0, 1.0), (f64::NAN, 0.0, 1.0)]
        {
            assert_eq!(ringing(mass, damping, stiffness), None);
        }
    }
}
