//! Measures decay and level of each octave of a sound.

use super::super::log_mel::RATE;
use libm::{pow, sqrt};
use sprung_fourier::Planner;

/// Centres of the octaves in Hz.
pub(crate) const CENTRES: [f64; 9] = [63.0, 125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0, 16_000.0];

/// Order of the octave filters (Butterworth, zero phase).
const ORDER: f64 = 6.0;

/// An octave of a sound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Octave {
    /// Energy over that of the whole sound in dB.
    pub(crate) level: f64,
    /// T60 in seconds, from −5 to −25 dB of the remaining energy (Schroeder 1965); none if it does not fall so far.
    pub t60: Option<f64>,
}

/// The octaves of a sound at [`RATE`].
pub fn octaves(sound: &[f32]) -> [Octave; CENTRES.len()] {
    // Zeros after the sound, so that the filters do not wrap around.
    let length = (2 * sound.len()).next_power_of_two().max(1024);
    let planner = Planner::default();
    let (forward, backward) = (planner.forward(length), planner.inverse(length));
    let (mut input, mut spectrum) = (forward.make_input_vec(), forward.make_output_vec());
    input.iter_mut().zip(sound).for_each(|(input, sample)| *input = (*sample).into());
    forward.process(&mut input, &mut spectrum).expect("the buffers are the transform's own");
    let whole: f64 = sound.iter().map(|sample| f64::from(*sample) * f64::from(*sample)).sum();
    CENTRES.map(|centre| {
        let mut band = spectrum.clone();
        for (bin, value) in band.iter_mut().enumerate() {
            let frequency = bin as f64 * f64::from(RATE) / length as f64;
            // A low-pass transformed to a band-pass: ±1 at the edges of the octave.
            let off = (frequency * frequency - centre * centre) / (frequency.max(1e-9) * centre / sqrt(2.0));
            *value *= 1.0 / (1.0 + pow(off.abs(), ORDER));
        }
        for end in [0, length / 2] {
            band[end].im = 0.0;
        }
        let mut samples = backward.make_output_vec();
        backward.process(&mut band, &mut samples).expect("the buffers are the transform's own");
        let scale = 1.0 / length as f64;
        let mut left: Vec<f64> = samples[..sound.len()].iter().map(|sample| sample * sample * scale * scale).collect();
        for n in (0..left.len().saturating_sub(1)).rev() {
            left[n] += left[n + 1];
        }
        let all = left.first().copied().unwrap_or(0.0);
        let falls_to = |db: f64| left.iter().position(|energy| *energy < all * pow(10.0, 0.1 * db));
        let t60 = falls_to(-5.0).zip(falls_to(-25.0)).map(|(from, to)| 3.0 * (to - from) as f64 / f64::from(RATE));
        Octave { level: super::decibels(all / whole.max(1e-30)), t60 }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_octave_has_its_own_decay() {
        let partial = |frequency: f64, t60: f64, n: usize| {
            let time = n as f64 / f64::from(RATE);
            libm::sin(2.0 * std::f64::consts::PI * frequency * time) * pow(10.0, -3.0 * time / t60)
        };
        let sound: Vec<f32> =
            (0..2 * RATE as usize).map(|n| (partial(250.0, 2.0, n) + partial(2000.0, 0.5, n)) as f32).collect();
        let found = octaves(&sound);
        for (octave, t60) in [(2, 2.0), (5, 0.5)] {
            let measured = found[octave].t60.unwrap();
            assert!((measured / t60 - 1.0).abs() < 0.05, "{octave}: {measured} s");
        }
        assert!(found[2].level > -3.0 && found[5].level > -9.0 && found[8].level < -30.0, "{found:?}");
    }
}
