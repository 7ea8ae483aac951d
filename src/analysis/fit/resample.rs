//! Reads a sound between its samples.

use libm::{cos, sin};
use std::f64::consts::PI;

/// Samples to each side that count, and places between two samples that are tabulated.
const REACH: usize = 16;
const PLACES: usize = 256;

/// Reads a sound at any time, by sines cardinal under a Hann window.
pub(super) struct Reader<'a> {
    samples: &'a [f32],
    /// The weights of the samples for each place, and those for the last place plus one.
    weights: Vec<[f64; 2 * REACH]>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(samples: &'a [f32]) -> Self {
        let weight = |distance: f64| {
            let x = PI * distance;
            let sine = if x.abs() < 1e-9 { 1.0 } else { sin(x) / x };
            sine * (0.5 + 0.5 * cos(x / REACH as f64))
        };
        let place = |place: usize| {
            std::array::from_fn(|n| weight(n as f64 + 1.0 - REACH as f64 - place as f64 / PLACES as f64))
        };
        Self { samples, weights: (0..=PLACES).map(place).collect() }
    }

    /// The sound at a time in samples, 0 or later.
    pub(super) fn at(&self, time: f64) -> f64 {
        let at = time as usize;
        let place = (time - at as f64) * PLACES as f64;
        let (before, part) = (place as usize, place.fract());
        let (a, b) = (&self.weights[before], &self.weights[before + 1]);
        let sample = |n: usize| (at + n + 1).checked_sub(REACH).and_then(|index| self.samples.get(index)).copied();
        (0..2 * REACH).map(|n| f64::from(sample(n).unwrap_or(0.0)) * (a[n] + part * (b[n] - a[n]))).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_is_read_between_its_samples() {
        let samples: Vec<f32> = (0..400).map(|n| sin(1.9 * f64::from(n)) as f32).collect();
        let reader = Reader::new(&samples);
        for n in 0..300 {
            let time = 50.0 + 0.937 * f64::from(n);
            let off = (reader.at(time) - sin(1.9 * time)).abs();
            assert!(off < 2e-3, "{time}: {off}");
        }
    }
}
