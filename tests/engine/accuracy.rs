//! The rendered frequency and T60 of a single mass are the requested ones, measured on rendered audio.

use crate::damped_sine::{DampedSine, fit_unknown};
use sprung::internals::files::{Inputs, Output, Target, to_wav};
use sprung::io::{SampleFormat, Song};
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::render::{Delivery, Job, Level, Options, Tail};
use sprung::sound::Kit;
use sprung::units::key_from_frequency;
use std::path::Path;

const RATES: [u32; 5] = [22_050, 44_100, 48_000, 96_000, 192_000];
const FREQUENCIES: [f64; 12] =
    [20.0, 27.5, 61.7, 130.8, 440.0, 1000.7, 2637.0, 4186.0, 8000.0, 12_345.6, 16_000.0, 20_000.0];
const T60S: [f64; 4] = [0.05, 0.3, 2.0, 20.0];
/// Longest measured stretch, in seconds. Even for a T60 of 20 s this resolves far less than 0.1 %, because the fit
/// averages the rounding errors of all samples.
const LONGEST: f64 = 0.5;

/// Strikes one mass once, renders it to a WAV file, and measures it without prior knowledge of the result.
fn measure(folder: &Path, sample_rate: u32, frequency: f64, t60: f64) -> Option<DampedSine> {
    let patch = Patch::default().with(Param::Decay, t60 as f32);
    let song = Song::chord(&[key_from_frequency(frequency, 440.0)], 1.0, t60.min(LONGEST));
    let options = Options { sample_rate, seed: 0, block: 4096, tail: Tail::None };
    let kit = Kit::of_patch(&patch);
    let job = Job::new(&song, &kit, options);
    let delivery = Delivery { samples: SampleFormat::Float32, dither: false, mono: true, level: Level::Gain(0.0) };
    let path = folder.join("note.wav");
    let mut output = Output::create(&Target::new(&path), true, &Inputs::default()).unwrap();
    to_wav(&job, &delivery, &mut output, |_| Ok(())).unwrap();
    output.commit().unwrap();
    let samples: Vec<f32> =
        hound::WavReader::open(path).unwrap().into_samples().map(|sample| sample.unwrap()).collect();
    fit_unknown(&samples, sample_rate.into())
}

#[test]
fn frequency_and_t60_are_what_was_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let mut failures = Vec::new();
    let (mut worst_cents, mut worst_t60, mut measured) = (0.0_f64, 0.0_f64, 0);
    for sample_rate in RATES {
        for frequency in FREQUENCIES.into_iter().filter(|frequency| *frequency < 0.48 * f64::from(sample_rate)) {
            for t60 in T60S {
                let case = format!("{frequency} Hz with a T60 of {t60} s at {sample_rate} Hz");
                let Some(found) = measure(folder.path(), sample_rate, frequency, t60) else {
                    failures.push(format!("{case}: no damped sinusoid"));
                    continue;
                };
                let cents = 1200.0 * libm::log2(found.frequency / frequency);
                let percent = 100.0 * (found.t60 / t60 - 1.0);
                (worst_cents, worst_t60) = (worst_cents.max(cents.abs()), worst_t60.max(percent.abs()));
                measured += 1;
                // If a cycle is a whole number of samples, every cycle has the same rounding errors and they add up:
                // the amplitude deviates by up to 0.03 % from the exponential (16 kHz at 96 kHz, T60 20 s: −69.6 dB).
                let limit_db = if f64::from(sample_rate) % frequency == 0.0 { -65.0 } else { -80.0 };
                if !(cents.abs() <= 0.01 && percent.abs() <= 0.1 && found.residual_db < limit_db) {
                    let residual = found.residual_db;
                    failures.push(format!("{case}: {cents:+.5} cents, T60 {percent:+.5} %, residual {residual:.1} dB"));
                }
            }
        }
    }
    println!("{measured} notes; at worst {worst_cents:.2e} cents and {worst_t60:.2e} % of T60");
    assert!(failures.is_empty(), "{} of {measured} notes are off:\n{}", failures.len(), failures.join("\n"));
}
