//! Estimates the pitch of a sound from its modes.

use super::draft::Partial;
use crate::sound::bodies::DEFAULT_FREQUENCY;
use libm::{fabs, log2, sqrt};

/// Lowest and highest pitch in Hz.
const RANGE: (f64, f64) = (25.0, 6000.0);
/// Distance in cents below which a partial counts as a harmonic.
const NEAR: f64 = 35.0;
/// Highest harmonic that counts.
const HARMONICS: f64 = 12.0;
/// Weight of harmonics relative to the mode itself.
const SERIES: f64 = 0.7;

/// The weight of a mode in hearing. It grows with the T60 up to 0.6 s.
fn weight(partial: &Partial) -> f64 {
    fabs(partial.amplitude) * sqrt(partial.t60.min(0.6))
}

/// The frequency in Hz that is heard as the pitch: that of the mode that is strongest together with its harmonics. A
/// bar or a bell has the pitch of one mode, and a string that of its lowest. Without modes, as in noise, it is
/// [`DEFAULT_FREQUENCY`].
pub(super) fn estimate(partials: &[Partial]) -> f64 {
    let score = |candidate: &Partial| {
        let mut sum = weight(candidate);
        for other in partials.iter().filter(|other| other.frequency > 1.5 * candidate.frequency) {
            let ratio = other.frequency / candidate.frequency;
            let harmonic = ratio.round();
            if harmonic <= HARMONICS && fabs(1200.0 * log2(ratio / harmonic)) < NEAR {
                sum += SERIES * weight(other) / sqrt(harmonic);
            }
        }
        sum
    };
    let heard = partials.iter().filter(|partial| (RANGE.0..=RANGE.1).contains(&partial.frequency));
    heard.max_by(|a, b| score(a).total_cmp(&score(b))).map_or(DEFAULT_FREQUENCY, |partial| partial.frequency)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn partials(list: &[(f64, f64, f64)]) -> Vec<Partial> {
        let partial = |(frequency, amplitude, t60): &(f64, f64, f64)| Partial {
            frequency: *frequency,
            t60: *t60,
            amplitude: *amplitude,
            phase: 0.0,
            pan: 0.0,
            struck: true,
        };
        list.iter().map(partial).collect()
    }

    #[test]
    fn strings_and_bars_have_the_pitch_that_is_heard() {
        let string = partials(&[(110.0, 0.2, 2.0), (220.2, 0.25, 1.5), (330.5, 0.1, 1.0), (441.0, 0.1, 0.8)]);
        assert_eq!(estimate(&string), 110.0);
        let marimba = partials(&[(261.6, 0.5, 0.8), (1046.0, 0.3, 0.2), (2600.0, 0.2, 0.05), (90.0, 0.02, 0.05)]);
        assert_eq!(estimate(&marimba), 261.6);
        assert_eq!(estimate(&[]), DEFAULT_FREQUENCY);
    }
}
