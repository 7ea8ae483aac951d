//! Materials: stiffness, density, and how fast vibrations in them decay.

use crate::dsp::coefficients::LN_MINUS_60_DB;
use libm::pow;
use std::f64::consts::PI;

/// `ln 1000`: the level has fallen by 60 dB when `rate · time` reaches this value.
pub(crate) const LN_1000: f64 = -LN_MINUS_60_DB;

/// Decay rate of a mode's amplitude, in 1/s: `b0 + b1 · f^power`, with f in Hz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// The part that is the same for all modes: supports, and the air where it matters.
    pub b0: f64,
    /// The part that grows with frequency.
    pub b1: f64,
    /// The exponent: 1 for a loss factor, ½ for friction of air at a wall, 2 for strings.
    pub power: f64,
}

impl Loss {
    /// The loss of a material with loss factor η, plus `b0`: a mode's amplitude decays at the rate `π η f` (Cremer,
    /// Heckl and Petersson, "Structure-Borne Sound": T60 = 2.2 / (η f)).
    pub(crate) const fn factor(eta: f64, b0: f64) -> Self {
        Self { b0, b1: PI * eta, power: 1.0 }
    }

    /// The decay rate at a frequency in Hz, in 1/s.
    pub(crate) fn rate(&self, frequency: f64) -> f64 {
        self.b0 + self.b1 * pow(frequency, self.power)
    }
}

/// A material that bodies are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Its name in presets.
    pub id: &'static str,
    /// Density in kg/m³.
    pub density: f64,
    /// Young's modulus in Pa; for wood, along the grain.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// How fast vibrations in it decay.
    pub loss: Loss,
}

const fn solid(id: &'static str, density: f64, young: f64, poisson: f64, loss: Loss) -> Material {
    Material { id, density, young, poisson, loss }
}

/// The materials that presets can name. Densities and moduli are handbook values. Loss factors of metals, glass and
/// rubber lie in the ranges of Cremer, Heckl and Petersson's table of materials (aluminium 1e-4, steel 2e-4 to 6e-4,
/// brass below 1e-3, glass 0.6e-3 to 2e-3); those of woods and nylon lie in published ranges. `b0` depends on how a
/// body is held; its values are our own choice. So are both parts of skin and mylar, where most of the loss is to the
/// air.
pub const MATERIALS: &[Material] = &[
    solid("steel", 7850.0, 2.0e11, 0.28, Loss::factor(2e-4, 0.3)),
    solid("aluminium", 2700.0, 7.0e10, 0.33, Loss::factor(1e-4, 0.5)),
    solid("brass", 8500.0, 1.04e11, 0.35, Loss::factor(4e-4, 0.3)),
    solid("bronze", 8600.0, 1.05e11, 0.34, Loss::factor(4e-4, 0.1)),
    solid("glass", 2500.0, 6.5e10, 0.22, Loss::factor(1e-3, 0.3)),
    solid("porcelain", 2400.0, 7.0e10, 0.2, Loss::factor(2e-3, 1.0)),
    solid("rosewood", 900.0, 2.0e10, 0.3, Loss::factor(5e-3, 0.5)),
    solid("maple", 700.0, 1.2e10, 0.3, Loss::factor(9e-3, 2.0)),
    solid("spruce", 430.0, 1.2e10, 0.3, Loss::factor(8e-3, 5.0)),
    solid("plastic", 1180.0, 3.2e9, 0.35, Loss::factor(3e-2, 5.0)),
    solid("rubber", 1100.0, 5.0e6, 0.49, Loss::factor(2e-1, 10.0)),
    solid("skin", 1000.0, 3.0e9, 0.35, Loss::factor(1.5e-2, 8.0)),
    solid("mylar", 1390.0, 4.5e9, 0.38, Loss::factor(2e-3, 1.0)),
    solid("nylon", 1120.0, 4.5e9, 0.39, Loss { b0: 1.0, b1: 1.5e-6, power: 2.0 }),
    // The wires of a snare drum: steel that rattles on a head.
    solid("snare_wire", 7850.0, 2.0e11, 0.28, Loss::factor(4e-4, 12.0)),
    // A C4 piano string: b1 + b2 (2πf/c)² with b1 = 1.1, b2 = 2.7e-4, c = 329.6 m/s (Bensa, Bilbao, Kronland-Martinet and
    // Smith 2003, table I).
    solid("wire", 7850.0, 2.0e11, 0.28, Loss { b0: 1.1, b1: 9.811_9e-8, power: 2.0 }),
    // Friction and heat at the wall of a pipe of 1 cm radius: the wave decays by 1.2e-5 √ω / a per metre (Fletcher and
    // Rossing, chapter 8), which is 1.2e-5 · √(2π f) / 0.01 · 343 per second. `b0` is the sound radiated from the open
    // end.
    solid("air", 1.2, 1.42e5, 0.0, Loss { b0: 2.0, b1: 1.031_7, power: 0.5 }),
];

impl Material {
    /// Finds the material with this name.
    pub(crate) fn find(id: &str) -> Option<&'static Self> {
        MATERIALS.iter().find(|material| material.id == id)
    }

    /// Speed of longitudinal waves in a thin bar, in m/s: √(E/ρ).
    pub(super) fn bar_speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    /// `κ = √(E h² / (12 ρ (1−ν²)))`, in m²/s: a plate of thickness `h` has `ω = κ k²` (Kirchhoff 1850).
    pub(super) fn plate_stiffness(&self, thickness: f64) -> f64 {
        self.bar_speed() * thickness / (12.0 * (1.0 - self.poisson * self.poisson)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_factor_is_the_t60_that_the_book_says() {
        let loss = Loss::factor(1e-3, 0.0);
        for frequency in [100.0, 440.0, 5000.0] {
            assert!((LN_1000 / loss.rate(frequency) * 1e-3 * frequency / 2.2 - 1.0).abs() < 1e-3);
        }
        assert!((LN_1000 - libm::log(1000.0)).abs() < 1e-15);
    }

    #[test]
    fn derived_figures_are_what_their_sources_give() {
        let k = 2.0 * PI / 329.6;
        assert!((Material::find("wire").unwrap().loss.b1 / (2.7e-4 * k * k) - 1.0).abs() < 1e-4);
        let wall = 1.2e-5 * (2.0 * PI).sqrt() / 0.01 * 343.0;
        assert!((Material::find("air").unwrap().loss.b1 / wall - 1.0).abs() < 1e-4);
    }

    #[test]
    fn names_are_found_once() {
        for material in MATERIALS {
            assert_eq!(Material::find(material.id), Some(material));
            assert!(material.poisson < 0.5 && material.loss.rate(1.0) > 0.0);
        }
        assert_eq!(Material::find("cheese"), None);
    }
}
