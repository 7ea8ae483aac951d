//! The tension of heads and strings: larger amplitudes stretch them more, which raises the pitch.
//!
//! A vibrating string is longer than one at rest, so its tension rises with the mean square of its slope (Kirchhoff 1876,
//! Vorlesungen über mathematische Physik: Mechanik, lecture 29; Carrier 1945, On the non-linear vibration problem of the
//! elastic string). The squares of all frequencies rise by the same factor, `1 + k E` for the energy `E`.
//!
//! The rise follows the energy of the whole voice, which is slow against the vibration. So it is one more summand of
//! the sweep: `6 log₂(1 + (2^(t/6) − 1) E)` semitones, where `t` is the parameter and `E` the energy in units of a full
//! strike (the same strike at full velocity, without routes). `E` is measured at every control tick; while the pulse of a
//! mallet or a pluck is under way, all that it will bring counts, and noise counts as it comes. Slow changes are followed exactly, sudden ones in about 3 ms. Since
//! movements of pitch cannot add energy, tension is stable. `tests/engine/in_motion.rs` measures the pitch within a cent of
//! the law.

use super::line::Line;
use crate::engine::controls::Controls;
use libm::{exp2, log2};

/// Limits the speed of the pitch: in this time, in seconds, it changes by at most the tension parameter, or by a semitone
/// if that is more. So a second strike bends the pitch quickly but smoothly.
const SLIDE_SECONDS: f64 = 0.003;

/// Upper limit of the energy, in full strikes.
const MOST_ENERGY: f64 = 4.0;

/// Smaller rises in semitones count as none: a hundredth of a cent. Then the bank can use a constant pitch again.
const LEAST_RISE: f64 = 1e-4;

/// The rise of a voice's pitch by tension. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tension(Line);

impl Tension {
    /// No rise.
    pub(super) const NONE: Self = Self(Line::ZERO);

    /// Starts a ramp to the rise for an energy, limited in speed, over `frames` frames. `energy` is called only if there is
    /// tension; it is 1 after a full strike. A `fresh` voice starts at the rise without a ramp. Returns the rise in semitones
    /// after these frames.
    pub(super) fn control(
        &mut self,
        controls: &Controls,
        energy: impl FnOnce() -> f64,
        fresh: bool,
        sample_rate: f64,
        frames: usize,
    ) -> f64 {
        if !self.is_on(controls) {
            return 0.0;
        }
        let wanted = rise(controls.tension, energy()) as f32;
        if fresh {
            self.0 = Line::at_rest(wanted);
        } else {
            let most = (controls.tension.max(1.0) * frames as f64 / (SLIDE_SECONDS * sample_rate)) as f32;
            let now = self.0.now();
            self.0.aim(wanted.clamp(now - most, now + most), frames);
        }
        self.0.end().into()
    }

    /// Whether there is tension, or a rise that has not fallen back to 0 yet.
    pub(super) fn is_on(&self, controls: &Controls) -> bool {
        controls.tension > 0.0 || !self.0.is_zero()
    }

    /// Advances by some frames.
    pub(super) fn advance(&mut self, frames: usize) {
        if !self.0.is_zero() {
            self.0.advance(frames);
        }
    }
}

/// The rise in semitones at an energy, if the rise of a full strike is `most`.
fn rise(most: f64, energy: f64) -> f64 {
    let stiffening = exp2(most / 6.0) - 1.0;
    let rise = 6.0 * log2(1.0 + stiffening * energy.clamp(0.0, MOST_ENERGY));
    // Written so that NaN gives 0.
    if rise > LEAST_RISE { rise } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_strike_raises_the_pitch_by_the_tension_and_a_soft_one_by_less() {
        for most in [0.5, 1.0, 7.0, 24.0] {
            assert!((rise(most, 1.0) - most).abs() < 1e-12);
            assert!(rise(most, 0.25) < most && rise(most, 0.25) > 0.25 * most - 1e-12);
            assert_eq!(rise(most, 0.0), 0.0);
            assert_eq!(rise(most, 1e9), rise(most, MOST_ENERGY));
        }
        assert_eq!(rise(0.0, 1.0), 0.0);
    }
}
