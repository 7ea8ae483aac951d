//! The decay of a body's modes as a function of frequency.

use crate::dsp::coefficients::LN_MINUS_60_DB;
use libm::{exp2, log2};

/// T60 at low and at high frequencies, in seconds. Between 200 Hz and 6.4 kHz its logarithm follows a smooth step
/// over the logarithm of frequency; below and above it is constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decay {
    /// T60 up to `Decay::LOW_FREQUENCY`.
    pub low: f64,
    /// T60 from 6.4 kHz on.
    pub high: f64,
}

impl Decay {
    /// Upper end of the range of `low`, in Hz.
    pub(crate) const LOW_FREQUENCY: f64 = 200.0;
    /// Shortest and longest T60 in seconds. With longer ones, the rounding of single precision would change the decay.
    pub(crate) const RANGE: [f64; 2] = [0.05, 30.0];

    /// T60 in seconds at a frequency in Hz.
    pub fn t60_at(&self, frequency: f64) -> f64 {
        let Self { low, high } = self.clamped();
        exp2(log2(low) + f64::from(height_of_way(way(frequency) as f32)) * log2(high / low))
    }

    /// The values within [`Decay::RANGE`]; NaN becomes the shortest.
    fn clamped(&self) -> Self {
        let [shortest, longest] = Self::RANGE;
        let clamp = |t60: f64| if t60.is_nan() { shortest } else { t60.clamp(shortest, longest) };
        Self { low: clamp(self.low), high: clamp(self.high) }
    }

    /// The decay rate of amplitudes: base-2 logarithms of its value per frame at low frequencies, and of the ratio of its
    /// value at high frequencies to that.
    pub(super) fn log_rates(&self, sample_rate: f64) -> [f64; 2] {
        let Self { low, high } = self.clamped();
        [log2(-LN_MINUS_60_DB / (low * sample_rate)), log2(low / high)]
    }
}

/// Position of a frequency between low (0) and high (1) frequencies on a logarithmic scale. It is not clamped.
pub(super) fn way(frequency: f64) -> f64 {
    log2(frequency / Decay::LOW_FREQUENCY) / OCTAVES
}

/// The change of the position for a ratio of frequencies.
pub(super) fn shift(ratio: f64) -> f64 {
    log2(ratio) / OCTAVES
}

/// Octaves from low to high frequencies.
const OCTAVES: f64 = 5.0;

/// Weight of the high decay at a position, 0–1.
pub(super) fn height_of_way(way: f32) -> f32 {
    let way = way.clamp(0.0, 1.0);
    way * way * (3.0 - 2.0 * way)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_are_as_asked() {
        let decay = Decay { low: 4.0, high: 1.0 };
        assert!((decay.t60_at(100.0) - 4.0).abs() < 1e-12 && (decay.t60_at(9000.0) - 1.0).abs() < 1e-12);
        assert_eq!(6400.0, Decay::LOW_FREQUENCY * exp2(OCTAVES));
        assert!((decay.t60_at(1131.37) - 2.0).abs() < 1e-5, "the geometric mean halfway");
        let wild = Decay { low: f64::NAN, high: f64::INFINITY };
        assert_eq!([wild.t60_at(100.0), wild.t60_at(9000.0)], Decay::RANGE.map(|t60| exp2(log2(t60))));
    }
}
