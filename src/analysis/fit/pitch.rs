//! Estimates the pitch of a sound from its modes, and tells a key that contradicts it.

use super::draft::{A4, Draft, Partial};
use crate::sound::bodies::DEFAULT_FREQUENCY;
use crate::units::{key_from_frequency, note_name};
use libm::{fabs, log2, sqrt};

/// Ranges of pitch in Hz: that of melodies, whose end is the piano's highest key (4186 Hz), and above. Tones of the second one add
/// nothing to the pitch of a lower one, which is heard if it is at least this share as strong.
const RANGES: [(f64, f64); 2] = [(25.0, 4200.0), (4200.0, 6000.0)];
const HEARD_BELOW: f64 = 0.1;
/// Distance in cents below which a partial counts as a harmonic.
const NEAR: f64 = 35.0;
/// Highest harmonic that counts.
const HARMONICS: f64 = 12.0;
/// Weight of harmonics relative to the mode itself.
const SERIES: f64 = 0.7;

/// Least share of the weight that a pitch and its harmonics have, if there is no doubt about it, and least T60 in seconds of the mode
/// that has it.
const CLEAR: f64 = 0.8;
const RINGS: f64 = 0.2;
/// Weight of lower modes relative to a mode that counts as the lowest one, and distance in cents from the key in which such a mode
/// counts.
const FAINT: f64 = 0.1;
const NEIGHBOUR: f64 = 700.0;
/// Distance in cents from which a key contradicts the pitch, and ratios of both by which they may differ: octaves and fifths above
/// them are confused easily, and some bodies are named after a tone that none of their modes has.
const CONTRADICTS: f64 = 60.0;
const CONFUSED: [f64; 6] = [1.0, 2.0, 3.0, 4.0, 6.0, 8.0];

/// T60 in seconds up to which longer modes have more weight: a glockenspiel's lowest one is soft, and rings for 5 s.
const LONG: f64 = 5.0;

/// The weight of a mode in hearing.
fn weight(partial: &Partial) -> f64 {
    fabs(partial.amplitude) * sqrt(partial.t60.min(LONG))
}

/// The frequency in Hz that is heard as the pitch: that of the mode that is strongest together with its harmonics. A
/// bar or a bell has the pitch of one mode, and a string that of its lowest. Low tones go before those above 4200 Hz. Without modes
/// that have a pitch, as in noise, it is [`DEFAULT_FREQUENCY`].
pub(super) fn estimate(partials: &[Partial]) -> f64 {
    let [melodic, high] = RANGES.map(|(lowest, highest)| {
        let heard = || partials.iter().filter(|partial| (lowest..=highest).contains(&partial.frequency));
        let score = |candidate: &Partial| {
            let mut sum = weight(candidate);
            for other in heard().filter(|other| other.frequency > 1.5 * candidate.frequency) {
                let ratio = other.frequency / candidate.frequency;
                let harmonic = ratio.round();
                if harmonic <= HARMONICS && fabs(1200.0 * log2(ratio / harmonic)) < NEAR {
                    sum += SERIES * weight(other) / sqrt(harmonic);
                }
            }
            sum
        };
        let scores = heard().map(|partial| (score(partial), partial.frequency));
        scores.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, DEFAULT_FREQUENCY))
    });
    if melodic.0 < HEARD_BELOW * high.0 { high.1 } else { melodic.1 }
}

/// A warning of a key that is not the pitch that is heard.
pub(super) fn wrong_key(draft: &Draft, name: &str) -> Option<String> {
    // A pitch that moves is not clear.
    let heard = Some(draft).filter(|draft| draft.sweep.semitones == 0.0)?;
    let heard = contradicts(&heard.partials, draft.note)?;
    let [heard, given] = [heard, draft.note].map(|frequency| key_name(key_from_frequency(frequency, A4)));
    Some(format!(
        "{name}: it sounds like {heard} and not like {given}, its key: expected {heard}, or none to have it estimated"
    ))
}

