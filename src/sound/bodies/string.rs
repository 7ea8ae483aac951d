//! A string between two fixed ends.

use super::material::Material;
use super::partial::{Pair, Partial};
use super::size::Size;
use libm::sin;
use std::f64::consts::{PI, SQRT_2};

/// Integer ratios, with shapes `√2 sin(n π x)`. Its stiffness is applied by the law for all bodies
/// ([`super::Body::inharmonicity`]), which is that of strings.
pub(super) fn partials(count: usize) -> Vec<Partial> {
    let partial = |n: usize| {
        let n = n as f64;
        Partial::new(n, Pair::Directions, move |at| SQRT_2 * sin(n * PI * at.x))
    };
    (1..=count).map(partial).collect()
}

/// Lowest frequency in Hz without stiffness: `f₁ = √(T/μ) / 2L`, with `μ = ρ π d²/4` (Mersenne 1636, Taylor 1713).
pub(super) fn frequency(size: &Size, material: &Material) -> f64 {
    (size.tension / mass_per_length(size, material)).sqrt() / (2.0 * size.length)
}

fn mass_per_length(size: &Size, material: &Material) -> f64 {
    material.density * 0.25 * PI * size.thickness * size.thickness
}

/// `B = π³ E d⁴ / (64 T L²)` (Fletcher 1964, "Normal vibration frequencies of a stiff piano string").
pub(super) fn inharmonicity(size: &Size, material: &Material) -> f64 {
    let d2 = size.thickness * size.thickness;
    PI * PI * PI * material.young * d2 * d2 / (64.0 * size.tension * size.length * size.length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piano_string_has_the_pitch_and_stiffness_of_its_size() {
        // C4 of a grand piano (Fletcher and Rossing, chapter 12): about 62 cm long, 1 mm thick, 670 N.
        let size = Size { length: 0.62, thickness: 1.0e-3, tension: 670.0 };
        let wire = Material::find("wire").unwrap();
        assert!((frequency(&size, wire) - 265.8).abs() < 0.2);
        assert!((inharmonicity(&size, wire) - 3.76e-4).abs() < 2e-6);
    }
}
