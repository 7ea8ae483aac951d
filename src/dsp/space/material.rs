//! The materials of bodies.

use libm::sqrt;

/// An elastic, isotropic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus in Pa.
    pub(crate) youngs_modulus: f64,
    /// Density in kg/m³.
    pub(crate) density: f64,
    /// Poisson's ratio.
    pub(crate) poissons_ratio: f64,
}

/// Figures: W. M. Haynes (ed.), *CRC Handbook of Chemistry and Physics*, and Fletcher and Rossing, *The Physics of
/// Musical Instruments* (1998), table of materials; rounded, since alloys differ by more.
impl Material {
    /// Cold-rolled steel, as in plates and springs.
    pub(crate) const STEEL: Self = Self::new(200e9, 7850.0, 0.30);
    /// Aluminium.
    pub(crate) const ALUMINIUM: Self = Self::new(70e9, 2700.0, 0.34);
    /// Gold, as in the foil of small plates.
    pub(crate) const GOLD: Self = Self::new(79e9, 19_300.0, 0.42);
    /// Bronze with a fifth of tin, as in bells and cymbals.
    pub(crate) const BRONZE: Self = Self::new(110e9, 8800.0, 0.34);
    /// Window glass.
    pub(crate) const GLASS: Self = Self::new(70e9, 2500.0, 0.22);

    const fn new(youngs_modulus: f64, density: f64, poissons_ratio: f64) -> Self {
        Self { youngs_modulus, density, poissons_ratio }
    }

    /// Speed of longitudinal waves in a thin bar, `√(E/ρ)`, in m/s.
    pub(crate) fn bar_speed(&self) -> f64 {
        sqrt(self.youngs_modulus / self.density)
    }

    /// Stiffness `κ = √(E h² / (12 ρ (1−ν²)))` of a sheet of thickness `h`, in m²/s (Bilbao, *Numerical Sound
    /// Synthesis*, 2009, §12.1).
    pub(crate) fn plate_stiffness(&self, thickness: f64) -> f64 {
        thickness * self.bar_speed() / sqrt(12.0 * (1.0 - self.poissons_ratio * self.poissons_ratio))
    }
}
