//! Tremolo, overdrive, tone and width have the effect that is set, and change no bit while they are off.

use super::signal::{RATE, blocks_are_equal, decibels, noise, rms};
use assert_no_alloc::{assert_no_alloc, violation_count};
use sprung::internals::space::{Overdrive, Tone, Tremolo, Width};
use std::f64::consts::TAU;

fn sine(frequency: f64, amplitude: f64, frames: usize) -> Vec<f32> {
    (0..frames).map(|n| (amplitude * libm::sin(TAU * frequency * n as f64 / RATE)) as f32).collect()
}

/// Amplitude at a frequency of which the samples hold a whole number of periods.
fn amplitude(samples: &[f32], frequency: f64) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for (n, sample) in samples.iter().enumerate() {
        let angle = TAU * frequency * n as f64 / RATE;
        re += f64::from(*sample) * libm::cos(angle);
        im += f64::from(*sample) * libm::sin(angle);
    }
    2.0 * (re * re + im * im).sqrt() / samples.len() as f64
}

/// All products of 5 kHz at 48 kHz fall on whole kilohertz. Of its odd harmonics, 5 and 15 kHz are
/// below half the sample rate (25 kHz folds to 23); all else is an alias.
#[test]
fn overdrive_has_no_false_tones() {
    for drive in [6.0, 12.0] {
        let mut overdrive = Overdrive::new(RATE);
        overdrive.set(drive);
        let mut left = sine(5000.0, 1.0, 24_000);
        let mut right = left.clone();
        overdrive.process(&mut left, &mut right);
        let steady = &left[24_000 - 4800..];
        let own = amplitude(steady, 5000.0);
        let aliases = (1..24).filter(|kilohertz| ![5, 15].contains(kilohertz));
        let worst = aliases.map(|kilohertz| decibels(amplitude(steady, f64::from(kilohertz) * 1000.0) / own));
        let worst = worst.fold(f64::MIN, f64::max);
        println!(
            "+{drive} dB: aliases below {worst:.1} dB; third harmonic {:.1} dB",
            decibels(amplitude(steady, 15e3) / own)
        );
        assert!(worst < -80.0, "+{drive} dB: {worst} dB");
    }
}

#[test]
fn overdrive_lifts_what_is_soft_and_keeps_full_scale() {
    for drive in [3.0, 12.0, 24.0] {
        let mut overdrive = Overdrive::new(RATE);
        overdrive.set(drive);
        let (mut soft, mut loud) = (sine(200.0, 1e-4, 9600), sine(200.0, 1.0, 9600));
        overdrive.process(&mut soft, &mut loud);
        let lift = decibels(amplitude(&soft[4800..], 200.0) / 1e-4);
        let peak = loud[4800..].iter().fold(0.0_f32, |peak, x| peak.max(x.abs()));
        assert!((lift - f64::from(drive)).abs() < 0.1 && (peak - 1.0).abs() < 0.03, "{lift} dB, {peak}");
    }
}

#[test]
fn tremolo_has_its_rate_and_depth() {
    let mut tremolo = Tremolo::new(RATE);
    tremolo.set_rate(4.0);
    tremolo.set_depth(0.6);
    tremolo.set_stereo_phase(180.0);
    tremolo.reset();
    let (mut left, mut right) = (vec![1.0; 48_000], vec![1.0; 48_000]);
    tremolo.process(&mut left, &mut right);
    for (n, (left, right)) in left.iter().zip(&right).enumerate() {
        let swing = 0.3 * libm::cos(TAU * 4.0 * n as f64 / RATE);
        assert!((f64::from(*left) - 0.7 - swing).abs() < 1e-3 && (f64::from(*right) - 0.7 + swing).abs() < 1e-3, "{n}");
    }
}

#[test]
fn tone_has_its_gains_and_a_cut_undoes_a_boost() {
    let mut tone = Tone::new(RATE);
    tone.set(9.0, -12.0);
    tone.reset();
    let mut undo = Tone::new(RATE);
    undo.set(-9.0, 12.0);
    undo.reset();
    for (frequency, low, high) in [(20.0, 8.5, 9.1), (950.0, -1.5, 1.0), (20_000.0, -12.1, -10.5)] {
        let mut left = sine(frequency, 0.1, 48_000);
        let mut right = left.clone();
        tone.process(&mut left, &mut right);
        let found = decibels(amplitude(&left[24_000..], frequency) / 0.1);
        assert!((low..high).contains(&found), "{frequency} Hz: {found} dB");
        undo.process(&mut left, &mut right);
        let found = decibels(amplitude(&left[24_000..], frequency) / 0.1);
        assert!(found.abs() < 0.01, "{frequency} Hz: {found} dB");
        tone.reset();
        undo.reset();
    }
}

