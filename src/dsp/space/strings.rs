//! A sympathetic body: strings that resonate with the voices.

use super::modes::{BodyMode, ModeSet};
use libm::{cos, sin, sqrt};
use std::f64::consts::FRAC_PI_2;

/// Strings over one bridge, tuned to a chord or to the played keys. The bridge is both the drive and the pick-up.
///
/// Partials of a stiff string are `n f₀ √(1 + B n²)` (H. Fletcher, E. D. Blackham and R. Stratton 1962). A bridge drives
/// all of them, and each has the same force on the bridge.
///
/// The strings do not act back on their input, so this body is as passive as the others. A [`super::ModalReverb`] plays it
/// with `set_levels(1.0, level)`: the strings are added to the input.
///
/// ```
/// use sprung::internals::space::{Decay, ModalReverb, Resonator, Strings};
///
/// let chord = Strings::new([110.0, 165.0, 220.0, 277.18]);
/// let mut strings = ModalReverb::new(Resonator::new(chord.modes().leak(), Decay { low: 6.0, high: 2.0 }, 48_000.0));
/// strings.set_levels(1.0, 0.1);
/// strings.reset();
/// let (mut left, mut right) = ([0.0; 64], [0.0; 64]);
/// left[0] = 1.0;
/// strings.process(&mut left, &mut right);
/// assert!(right[63] != 0.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Strings {
    /// Frequency of each string in Hz, from the left to the right.
    pub frequencies: Vec<f64>,
    /// Stiffness `B`: 0 for a perfectly flexible string, 0.0004 for the middle of a piano.
    pub stiffness: f64,
    /// Partials up to this frequency in Hz are kept.
    pub top: f64,
    /// Maximum number of partials of a string.
    pub partials: usize,
}

impl Strings {
    /// Strings of these frequencies in Hz, as stiff as a harp's.
    pub fn new(frequencies: impl IntoIterator<Item = f64>) -> Self {
        Self { frequencies: frequencies.into_iter().collect(), stiffness: 0.000_05, top: 10_000.0, partials: 40 }
    }

    /// The modes. Not for the audio thread.
    pub fn modes(&self) -> ModeSet {
        let last = self.frequencies.len().saturating_sub(1).max(1) as f64;
        let string = |(place, frequency): (usize, &f64)| {
            let (frequency, angle) = (*frequency, FRAC_PI_2 * (0.15 + 0.7 * place as f64 / last));
            (1..=self.partials).map(|n| n as f64).map_while(move |n| {
                let partial = n * frequency * sqrt(1.0 + self.stiffness * n * n);
                // Each partial's force on the bridge has the sign of its first half wave, which is always the same.
                let mode = BodyMode { frequency: partial, drive: 1.0, left: cos(angle), right: sin(angle) };
                (partial <= self.top).then_some(mode)
            })
        };
        ModeSet::new(self.frequencies.iter().enumerate().flat_map(string))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn partials_are_stretched() {
        let strings = Strings { stiffness: 0.001, ..Strings::new([100.0]) };
        let modes = strings.modes();
        assert_eq!(modes.len(), 40);
        let tenth = modes.modes()[9].frequency;
        assert!((tenth - 1000.0 * sqrt(1.1)).abs() < 1e-9, "{tenth} Hz");
        assert!(Strings::new([]).modes().is_empty());
        assert!(Strings::new([f64::NAN, -5.0, 0.0]).modes().is_empty());
    }
}
