//! Beds: dense modes with a statistical law, for a drum's shell, a box, snare wires, a cymbal's wash, breath.

use super::partial::{Pair, Partial};
use crate::dsp::random::{key, uniform};
use libm::{cos, exp, log, pow, sin};
use std::f64::consts::{PI, SQRT_2};

/// The kind of bed, which sets its name, starting values and material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BedKind {
    /// A drum's shell: a wooden cylinder.
    Shell,
    /// A box: its walls and the air in it.
    Box,
    /// The wires below a snare drum.
    Wires,
    /// The wash of a cymbal or gong.
    Wash,
    /// The noise of moving air: breath, wind, the tail of a room.
    Air,
}

/// A law for the density of modes over frequency. T60s follow from the material's loss, and levels from the body's
/// tilt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bed {
    /// The kind of bed.
    pub kind: BedKind,
    /// The lowest and the highest mode, as multiples of the body's frequency.
    pub low: f64,
    /// See `low`.
    pub high: f64,
    /// The number of modes per hertz is proportional to frequency to this power: −1 gives the same number in each octave,
    /// −½ is that of a bar, 0 of a plate or a string, 1 of a membrane or a shallow space, 2 of a room (Weyl 1912; Kuttruff,
    /// "Room Acoustics", chapter 3).
    pub density: f64,
}

impl Bed {
    /// The bed with its starting values, which are our own choice.
    pub(crate) const fn new(kind: BedKind) -> Self {
        let (low, high, density) = match kind {
            BedKind::Shell => (1.0, 14.0, -0.5),
            BedKind::Box => (1.0, 20.0, 0.5),
            BedKind::Wires => (5.0, 60.0, -0.3),
            BedKind::Wash => (1.0, 60.0, 0.0),
            BedKind::Air => (0.5, 40.0, -0.5),
        };
        Self { kind, low, high, density }
    }
}

/// Divides the integral of the density law into `count` equal parts and places one mode at random in each, since the modes
/// of real plates and rooms keep similar distances. A shape is a plane wave of random direction and phase, with `k ∝ √f`
/// as in bending waves; a mode of an irregular body is a sum of many such waves (Berry 1977).
pub(super) fn partials(bed: &Bed, seed: u64, count: usize) -> Vec<Partial> {
    let (low, high) = (bed.low.min(bed.high), bed.high.max(bed.low));
    let partial = |n: usize| {
        let stream = key(seed, n as u64);
        let random = |which: u64| f64::from(uniform(stream, which));
        let share = (n as f64 + 0.5 + 0.5 * random(0)) / count as f64;
        let ratio = quantile(low, high, bed.density + 1.0, share);
        let (direction, phase) = (PI * random(1), PI * random(2));
        let k = 2.0 * PI * ratio.sqrt();
        let (kx, ky) = (k * cos(direction), k * sin(direction));
        Partial::new(ratio, Pair::Single, move |at| SQRT_2 * cos(kx * at.x + ky * at.y + phase))
    };
    (0..count).map(partial).collect()
}

/// The `f` at which the integral of `f^(power − 1)` from `low` has reached this share of the integral up to `high`.
fn quantile(low: f64, high: f64, power: f64, share: f64) -> f64 {
    // Both formulas are equal at power 0, near which the second one loses its digits.
    let octaves = log(high / low);
    if (power * octaves).abs() < 1e-6 {
        return low * exp(octaves * share);
    }
    let (a, b) = (pow(low, power), pow(high, power));
    pow(a + (b - a) * share, 1.0 / power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn density_follows_the_law() {
        for (density, below) in [(-1.0, 500), (0.0, 90), (1.0, 9), (2.0, 1)] {
            let bed = Bed { low: 1.0, high: 100.0, density, ..Bed::new(BedKind::Wash) };
            let partials = partials(&bed, 7, 1000);
            assert!(partials.is_sorted_by(|a, b| a.ratio <= b.ratio));
            let found = partials.iter().filter(|partial| partial.ratio < 10.0).count();
            assert!(found.abs_diff(below) <= 2, "{density}: {found}");
            assert!(partials.iter().all(|partial| (1.0..=100.0 + 1e-9).contains(&partial.ratio)));
        }
    }
}
