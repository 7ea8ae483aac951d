//! A small rectangular room: its modes.

use super::modes::{BodyMode, ModeSet};
use crate::dsp::random::{key, uniform};
use libm::{cos, sqrt};
use std::f64::consts::PI;

/// A rectangular room with rigid walls, a source and two ears.
///
/// `f = c/2 √((l/Lx)² + (m/Ly)² + (n/Lz)²)`, shapes `cos(lπx/Lx) cos(mπy/Ly) cos(nπz/Lz)` (P. M. Morse and K. U. Ingard,
/// *Theoretical Acoustics*, 1968, §9.5; H. Kuttruff, *Room Acoustics*, §3.2). A source with a flat free field drives each
/// mode in inverse proportion to its frequency.
///
/// Above Schroeder's frequency modes overlap more than threefold, and the ear perceives their density and not single modes.
/// Where there are more than 1.3 modes per hertz, a random selection of them, with higher levels, represents all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Length, width and height in m.
    pub size: [f64; 3],
    /// Position of the source, as fractions of the size.
    pub source: [f64; 3],
    /// Positions of the left and the right ear, likewise.
    pub ears: [[f64; 3]; 2],
    /// Modes up to this frequency in Hz are kept.
    pub top: f64,
}

impl Default for Room {
    /// A studio's drum booth.
    fn default() -> Self {
        Self {
            size: [3.1, 2.4, 2.2],
            source: [0.23, 0.31, 0.37],
            ears: [[0.71, 0.43, 0.61], [0.77, 0.69, 0.61]],
            top: 10_000.0,
        }
    }
}

/// Speed of sound in m/s, at 20 °C.
const SPEED_OF_SOUND: f64 = 343.2;

/// Modes per hertz above which a selection represents all modes.
const DENSITY: f64 = 1.3;

/// Largest room, in m³. It is limited because all modes are counted one by one.
const LARGEST: f64 = 200.0;

impl Room {
    /// The expected number of modes below a frequency in Hz: `4πV/3 (f/c)³ + πS/4 (f/c)² + L/8 (f/c)` with the room's
    /// volume, surface and edges (R. H. Bolt 1939; Kuttruff, eq. 3.21).
    #[cfg(test)]
    fn expected_modes_below(&self, frequency: f64) -> f64 {
        let ([a, b, c], per_metre) = (self.size, frequency / SPEED_OF_SOUND);
        let (volume, surface, edges) = (a * b * c, 2.0 * (a * b + b * c + c * a), 4.0 * (a + b + c));
        ((4.0 / 3.0 * PI * volume * per_metre + 0.25 * PI * surface) * per_metre + 0.125 * edges) * per_metre
    }

    /// The modes; none if the volume is above 200 m³ or a side is not 0.1 to 100 m. Not for the audio thread: takes up to
    /// a second.
    pub fn modes(&self) -> ModeSet {
        let volume = self.size.iter().product::<f64>();
        if !(volume > 0.0 && volume <= LARGEST) || self.size.iter().any(|size| !(0.1..=100.0).contains(size)) {
            return ModeSet::new([]);
        }
        let top = self.top.clamp(0.0, 24_000.0);
        let axes: [Vec<[f64; 4]>; 3] = std::array::from_fn(|axis| {
            let step = 0.5 * SPEED_OF_SOUND / self.size[axis];
            let places = [self.source[axis], self.ears[0][axis], self.ears[1][axis]];
            let shape = |n: usize| {
                let [source, left, right] = places.map(|place| cos(n as f64 * PI * place));
                [step * n as f64 * step * n as f64, source, left, right]
            };
            (0..).map(shape).take_while(|[squared, ..]| *squared <= top * top).collect()
        });
        // `dN/df` of all modes is `per_hertz2 · f²`, by the first term of their number.
        let per_hertz2 = 4.0 * PI * volume / (SPEED_OF_SOUND * SPEED_OF_SOUND * SPEED_OF_SOUND);
        let (choice, mut serial) = (key(0, 0), 0);
        let mut modes = Vec::new();
        for a in &axes[0] {
            for b in &axes[1] {
                for c in &axes[2] {
                    let squared = a[0] + b[0] + c[0];
                    if squared > top * top {
                        break;
                    }
                    serial += 1;
                    let share = (DENSITY / (per_hertz2 * squared)).min(1.0);
                    let chance = 0.5 * (1.0 + f64::from(uniform(choice, serial)));
                    if squared == 0.0 || chance >= share {
                        continue;
                    }
                    let frequency = sqrt(squared);
                    let drive = a[1] * b[1] * c[1] / (frequency * sqrt(share));
                    modes.push(BodyMode { frequency, drive, left: a[2] * b[2] * c[2], right: a[3] * b[3] * c[3] });
                }
            }
        }
        ModeSet::new(modes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn low_modes_are_all_there_and_high_ones_are_chosen() {
        let room = Room::default();
        let modes = room.modes();
        let count = modes.modes().iter().filter(|mode| mode.frequency <= 350.0).count() as f64;
        let expected = room.expected_modes_below(350.0);
        assert!((count / expected - 1.0).abs() < 0.05, "{count} modes, {expected} expected");
        assert!((modes.modes()[0].frequency - 0.5 * SPEED_OF_SOUND / 3.1).abs() < 1e-9);
        assert!((10_000..14_000).contains(&modes.len()), "{}", modes.len());
        let octave = |from: f64| modes.modes().iter().filter(|m| (from..2.0 * from).contains(&m.frequency)).count();
        for from in [1000.0, 2000.0, 4000.0] {
            let density = octave(from) as f64 / from;
            assert!((density / DENSITY - 1.0).abs() < 0.1, "{density} a hertz above {from} Hz");
        }
    }

    #[test]
    fn rooms_of_any_size_are_made() {
        for size in [[0.0; 3], [1e3; 3], [-1.0, -1.0, 2.0], [f64::NAN; 3]] {
            assert!(Room { size, ..Room::default() }.modes().is_empty());
        }
    }
}
