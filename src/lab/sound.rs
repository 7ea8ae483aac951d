//! The sound of each method: a struck mass, one step per sample, with a limiter for methods that explode.

use super::method::Method;
use super::pitch::play;
use super::system::{State, System};
use super::trajectory::{MOST_STEPS, step_count};
use crate::dsp::{Coefficients, HarmonicOscillator};
use crate::error::{Error, Result};
use libm::{floor, hypot, log10};
use std::f64::consts::TAU;

/// Peak of a strike, −6 dBFS, so that it does not clip.
pub(crate) const STRIKE: f64 = 0.5;
/// Amplitude to which the limiter reduces a mass that explodes: −1 dBFS.
pub(crate) const CEILING: f64 = 0.891_250_938_133_745_6;

/// A method's sound.
#[derive(Clone, Debug)]
pub struct Sound {
    /// The method.
    pub method: Method,
    /// One sample per frame, within ±`CEILING`.
    pub samples: Vec<f32>,
    /// Time in seconds at which the limiter first acted, if it did.
    pub limited: Option<f64>,
    /// Growth in dB that the limiter removed.
    pub reduction_db: f64,
}

/// Strikes a spring of `frequency` Hz with a −60 dB time of `t60` seconds, and integrates it with `method` for
/// `seconds`.
///
/// If the amplitude exceeds `CEILING`, the limiter scales the whole state back to it. Pitch and waveform do not
/// change, the level stays constant, and the removed growth is added up in `reduction_db`.
///
/// # Errors
/// [`Error::Value`] for a note that cannot be played, and for a sound of more than `MOST_STEPS` samples.
pub fn listen(method: Method, frequency: f64, t60: f64, seconds: f64, sample_rate: f64) -> Result<Sound> {
    // `play` checks the note: the same notes cannot be played here.
    play(method, frequency, t60, sample_rate)?;
    let longest = floor(1000.0 * MOST_STEPS as f64 / sample_rate) / 1000.0;
    if !(seconds > 0.0 && seconds <= longest) {
        let expected =
            format!("expected more than 0 s and at most {longest} s, which fit in memory at {sample_rate} Hz");
        return Err(Error::value("seconds", format!("{seconds} is out of range: {expected}")));
    }
    let frames = step_count(1.0 / sample_rate, seconds)?;
    let system = System::from_note(frequency, t60)?;
    let omega = system.omega()?;
    let start = State { x: 0.0, v: STRIKE * TAU * frequency };
    let mut limiter = Limiter { limited: None, gain: 1.0 };
    let mut samples = Vec::with_capacity(frames);
    if method == Method::SynthSeed {
        let frames_t60 = (t60 * sample_rate) as f32;
        let coefficients = Coefficients::seed(frequency as f32, frames_t60, STRIKE as f32, sample_rate as f32);
        let mut mass = HarmonicOscillator::<f32>::new(&coefficients);
        let scale = f64::from(coefficients.v0 as f32) / STRIKE;
        for n in 0..frames {
            let x = f64::from(mass.step());
            let gain = limiter.gain(hypot(x, f64::from(mass.v) / scale), n as f64 / sample_rate);
            (mass.x, mass.v) = (mass.x * gain as f32, mass.v * gain as f32);
            samples.push(mass.x);
        }
    } else {
        let integrator = method.integrator(&system, 1.0 / sample_rate)?;
        let mut state = start;
        for n in 0..frames {
            let t = n as f64 / sample_rate;
            state = integrator.step(state, t)?;
            let gain = limiter.gain(hypot(state.x, state.v / omega), t);
            state = State { x: state.x * gain, v: state.v * gain };
            samples.push(state.x as f32);
        }
    }
    let reduction_db = -20.0 * log10(limiter.gain);
    Ok(Sound { method, samples, limited: limiter.limited, reduction_db })
}

/// Limits an amplitude to [`CEILING`].
struct Limiter {
    limited: Option<f64>,
    /// Product of all gains so far.
    gain: f64,
}

impl Limiter {
    /// Gain for a state of this amplitude at `t` seconds.
    fn gain(&mut self, amplitude: f64, t: f64) -> f64 {
        if amplitude <= CEILING {
            return 1.0;
        }
        self.limited.get_or_insert(t);
        let gain = CEILING / amplitude;
        self.gain *= gain;
        gain
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heard(method: Method, frequency: f64) -> Sound {
        listen(method, frequency, 1.0, 1.0, 48_000.0).unwrap()
    }

    fn peak(samples: &[f32]) -> f32 {
        samples.iter().fold(0.0, |peak, sample| peak.max(sample.abs()))
    }

    #[test]
    fn what_explodes_is_held_and_told_and_the_rest_is_left_alone() {
        for (method, explodes) in [
            (Method::ExplicitEuler, true),
            (Method::Heun, false),
            (Method::ImplicitEuler, false),
            (Method::SymplecticEuler, false),
            (Method::SynthSeed, false),
            (Method::SynthExact, false),
        ] {
            let sound = heard(method, 440.0);
            assert_eq!(sound.samples.len(), 48_000);
            assert_eq!(sound.limited.is_some(), explodes, "{method:?}");
            assert_eq!(sound.reduction_db > 0.0, explodes, "{method:?}");
            assert!(peak(&sound.samples) <= CEILING as f32 * 1.000_001 && sound.samples.iter().all(|s| s.is_finite()));
        }
        // Above fs/π, the seed's coefficients explode too.
        let sound = heard(Method::SynthSeed, 16_000.0);
        assert!(sound.limited.is_some_and(|t| t < 0.01) && sound.reduction_db > 1000.0, "{sound:?}");
    }

    #[test]
    fn the_exact_step_is_the_note_asked_for() {
        let sound = heard(Method::SynthExact, 440.0);
        let start = peak(&sound.samples[..480]);
        let end = peak(&sound.samples[47_520..]);
        assert!((start - 0.5).abs() < 0.02 && (end / start - 0.001).abs() < 1e-4, "{start} {end}");
    }

    /// The limiter does not change the pitch: counts zero crossings of explicit Euler, which explodes at once.
    #[test]
    fn a_limited_sound_keeps_its_pitch() {
        let sound = heard(Method::ExplicitEuler, 1000.0);
        let crossings = sound.samples.windows(2).filter(|w| w[0] <= 0.0 && w[1] > 0.0).count();
        let expected = 48_000.0 / TAU * libm::atan(TAU * 1000.0 / 48_000.0);
        assert!((crossings as f64 - expected).abs() < 2.0, "{crossings} of {expected}");
    }
}
