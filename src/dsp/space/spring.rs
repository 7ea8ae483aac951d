//! A spring reverb's tank: helical springs side by side.

use super::material::Material;
use super::modes::{BodyMode, ModeSet};
use libm::{cos, sin, sqrt};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Helical springs with the same wire and coil, driven at one end, with pick-ups at the other.
///
/// A coil's pitch is small, so a wave along the wire bends it as it would bend a ring of the coil's radius `R`:
/// `ω = κ β |β² − q²| / √(β² + q²)` with the wavenumber `β`, the curvature `q = 1/R` and `κ = (r/2) √(E/ρ)` for a wire of
/// radius `r` (A. E. H. Love, *Mathematical Theory of Elasticity*, §293, for rings; W. H. Wittrick 1966 and S. Bilbao and
/// J. Parker, "A virtual model of spring reverberation", IEEE TASLP 18 (2010), for springs). Between free ends
/// `β = nπ/L`. Long waves travel slower the nearer they are to the transition frequency `0.337 κ q² / 2π`: their echoes
/// chirp. Short waves above it arrive sooner and are fainter. Waves of about a turn's length are left out, since they are
/// missing in spectrograms of springs: they move whole turns and hardly move the magnets at the ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Lengths of the springs' wires, uncoiled, in m. The first spring is on the left, the last on the right.
    pub wires: [f64; 3],
    /// Radius of the wire in m.
    pub wire_radius: f64,
    /// Radius of the coil in m.
    pub coil_radius: f64,
    /// The material of the wire.
    pub material: Material,
    /// Modes up to this frequency in Hz are kept.
    pub top: f64,
}

impl Default for Spring {
    /// A guitar amplifier's tank with three springs.
    fn default() -> Self {
        Self {
            wires: [5.1, 6.3, 5.7],
            wire_radius: 0.000_175,
            coil_radius: 0.0027,
            material: Material::STEEL,
            top: 10_000.0,
        }
    }
}

/// Lowest frequency in Hz of modes that are kept.
const LOWEST: f64 = 20.0;

/// `(√17 − 3)/4`: the value of `z = (βR)²` at which `√(z (1−z)²/(1+z))`, and so the frequency of waves longer than a turn,
/// is greatest.
const LONG: f64 = 0.280_776_406_404_415_1;

/// Response of the magnets to waves shorter than a turn, relative to longer ones.
const SHORT_WAVES: f64 = 0.5;

/// Upper limit of the half waves: no spring whose modes are kept has more.
const MOST_HALF_WAVES: usize = 65_536;

impl Spring {
    fn stiffness(&self) -> f64 {
        0.5 * self.wire_radius * self.material.bar_speed()
    }

    /// Frequency in Hz above which all waves are shorter than a turn.
    pub(crate) fn transition_frequency(&self) -> f64 {
        sqrt(LONG / (1.0 + LONG)) * (1.0 - LONG) * self.stiffness() / (self.coil_radius * self.coil_radius * TAU)
    }

    fn frequency(&self, wavenumber: f64) -> f64 {
        let (beta2, curvature2) = (wavenumber * wavenumber, 1.0 / (self.coil_radius * self.coil_radius));
        self.stiffness() * wavenumber * (beta2 - curvature2).abs() / (sqrt(beta2 + curvature2) * TAU)
    }

    /// The modes. Not for the audio thread.
    pub fn modes(&self) -> ModeSet {
        let (mut modes, transition) = (Vec::new(), self.transition_frequency());
        for (spring, wire) in self.wires.into_iter().enumerate() {
            let angle = FRAC_PI_2 * spring as f64 / (self.wires.len() - 1) as f64;
            for n in 1..MOST_HALF_WAVES {
                let wavenumber = n as f64 * PI / wire;
                let (frequency, turns) = (self.frequency(wavenumber), wavenumber * self.coil_radius);
                if turns > 1.0 && frequency > self.top || !frequency.is_finite() {
                    break;
                }
                let long = turns < sqrt(LONG);
                let heard = long || turns > 1.0 && frequency > transition;
                if !heard || !(LOWEST..=self.top).contains(&frequency) {
                    continue;
                }
                // The shape of a mode is cos 0 at the driven free end and cos nπ at the other.
                let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
                let drive = if long { 1.0 } else { SHORT_WAVES };
                modes.push(BodyMode { frequency, drive, left: sign * cos(angle), right: sign * sin(angle) });
            }
        }
        ModeSet::new(modes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn springs_have_both_kinds_of_waves() {
        let spring = Spring::default();
        let modes = spring.modes();
        // Bilbao and Parker give 3 r √(E/ρ) / (16 √5 π R²).
        let published = 3.0 * spring.wire_radius * spring.material.bar_speed()
            / (16.0 * sqrt(5.0) * PI * spring.coil_radius * spring.coil_radius);
        let transition = spring.transition_frequency();
        assert!((transition / published - 1.0).abs() < 0.02, "{transition} Hz, {published} Hz");
        let above = modes.modes().iter().filter(|mode| mode.frequency > transition).count();
        assert!(above > 100 && modes.len() > 1000, "{above} of {} modes above", modes.len());
    }

    #[test]
    fn springs_of_any_size_are_made() {
        for wires in [[0.0; 3], [1e9, 1.0, 1.0], [-1.0; 3]] {
            assert!(Spring { wires, ..Spring::default() }.modes().len() <= super::super::MAX_MODES);
        }
    }
}
