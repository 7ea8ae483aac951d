//! Pitch and decay errors of each method at a sample rate.

use super::amplification::{Amplification, Tone};
use super::method::Method;
use super::system::System;
use crate::dsp::Coefficients;
use crate::dsp::coefficients::LN_MINUS_60_DB;
use crate::error::{Error, Result};
use libm::{log, log2};
use std::f64::consts::TAU;

/// The sound of a note played by a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// Rings and decays.
    Decays {
        /// Error of the frequency in cents.
        cents: f64,
        /// Error of the −60 dB time in %.
        decay_percent: f64,
    },
    /// Rings, but grows instead of decaying.
    Grows {
        /// Error of the frequency in cents.
        cents: f64,
        /// Growth in dB per second.
        db_per_second: f64,
    },
    /// Has no pitch and explodes.
    Explodes {
        /// Growth in dB per second.
        db_per_second: f64,
    },
    /// Has no pitch and dies away: the error of the method makes it over-damped.
    Dies,
}

/// A note played by a method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Note {
    /// The method.
    pub method: Method,
    /// Requested frequency in Hz.
    pub frequency: f64,
    /// Requested −60 dB time in seconds.
    pub t60: f64,
    /// The sound of the note.
    pub outcome: Outcome,
}

/// Plays `frequency` Hz with a −60 dB time of `t60` seconds (infinite: no decay), one step per sample of `sample_rate`.
///
/// Every method integrates the spring that has exactly this pitch and decay. Only the seed's coefficients are computed
/// from the note itself, as a player would: `Initialise(sample_rate, frequency, decay_frames)`.
pub(crate) fn play(method: Method, frequency: f64, t60: f64, sample_rate: f64) -> Result<Note> {
    if !(sample_rate > 0.0 && sample_rate.is_finite()) {
        return Err(Error::value("rate", format!("must be greater than 0 Hz, got {sample_rate}")));
    }
    if frequency >= 0.5 * sample_rate {
        let message = format!("must be below half the sample rate, {} Hz, got {frequency}", 0.5 * sample_rate);
        return Err(Error::value("frequency", message));
    }
    let system = System::from_note(frequency, t60)?;
    let step = match method {
        Method::SynthSeed => {
            let frames = (t60 * sample_rate) as f32;
            Amplification::of_step(&Coefficients::seed(frequency as f32, frames, 1.0, sample_rate as f32))
        }
        _ => Amplification::of(method, &system, 1.0 / sample_rate)?,
    };
    Ok(Note { method, frequency, t60, outcome: outcome(&step, frequency, t60, sample_rate) })
}

fn outcome(step: &Amplification, frequency: f64, t60: f64, sample_rate: f64) -> Outcome {
    let db_per_second = step.growth() * sample_rate * -60.0 / LN_MINUS_60_DB;
    let Tone::Rings { decay, angle } = step.tone() else {
        return if step.is_bounded() { Outcome::Dies } else { Outcome::Explodes { db_per_second } };
    };
    let cents = 1200.0 * log2(angle * sample_rate / TAU / frequency);
    // An undamped note whose level changes only by rounding has the requested decay, which is none.
    let asked = -LN_MINUS_60_DB / (t60 * sample_rate);
    if asked == 0.0 && decay.abs() < 1e-13 {
        Outcome::Decays { cents, decay_percent: 0.0 }
    } else if decay < 0.0 {
        Outcome::Grows { cents, db_per_second }
    } else {
        Outcome::Decays { cents, decay_percent: 100.0 * (asked / decay - 1.0) }
    }
}

/// `count` frequencies from `from` to `to` Hz, in equal musical intervals.
pub fn musical_steps(from: f64, to: f64, count: usize) -> Vec<f64> {
    super::stability::spaced(log(from), log(to), count).into_iter().map(libm::exp).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cents(method: Method, frequency: f64, t60: f64) -> f64 {
        match play(method, frequency, t60, 48_000.0).unwrap().outcome {
            Outcome::Decays { cents, .. } | Outcome::Grows { cents, .. } => cents,
            _ => f64::NAN,
        }
    }

    /// The published figures for the seed's coefficients at 48 kHz, to all digits given.
    #[test]
    fn the_seed_is_as_sharp_and_as_flat_as_published() {
        for (frequency, t60, published, half_digit) in [
            (440.0, 1.0, 0.4, 0.05),
            (4186.0, 1.0, 22.4, 0.05),
            (8000.0, 1.0, 89.0, 0.5),
            (12_000.0, 1.0, 243.0, 0.7),
            (27.5, 0.1, -149.0, 0.5),
        ] {
            let measured = cents(Method::SynthSeed, frequency, t60);
            assert!((measured - published).abs() <= half_digit, "{frequency} Hz: {measured}, published {published}");
        }
        assert!(matches!(play(Method::SynthSeed, 15_290.0, 60.0, 48_000.0).unwrap().outcome, Outcome::Explodes { .. }));
    }

    #[test]
    fn exact_coefficients_are_in_tune_everywhere() {
        for method in [Method::SynthExact, Method::Exponential] {
            for frequency in [27.5, 440.0, 4186.0, 12_000.0, 23_500.0, 23_999.0] {
                for t60 in [0.01, 0.1, 1.0, 10.0] {
                    let Outcome::Decays { cents, decay_percent } =
                        play(method, frequency, t60, 48_000.0).unwrap().outcome
                    else {
                        panic!("{method:?} rings at {frequency} Hz")
                    };
                    assert!(cents.abs() < 1e-7, "{method:?} at {frequency} Hz, T60 {t60}: {cents:e} cents");
                    assert!(decay_percent.abs() < 1e-7, "{method:?} at {frequency} Hz, T60 {t60}: {decay_percent:e} %");
                }
            }
        }
    }

    /// The leading terms from theory: angle `atan ωh` for implicit Euler, `2 asin(ωh/2)` for the symplectic methods.
    #[test]
    fn undamped_pitch_is_that_of_theory() {
        let angle = TAU * 4000.0 / 48_000.0;
        let error = |got: f64| 1200.0 * log2(got / angle);
        for (method, expected) in [
            (Method::ImplicitEuler, error(libm::atan(angle))),
            (Method::ExplicitEuler, error(libm::atan(angle))),
            (Method::SymplecticEuler, error(2.0 * libm::asin(0.5 * angle))),
            (Method::Verlet, error(2.0 * libm::asin(0.5 * angle))),
        ] {
            let measured = cents(method, 4000.0, f64::INFINITY);
            assert!((measured - expected).abs() < 1e-9, "{method:?}: {measured}, theory {expected}");
        }
        assert!(matches!(play(Method::ExplicitEuler, 440.0, 1.0, 48_000.0).unwrap().outcome, Outcome::Grows { .. }));
    }

    #[test]
    fn notes_that_cannot_be_are_errors() {
        for (frequency, t60, rate, name) in [
            (0.0, 1.0, 48_000.0, "frequency"),
            (24_000.0, 1.0, 48_000.0, "frequency"),
            (440.0, -1.0, 48_000.0, "t60"),
            (440.0, 1.0, 0.0, "rate"),
        ] {
            let message = play(Method::Heun, frequency, t60, rate).unwrap_err().to_string();
            assert!(message.starts_with(name), "{message}");
        }
    }
}
