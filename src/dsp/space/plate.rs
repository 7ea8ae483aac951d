//! A plate reverb's sheet: every mode of a thin rectangular plate.

use super::material::Material;
use super::modes::{BodyMode, MAX_MODES, ModeSet};
use libm::{ceil, sin, sqrt};
use std::f64::consts::PI;

/// A thin rectangular plate, simply supported at its edges, with one force as the drive and two velocity pick-ups.
///
/// The modes are those of Kirchhoff's equation `u_tt = −κ² ∇⁴u`, in closed form: `ω = κ π² ((m/Lx)² + (n/Ly)²)` with the
/// shape `sin(mπx/Lx) sin(nπy/Ly)` (A. W. Leissa, *Vibration of Plates*, NASA SP-160, 1969, §4.1; S. Bilbao, *Numerical
/// Sound Synthesis*, 2009, §12.1). Their number per hertz is constant, and a force moves the velocity of each equally: so
/// the plate does not favour any frequency, and its highest frequencies arrive first.
///
/// ```
/// use sprung::internals::space::{Decay, ModalReverb, Plate, Resonator};
///
/// let sheet = Plate::default().modes().leak();
/// assert!(sheet.len() > 12_900, "every mode up to 10 kHz");
///
/// let mut reverb = ModalReverb::new(Resonator::new(sheet, Decay { low: 3.0, high: 1.0 }, 48_000.0));
/// reverb.set_mix(0.3);
/// reverb.reset();
/// let (mut left, mut right) = (vec![0.0; 480], vec![0.0; 480]);
/// left[0] = 1.0;
/// reverb.process(&mut left, &mut right);
/// assert!(right.iter().any(|sample| *sample != 0.0) && !reverb.is_silent());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plate {
    /// Length in m.
    pub length: f64,
    /// Width in m.
    pub width: f64,
    /// Thickness in m.
    pub thickness: f64,
    /// The material.
    pub material: Material,
    /// Point of the drive, as fractions of length and width.
    pub drive: [f64; 2],
    /// Points of the left and the right pick-up, likewise.
    pub pick_ups: [[f64; 2]; 2],
    /// Modes up to this frequency in Hz are kept.
    pub top: f64,
}

impl Default for Plate {
    /// The sheet of the classic studio plate: steel, 2 m × 1 m × 0.5 mm, all modes up to 10 kHz.
    fn default() -> Self {
        Self {
            length: 2.0,
            width: 1.0,
            thickness: 0.0005,
            material: Material::STEEL,
            // Not on any line of symmetry, so that few modes have a node there.
            drive: [0.437, 0.381],
            pick_ups: [[0.123, 0.683], [0.851, 0.287]],
            top: 10_000.0,
        }
    }
}

impl Plate {
    /// The modes. Not for the audio thread.
    pub fn modes(&self) -> ModeSet {
        let stiffness = self.material.plate_stiffness(self.thickness);
        let scale = 0.5 * PI * stiffness;
        let along = 1.0 / (self.length * self.length);
        let across = 1.0 / (self.width * self.width);
        // For a body with far too many modes, those that would be dropped are not computed: `N ≈ Lx Ly k²/4π`.
        let area = self.length * self.width;
        let top = self.top.min(stiffness * 4.0 * MAX_MODES as f64 / area);
        let most = |step: f64| {
            let count = ceil(sqrt(top / (scale * step)));
            if count.is_finite() { (count.max(0.0) as usize).min(MOST_HALF_WAVES) } else { 0 }
        };
        let shapes = |count: usize, axis: usize| -> Vec<[f64; 3]> {
            let places = [self.drive[axis], self.pick_ups[0][axis], self.pick_ups[1][axis]];
            (1..=count).map(|m| places.map(|place| sin(m as f64 * PI * place))).collect()
        };
        let (columns, rows) = (shapes(most(along), 0), shapes(most(across), 1));
        let mut modes = Vec::new();
        for (m, column) in (1..).map(f64::from).zip(&columns) {
            for (n, row) in (1..).map(f64::from).zip(&rows) {
                let frequency = scale * (m * m * along + n * n * across);
                if frequency > top {
                    break;
                }
                let [drive, left, right] = std::array::from_fn(|place| column[place] * row[place]);
                modes.push(BodyMode { frequency, drive, left, right });
            }
        }
        ModeSet::new(modes)
    }

    /// The expected number of modes below a frequency in Hz: Weyl's law with its terms for edges and corners,
    /// `N = Lx Ly k²/4π − (Lx + Ly) k/2π + ¼` at the wavenumber `k = √(ω/κ)`.
    #[cfg(test)]
    fn expected_modes_below(&self, frequency: f64) -> f64 {
        let wavenumber2 = 2.0 * PI * frequency / self.material.plate_stiffness(self.thickness);
        let area = self.length * self.width * wavenumber2 / (4.0 * PI);
        area - (self.length + self.width) * sqrt(wavenumber2) / (2.0 * PI) + 0.25
    }
}

/// Upper limit of the half waves along an edge: no plate whose modes are kept has more.
const MOST_HALF_WAVES: usize = 4096;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mode_is_there() {
        let plate = Plate::default();
        let modes = plate.modes();
        for frequency in [500.0, 2000.0, 5000.0, 10_000.0] {
            let count = modes.modes().iter().filter(|mode| mode.frequency <= frequency).count() as f64;
            let expected = plate.expected_modes_below(frequency);
            assert!((count / expected - 1.0).abs() < 0.01, "{count} modes below {frequency} Hz, {expected} expected");
        }
        assert!((12_900..13_200).contains(&modes.len()), "{}", modes.len());
        assert!((plate.material.plate_stiffness(plate.thickness) - 0.7637).abs() < 1e-3);
        let lowest = modes.modes()[0].frequency;
        assert!((lowest - 0.5 * PI * 0.7637 * 1.25).abs() < 0.01, "{lowest} Hz");
    }

    #[test]
    fn plates_of_any_size_are_made() {
        for (length, width, thickness) in [(30.0, 30.0, 1e-4), (0.01, 0.01, 0.01), (0.0, 1.0, 0.001), (1.0, 1.0, 0.0)] {
            let plate = Plate { length, width, thickness, ..Plate::default() };
            assert!(plate.modes().len() <= MAX_MODES);
        }
    }
}
