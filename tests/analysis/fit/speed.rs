//! The time that the analysis of a strike into its modes takes.

use super::clock::Clock;
use super::played::Outcome;
use libm::{cos, exp, log, pow, sin, sqrt};
use sprung::analysis::modes::{Settings, modes};
use sprung::internals::random::{Sequence, key};
use std::f64::consts::TAU;

const RATE: f64 = 44_100.0;
/// Modes of a strike, and its length in seconds.
const MODES: usize = 60;
const SECONDS: f64 = 2.0;
/// Number of strikes, and the levels of their noise in dB, relative to the strongest mode.
const SEEDS: u64 = 10;
const NOISE_DB: [f64; 2] = [-400.0, -60.0];

/// A number of a normal distribution (Box & Muller 1958).
fn normal(random: &mut Sequence) -> f64 {
    sqrt(-2.0 * log(random.unit() + 1e-300)) * cos(TAU * random.unit())
}

/// Modes from 60 Hz to 14 kHz with T60s of 0.03 to 10 s, over 60 dB; no two nearer than the wider one's bandwidth and 1 Hz.
fn strike(seed: u64, noise_db: f64) -> Vec<f32> {
    let mut random = Sequence::new(key(seed, 0));
    let mut modes: Vec<[f64; 4]> = Vec::new();
    while modes.len() < MODES {
        let [frequency, t60, level, phase] = std::array::from_fn(|_| random.unit());
        let (frequency, t60) = (60.0 * pow(14_000.0 / 60.0, frequency), 0.03 * pow(333.0, t60));
        let is_apart = |mode: &[f64; 4]| (mode[0] - frequency).abs() > (2.2 / mode[1]).max(2.2 / t60).max(1.0);
        if modes.iter().all(is_apart) {
            modes.push([frequency, t60, pow(10.0, -3.0 * level), TAU * phase]);
        }
    }
    let strongest = modes.iter().map(|mode| mode[2]).fold(0.0, f64::max);
    let noise = strongest * pow(10.0, noise_db / 20.0);
    let sample = |n: usize| {
        let t = n as f64 / RATE;
        let mode = |[frequency, t60, amplitude, phase]: &[f64; 4]| {
            amplitude * exp(-6.907_755 * t / t60) * sin(TAU * frequency * t + phase)
        };
        modes.iter().map(mode).sum::<f64>() + noise * normal(&mut random)
    };
    let samples: Vec<f64> = (0..(SECONDS * RATE) as usize).map(sample).collect();
    let peak = samples.iter().fold(0.0_f64, |peak, sample| peak.max(sample.abs()));
    samples.into_iter().map(|sample| (0.5 * sample / peak) as f32).collect()
}

/// All modes of each strike are found; the CPU seconds that this takes are printed.
#[test]
#[ignore = "takes a minute"]
fn sixty_modes_are_found() -> Outcome<()> {
    println!("| seed | noise | modes found | seconds |\n|---|---|---|---|");
    let mut counts = Vec::new();
    for (seed, noise_db) in (1..=SEEDS).flat_map(|seed| NOISE_DB.map(|noise_db| (seed, noise_db))) {
        let samples = strike(seed, noise_db);
        let clock = Clock::start();
        let found = modes(&[samples], RATE, &Settings::default(), &mut |_| true)?;
        let seconds = clock.seconds();
        let count = found.strikes.first().map_or(0, |strike| strike.modes.len());
        println!("| {seed} | {noise_db} dB | {count} | {seconds:.2} |");
        counts.push(count);
    }
    // Noise can be taken for a mode or two.
    assert!(counts.iter().all(|count| (MODES..=MODES + 2).contains(count)), "{counts:?}");
    Ok(())
}