#[test]
fn width_goes_from_mono_to_wide() {
    for (width, side) in [(0.0, 0.0), (0.5, 0.5), (2.0, 2.0)] {
        let mut wide = Width::new(RATE);
        wide.set(width);
        wide.reset();
        let (mut left, mut right) = ([0.75], [0.25]);
        wide.process(&mut left, &mut right);
        assert_eq!([left[0], right[0]], [0.5 + 0.25 * side, 0.5 - 0.25 * side]);
    }
}

/// All four effects in a chain.
#[derive(Clone)]
struct Chain(Tremolo, Overdrive, Tone, Width);

impl Chain {
    fn new() -> Self {
        Self(Tremolo::new(RATE), Overdrive::new(RATE), Tone::new(RATE), Width::new(RATE))
    }

    fn turn(&mut self, amount: f32) {
        self.0.set_depth(amount);
        self.0.set_rate(7.0 * f64::from(amount));
        self.0.set_stereo_phase(90.0 * amount);
        self.1.set(12.0 * amount);
        self.2.set(9.0 * amount, -9.0 * amount);
        self.3.set(1.0 + amount);
    }

    fn process(&mut self, left: &mut [f32], right: &mut [f32]) {
        self.0.process(left, right);
        self.1.process(left, right);
        self.2.process(left, right);
        self.3.process(left, right);
    }
}

#[test]
fn at_rest_nothing_is_touched() {
    let signal = noise(0.5, 10_000, 10_000);
    let mut chain = Chain::new();
    for _ in 0..2 {
        let [mut left, mut right] = signal.clone();
        chain.process(&mut left, &mut right);
        assert_eq!([left, right], signal);
        // Switched on and off again: once the chain is at rest, it changes no bit.
        for amount in [0.8, 0.0] {
            chain.turn(amount);
            let [mut left, mut right] = signal.clone();
            chain.process(&mut left, &mut right);
        }
    }
}

#[test]
fn blocks_do_not_matter() {
    let mut signal = noise(0.5, 6000, 30_000);
    signal[1][25_001..26_000].fill(0.4);
    let turn = |chain: &mut Chain, frame: usize| chain.turn(if frame < 20_000 { 0.7 } else { 0.0 });
    blocks_are_equal(&Chain::new(), &signal, &[100, 1003, 25_500], turn, Chain::process);
}

#[test]
fn settings_move_without_a_jump() {
    let mut chain = Chain::new();
    let mut left = sine(100.0, 0.5, 24_000);
    let mut right = left.clone();
    for (block, (left, right)) in left.chunks_mut(800).zip(right.chunks_mut(800)).enumerate() {
        chain.turn([0.0, 1.0, 0.3][block % 3]);
        chain.process(left, right);
    }
    // A sine of 100 Hz changes by up to 0.0065 per sample at this level; with 12 dB of drive and a boost, by ten times as much.
    let most = left.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    assert!(most < 0.08, "{most}");
}

#[test]
fn tails_end_when_told() {
    let mut chain = Chain::new();
    chain.turn(1.0);
    let [mut left, mut right] = noise(1.0, 4000, 4000);
    chain.process(&mut left, &mut right);
    let told = chain.1.tail_frames() + chain.2.tail_frames();
    assert!(told > 0 && !chain.1.is_silent() && !chain.2.is_silent());
    let (mut left, mut right) = (vec![0.0; told as usize], vec![0.0; told as usize]);
    chain.process(&mut left, &mut right);
    assert!(chain.1.is_silent() && rms(&left[left.len() - 100..]) < 1e-7);
    let (mut left, mut right) = (vec![0.0; 6000], vec![0.0; 6000]);
    chain.process(&mut left, &mut right);
    assert!(chain.2.is_silent() && left[5999] == 0.0);
}