/// A fractional MIDI key as musicians write it.
pub(super) fn key_name(key: f64) -> String {
    let nearest = key.round().clamp(0.0, 127.0);
    let cents = (100.0 * (key - nearest)).round();
    let name = note_name(nearest as u8);
    if cents == 0.0 { name } else { format!("{name} {cents:+} ct") }
}

/// The pitch in Hz that is clearly heard where another one, `note`, is given.
///
/// It is clear if most of the sound is the harmonics of one pitch. The lowest and strongest mode of a bar is its pitch as well, but a
/// drum has such a mode too, and any key: so it counts only if it is near the key.
fn contradicts(partials: &[Partial], note: f64) -> Option<f64> {
    let heard = estimate(partials);
    let cents = |ratio: f64| fabs(1200.0 * log2(ratio));
    let own = partials.iter().find(|partial| partial.frequency == heard)?;
    let ratio = |partial: &Partial| partial.frequency / heard;
    let sum = |counts: &dyn Fn(f64) -> bool| {
        partials.iter().filter(|partial| counts(ratio(partial))).map(weight).sum::<f64>()
    };
    let is_harmonic = |ratio: f64| ratio > 0.9 && cents(ratio / ratio.round()) < NEAR;
    let [all, harmonics, first, below] =
        [sum(&|_| true), sum(&is_harmonic), sum(&|ratio| cents(ratio) < NEAR), sum(&|ratio| ratio < 0.9)];
    let leads = 2.0 * first > all && below < FAINT * first && cents(heard / note) < NEIGHBOUR;
    let is_clear = own.t60 > RINGS && (harmonics > CLEAR * all || leads);
    let near = |ratio: &f64| cents(heard / note / ratio) < CONTRADICTS || cents(note / heard / ratio) < CONTRADICTS;
    (is_clear && !CONFUSED.iter().any(near)).then_some(heard)
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
        let glockenspiel =
            partials(&[(523.0, 0.011, 4.9), (2826.0, 0.02, 1.2), (4671.5, 0.058, 1.5), (6975.0, 0.031, 1.2)]);
        assert_eq!(estimate(&glockenspiel), 523.0);
        // A trace of hum is not the pitch.
        let high = partials(&[(50.0, 0.0005, 600.0), (4300.0, 0.3, 1.0)]);
        assert_eq!((estimate(&glockenspiel[2..]), estimate(&high)), (4671.5, 4300.0));
        assert_eq!(estimate(&[]), DEFAULT_FREQUENCY);
    }

    #[test]
    fn a_key_contradicts_a_clear_pitch_only() {
        let string = partials(&[(110.0, 0.2, 2.0), (220.2, 0.25, 1.5), (330.5, 0.1, 1.0), (441.0, 0.1, 0.8)]);
        for note in [110.0, 112.0, 55.0, 220.0, 440.0, 330.0] {
            assert_eq!(contradicts(&string, note), None, "{note}");
        }
        for note in [104.0, 116.6, 123.5, 146.8, 233.0] {
            assert_eq!(contradicts(&string, note), Some(110.0), "{note}");
        }
        let bell = partials(&[(100.0, 0.2, 5.0), (200.0, 0.2, 3.0), (240.0, 0.3, 2.5), (300.0, 0.1, 2.0)]);
        let drum = partials(&[(110.0, 0.5, 0.5), (175.0, 0.2, 0.3), (235.0, 0.1, 0.3)]);
        assert_eq!((contradicts(&bell, 222.0), contradicts(&drum, 261.6)), (None, None));
        let bar = partials(&[(440.0, 0.4, 0.6), (1212.6, 0.2, 0.3), (2377.8, 0.1, 0.15)]);
        assert_eq!((contradicts(&bar, 415.3), contradicts(&bar, 440.0)), (Some(440.0), None));
    }
}
