//! Compares the `classic` sound with the original listing, compiled unchanged: the bits must be the same.

use sprung::dsp::{Coefficients, HarmonicOscillator};
use sprung::engine::{Event, EventKind, Synth};
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::units::key_from_frequency;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Sample rate, frequency, decay in frames, amplitude, frames, sweep.
type Case = (f32, f32, f32, f32, usize, f32);

/// Compiles the listing as a program.
fn program(folder: &Path) -> PathBuf {
    let program = folder.join("harmonic_oscillator");
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/engine/seed/harmonic_oscillator.cpp");
    // No fused multiplication: the listing's operations are done one by one, as on the machines of its time.
    let compiler = Command::new("c++").args(["-O2", "-ffp-contract=off", source, "-o"]).arg(&program).status();
    assert!(compiler.expect("c++, which `cargo xtask setup` installs").success(), "the listing does not compile");
    program
}

/// The results of the listing for the cases.
fn listing(program: &Path, cases: &[Case]) -> Vec<f32> {
    let mut child = Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let lines: String = cases
        .iter()
        .map(|(rate, frequency, decay, amplitude, frames, sweep)| {
            format!("{rate} {frequency} {decay} {amplitude} {frames} {sweep}\n")
        })
        .collect();
    let writer = std::thread::spawn(move || input.write_all(lines.as_bytes()));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|bits| f32::from_bits(bits.parse().unwrap())).collect()
}

/// Two hundred settings over the whole range in which the listing is stable.
fn cases() -> Vec<Case> {
    let stream = sprung::internals::random::key(2, 2);
    let unit = |n: u64| f64::from(sprung::internals::random::uniform(stream, n)) * 0.5 + 0.5;
    let between = |n: u64, low: f64, high: f64| (low * libm::pow(high / low, unit(n))) as f32;
    (0..200)
        .map(|n| {
            let rate = [22_050.0, 44_100.0, 48_000.0, 96_000.0, 192_000.0][(n % 5) as usize];
            let sweep = if n % 2 == 0 { 1.0 } else { between(4 * n, 0.25, 1.5) };
            let frequency = between(4 * n + 1, 20.0, f64::from(rate) * 0.2);
            (rate, frequency, between(4 * n + 2, 500.0, 1e6), between(4 * n + 3, 0.1, 1.0), 2000, sweep)
        })
        .collect()
}

/// One test for both, since the compiler takes most of its time.
#[test]
fn the_classic_oscillator_and_the_synth_s_classic_sound_are_the_listing_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let program = program(folder.path());
    the_oscillator_is_the_listing(&program);
    the_synth_is_the_listing(&program);
}

fn the_oscillator_is_the_listing(program: &Path) {
    let cases = cases();
    let mut expected = listing(program, &cases).into_iter();
    for (rate, frequency, decay, amplitude, frames, sweep) in cases {
        let mut mass = HarmonicOscillator::<f32>::new(&Coefficients::seed(frequency, decay, amplitude, rate));
        for n in 0..frames {
            let sample = if sweep == 1.0 { mass.step() } else { mass.step_with_sweep(sweep) };
            let expected = expected.next().unwrap();
            assert_eq!(
                sample.to_bits(),
                expected.to_bits(),
                "{frequency} Hz at {rate} Hz, frame {n}: {sample} {expected}"
            );
        }
    }
    assert_eq!(expected.next(), None);
}

fn the_synth_is_the_listing(program: &Path) {
    let settings = [(440.0, 1.0), (55.0, 0.25), (4000.0, 3.0)];
    let cases = settings.map(|(frequency, t60)| (48_000.0, frequency, t60 * 48_000.0, 1.0, 9600, 1.0));
    let expected = listing(program, &cases);
    for ((frequency, t60), expected) in settings.into_iter().zip(expected.chunks(9600)) {
        let mut synth = Synth::new(48_000.0, 0);
        let patch = Patch::default()
            .with(Param::Coefficients, 1.0)
            .with(Param::Decay, t60)
            .with(Param::Gain, 0.0)
            .with(Param::Limiter, 0.0);
        synth.set_patch(&patch);
        let key = key_from_frequency(frequency.into(), 440.0);
        let (near, detune) = (libm::round(key) as u8, (key - libm::round(key)) as f32);
        let on = EventKind::NoteOn { key: near, detune, velocity: 1.0, id: None };
        let (mut left, mut right) = (vec![0.0; 9600], vec![0.0; 9600]);
        synth.process(&[Event { frame: 0, channel: 0, kind: on }], &mut left, &mut right);
        assert!(left == expected && right == expected, "{frequency} Hz");
    }
}
