//! What is asked for is what sounds: frequency and T60 of a single mass, measured on rendered audio.

use sprung::analysis::damped_sine::{DampedSine, fit_unknown};
use sprung::engine::{Ensemble, Event, EventKind};
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::units::key_from_frequency;

const RATES: [f64; 5] = [22_050.0, 44_100.0, 48_000.0, 96_000.0, 192_000.0];
const FREQUENCIES: [f64; 12] =
    [20.0, 27.5, 61.7, 130.8, 440.0, 1000.7, 2637.0, 4186.0, 8000.0, 12_345.6, 16_000.0, 20_000.0];
const T60S: [f64; 4] = [0.05, 0.3, 2.0, 20.0];
/// Longest stretch that is measured, in seconds: even of a T60 of 20 s it resolves far less than 0.1 %, because the
/// fit averages the rounding of all of its samples.
const LONGEST: f64 = 4.0;

/// One mass, struck once, measured without a hint of what to expect.
fn measure(sample_rate: f64, frequency: f64, t60: f64) -> Option<DampedSine> {
    let patch = Patch::default().with(Param::Decay, t60 as f32);
    let mut ensemble = Ensemble::new(sample_rate, 0, &patch, &[]);
    let pitch = key_from_frequency(frequency, 440.0);
    let key = pitch.round().clamp(0.0, 127.0);
    let kind = EventKind::NoteOn { key: key as u8, detune: (pitch - key) as f32, velocity: 1.0, id: -1 };
    let frames = (t60.min(LONGEST) * sample_rate) as usize;
    let [mut left, mut right] = [(); 2].map(|()| vec![0.0; frames]);
    let mut events = &[Event { frame: 0, channel: 0, kind }][..];
    for (left, right) in left.chunks_mut(4096).zip(right.chunks_mut(4096)) {
        ensemble.process(events, left, right);
        events = &[];
    }
    assert_eq!(left, right, "a mass in the middle sounds the same on both sides");
    fit_unknown(&left, sample_rate)
}

#[test]
fn frequency_and_t60_are_what_was_asked_for() {
    let mut failures = Vec::new();
    let (mut worst_cents, mut worst_t60, mut measured) = (0.0_f64, 0.0_f64, 0);
    for sample_rate in RATES {
        for frequency in FREQUENCIES.into_iter().filter(|frequency| *frequency < 0.45 * sample_rate) {
            for t60 in T60S {
                let case = format!("{frequency} Hz with a T60 of {t60} s at {sample_rate} Hz");
                let Some(found) = measure(sample_rate, frequency, t60) else {
                    failures.push(format!("{case}: no damped sinusoid"));
                    continue;
                };
                let cents = 1200.0 * libm::log2(found.frequency / frequency);
                let percent = 100.0 * (found.t60 / t60 - 1.0);
                (worst_cents, worst_t60) = (worst_cents.max(cents.abs()), worst_t60.max(percent.abs()));
                measured += 1;
                // Where a whole number of samples makes a cycle, every cycle rounds alike and the errors add up: the
                // amplitude strays by up to 0.03 % from the exponential (16 kHz at 96 kHz, T60 20 s: −69.6 dB).
                let limit_db = if sample_rate % frequency == 0.0 { -65.0 } else { -80.0 };
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