/// Once all effects are off, it makes no difference whether they are asked to process before they are on again.
#[test]
fn effects_that_are_off_need_not_process() {
    let mut asked = Chain::new();
    asked.turn(0.7);
    asked.process(&mut [0.5; 1000], &mut [0.3; 1000]);
    asked.turn(0.0);
    while !(asked.0.is_off() && asked.1.is_off() && asked.2.is_off() && asked.3.is_off()) {
        asked.process(&mut [0.5], &mut [0.3]);
    }
    let left_alone = asked.clone();
    asked.process(&mut [0.5; 100], &mut [0.3; 100]);
    let [asked, left_alone] = [asked, left_alone].map(|mut chain| {
        chain.turn(0.6);
        let [mut left, mut right] = noise(0.5, 1000, 6007);
        chain.process(&mut left, &mut right);
        [left, right].map(|side| side.into_iter().map(f32::to_bits).collect::<Vec<_>>())
    });
    assert!(asked == left_alone);
}

/// While all effects are idle, skipped frames leave the same state as played silence: the tremolo's oscillator runs on.
#[test]
fn skipped_frames_are_silence() {
    let is_idle = |chain: &Chain| chain.0.is_idle() && chain.1.is_idle() && chain.2.is_idle() && chain.3.is_idle();
    let mut played = Chain::new();
    assert!(is_idle(&played) && played.0.is_off() && played.1.is_off() && played.2.is_off() && played.3.is_off());
    played.turn(0.6);
    assert!(!is_idle(&played));
    let sound = |chain: &mut Chain| {
        let [mut left, mut right] = noise(0.5, 1000, 6007);
        chain.process(&mut left, &mut right);
        assert!(is_idle(chain) && !chain.0.is_off());
        [left, right].map(|side| side.into_iter().map(f32::to_bits).collect::<Vec<_>>())
    };
    sound(&mut played);
    let mut skipped = played.clone();
    for frames in [1, 24, 25, 32, 33, 63, 10_001] {
        played.process(&mut vec![0.0; frames], &mut vec![0.0; frames]);
        skipped.0.skip(frames);
        skipped.2.skip(frames);
        assert!(is_idle(&played) && is_idle(&skipped));
        let tail = |mut chain: Chain| {
            chain.turn(0.3);
            chain.2.tail_frames()
        };
        assert_eq!(tail(played.clone()), tail(skipped.clone()), "{frames}");
        assert_eq!(sound(&mut played), sound(&mut skipped), "{frames}");
    }
}

/// The same holds between the end of a smoothed change and the control tick at which the tremolo is off and its clock stops.
#[test]
fn skipped_frames_are_silence_just_before_the_tremolo_is_off() {
    let is_idle = |chain: &Chain| chain.0.is_idle() && chain.1.is_idle() && chain.2.is_idle() && chain.3.is_idle();
    for frames in [1, 5, 31, 32, 33, 100] {
        let mut played = Chain::new();
        played.turn(0.6);
        played.process(&mut vec![0.0; 5000], &mut vec![0.0; 5000]);
        played.0.set_depth(0.0);
        while !is_idle(&played) {
            played.process(&mut [0.0], &mut [0.0]);
        }
        assert!(!played.0.is_off(), "there is a time between");
        let mut skipped = played.clone();
        played.process(&mut vec![0.0; frames], &mut vec![0.0; frames]);
        skipped.0.skip(frames);
        skipped.2.skip(frames);
        let [played, skipped] = [played, skipped].map(|mut chain| {
            chain.turn(0.6);
            let [mut left, mut right] = noise(0.5, 1000, 6007);
            chain.process(&mut left, &mut right);
            [left, right].map(|side| side.into_iter().map(f32::to_bits).collect::<Vec<_>>())
        });
        assert!(played == skipped, "{frames}");
    }
}

#[test]
fn nonsense_is_survived_and_nothing_allocated() {
    let mut chain = Chain::new();
    assert_no_alloc(|| {
        for value in [f32::INFINITY, -f32::INFINITY, f32::MAX, 1e-40, f32::NAN] {
            chain.turn(value);
            let (mut left, mut right) = ([0.5; 100], [-0.25; 100]);
            chain.process(&mut left, &mut right);
            assert!(left.iter().chain(&right).all(|sample| sample.is_finite()), "{value}");
        }
    });
    assert_eq!(violation_count(), 0);
    chain.turn(1.0);
    for value in [f32::NAN, f32::INFINITY] {
        chain.process(&mut [value; 10], &mut [0.5; 10]);
        chain.process(&mut [0.5; 64], &mut [0.5; 64]);
        let (mut left, mut right) = ([0.5; 5000], [0.5; 5000]);
        chain.process(&mut left, &mut right);
        assert!(left[4999].is_finite() && right[4999].is_finite(), "{value} is kept");
    }
}
