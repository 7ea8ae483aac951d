//! The fit of a damped sine, which tests of sounds measure with, is far finer than what they ask for.

use super::damped_sine::{LN_60_DB, fit, fit_unknown};
use std::f64::consts::PI;

fn synthesise(frequency: f64, t60: f64, phase: f64, sample_rate: f64, len: usize) -> Vec<f64> {
    let sample = |n: usize| {
        let t = n as f64 / sample_rate;
        0.7 * libm::exp(-LN_60_DB * t / t60) * libm::sin(2.0 * PI * frequency * t + phase)
    };
    (0..len).map(sample).collect()
}

fn cents(measured: f64, truth: f64) -> f64 {
    (1200.0 * libm::log2(measured / truth)).abs()
}

#[test]
fn clean_data_is_resolved_far_below_what_is_tested_with_it() {
    for sample_rate in [22_050.0, 48_000.0, 192_000.0] {
        for frequency in [20.0, 65.4, 441.3, 3000.0, 9700.0, 20_000.0] {
            for t60 in [0.05, 0.3, 2.0, 20.0_f64] {
                if frequency > 0.45 * sample_rate {
                    continue;
                }
                let data = synthesise(frequency, t60, 0.3, sample_rate, (t60.min(1.0) * sample_rate) as usize);
                let single: Vec<f32> = data.iter().map(|sample| *sample as f32).collect();
                let case = format!("{frequency} Hz, T60 {t60} s at {sample_rate} Hz");
                for (kind, fitted, finest, floor) in [
                    ("near", fit(&data, sample_rate, frequency * 1.01, t60 * 0.99), 1e-5, -180.0),
                    ("blind", fit_unknown(&data, sample_rate), 1e-5, -180.0),
                    ("near, f32", fit(&single, sample_rate, frequency * 0.99, t60 * 1.01), 5e-4, -130.0),
                    ("blind, f32", fit_unknown(&single, sample_rate), 5e-4, -130.0),
                ] {
                    let fitted = fitted.unwrap_or_else(|| panic!("{case}, {kind}: no fit"));
                    assert!(cents(fitted.frequency, frequency) < finest, "{case}, {kind}: {fitted:?}");
                    assert!((fitted.t60 / t60 - 1.0).abs() < 1e-5, "{case}, {kind}: {fitted:?}");
                    assert!((fitted.amplitude - 0.7).abs() < 1e-5, "{case}, {kind}: {fitted:?}");
                    assert!((fitted.phase - 0.3).abs() < 1e-5, "{case}, {kind}: {fitted:?}");
                    assert!(fitted.residual_db < floor, "{case}, {kind}: {fitted:?}");
                }
            }
        }
    }
}

#[test]
fn a_second_partial_shows_in_the_residual() {
    let mut data = synthesise(440.0, 1.0, 0.0, 48_000.0, 48_000);
    for (sample, partial) in data.iter_mut().zip(synthesise(1000.0, 1.0, 0.0, 48_000.0, 48_000)) {
        *sample += 0.01 * partial;
    }
    let fitted = fit_unknown(&data, 48_000.0).unwrap();
    assert!((fitted.residual_db + 40.0).abs() < 0.1, "{fitted:?}");
}

#[test]
fn an_undamped_sine_has_an_infinite_or_immense_t60() {
    let fitted = fit_unknown(&synthesise(100.0, 1e12, 0.0, 48_000.0, 9600), 48_000.0).unwrap();
    assert!(fitted.t60 > 1e6, "{fitted:?}");
}

#[test]
fn what_cannot_be_fitted_gives_none() {
    assert_eq!(fit_unknown(&[0.0; 1000], 48_000.0), None);
    assert_eq!(fit(&[0.0; 1000], 48_000.0, 440.0, 1.0), None);
    assert_eq!(fit(&[0.5; 4], 48_000.0, 440.0, 1.0), None);
    assert_eq!(fit(&[f64::NAN; 1000], 48_000.0, 440.0, 1.0), None);
    assert_eq!(fit(&[0.5; 1000], 48_000.0, -1.0, 1.0), None);
}
