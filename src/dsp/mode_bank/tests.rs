//! The bank as its users see it.

use super::*;
use crate::dsp::random::{key, uniform};
use crate::dsp::{Coefficients, HarmonicOscillator};

const RATE: f64 = 48_000.0;

fn bank(law: Law, modes: &[(f64, f64)]) -> ModeBank {
    let mut bank = ModeBank::new(RATE);
    let setup = |(frequency, t60): &(f64, f64)| ModeSetup { frequency: *frequency, t60: *t60, left: 1.0, right: 1.0 };
    bank.load(law, modes.iter().map(setup));
    (0..bank.len()).for_each(|m| bank.set_coupling(m, Coupling { push: 1.0, ..Coupling::default() }));
    bank
}

fn strike() -> Drive {
    let mut drive = Drive::NONE;
    drive.pulse[0] = 1.0;
    drive
}

fn run(bank: &mut ModeBank, frames: usize, drive: Option<&Drive>) -> Vec<f32> {
    let mut left = vec![];
    while left.len() < frames {
        let drive = drive.filter(|_| left.is_empty());
        bank.sweep_to(bank.ratio, CONTROL_FRAMES);
        left.extend_from_slice(bank.render(drive, CONTROL_FRAMES.min(frames - left.len()))[0]);
    }
    left
}

/// Moves to a pitch ratio in one control tick.
fn glide(bank: &mut ModeBank, ratio: f64) -> Vec<f32> {
    bank.sweep_to(ratio, CONTROL_FRAMES);
    bank.render(None, CONTROL_FRAMES)[0].to_vec()
}

/// The classic law is the oscillator to the bit; the exact one rounds elsewhere, and stays within −110 dB.
#[test]
fn one_mode_is_the_oscillator() {
    let laws = [Law::Exact, Law::Classic];
    for (law, frequency) in laws.into_iter().flat_map(|law| [20.0, 440.0, 4000.0, 12_000.0].map(|f| (law, f))) {
        let mut bank = bank(law, &[(frequency, 1.0)]);
        let rendered = run(&mut bank, 48_000, Some(&strike()));
        let error = match law {
            Law::Exact => {
                // The coefficients as the bank rounds them, so that phases do not drift apart.
                let c = Coefficients::exact(frequency, 1.0, 1.0, RATE);
                let rounded = [c.zeta, c.omega2, c.v0].map(|value| f64::from(value as f32));
                let c = Coefficients { zeta: rounded[0], omega2: rounded[1], x0: 0.0, v0: rounded[2] };
                let mut mass = HarmonicOscillator::<f64>::new(&c);
                rendered.iter().fold(0.0_f64, |worst, sample| worst.max((f64::from(*sample) - mass.step()).abs()))
            }
            Law::Classic => {
                let c = Coefficients::seed(frequency as f32, 48_000.0, 1.0, 48_000.0);
                let mut mass = HarmonicOscillator::<f32>::new(&c);
                f64::from(u8::from(rendered.iter().any(|sample| *sample != mass.step())))
            }
        };
        println!("{law:?} {frequency} Hz: {:.1} dB", 20.0 * libm::log10(error));
        assert!(error < 3e-6, "{law:?} {frequency} Hz: {error:e}");
    }
}

/// The state changes places every tick that is rendered by tables: neither place may keep what has come to rest.
#[test]
fn a_mode_at_rest_stays_at_rest_until_it_is_struck() {
    for ticks in 0..4 {
        // More of them than a vector has lanes.
        let modes: Vec<_> = (0..64).map(|m| (200.0, if m == 0 { 10.0 } else { 0.02 })).collect();
        let mut bank = bank(Law::Exact, &modes);
        let mut drive = Some(strike());
        let mut tick = |bank: &mut ModeBank| {
            bank.settle();
            run(bank, CONTROL_FRAMES, drive.take().as_ref());
        };
        while bank.live != LANES {
            tick(&mut bank);
        }
        (0..ticks).for_each(|_| tick(&mut bank));
        assert!(bank.tabled && bank.live == LANES);
        (1..64).for_each(|m| bank.set_coupling(m, Coupling::default()));
        run(&mut bank, 1, Some(&strike()));
        assert!((1..64).all(|m| bank.motion(m).1 == 0.0), "{ticks} ticks: {:?}", bank.motion(40));
    }
}

/// Modes at rest are left out of a sweep: struck in the midst of one, they must not sound where they fell asleep.
#[test]
fn a_mode_that_wakes_is_where_the_sweep_is() {
    let modes: Vec<_> = (0..64).map(|m| (200.0, if m == 0 { 10.0 } else { 0.02 })).collect();
    let mut bank = bank(Law::Exact, &modes);
    run(&mut bank, CONTROL_FRAMES, Some(&strike()));
    for tick in 1..2000 {
        bank.settle();
        glide(&mut bank, 1.0 + 0.001 * f64::from(tick));
    }
    assert_eq!(bank.live, LANES);
    bank.sweep_to(3.0, CONTROL_FRAMES);
    bank.render(None, 16);
    bank.render(Some(&strike()), 16);
    // Those of the first group have been awake all the time.
    let sweep = &bank.modes.sweep.0[1..];
    assert!(sweep.iter().all(|mode| (mode / sweep[0] - 1.0).abs() < 1e-6), "{sweep:?}");
}

#[test]
fn the_energy_is_that_of_the_amplitudes() {
    let mut bank = bank(Law::Exact, &[(100.0, 1.0), (3000.0, 1.0), (19_000.0, 1.0)]);
    run(&mut bank, 48_000, Some(&strike()));
    assert!((bank.settle() / 3e-6 - 1.0).abs() < 1e-4, "{}", bank.settle());
    glide(&mut bank, 1.1);
    assert!((bank.settle() / 3e-6 - 1.0).abs() < 5e-3, "swept: {}", bank.settle());
}

#[test]
fn a_pull_and_a_push_give_the_same_amplitude() {
    for frequency in [50.0, 5000.0, 20_000.0] {
        let mut pulled = bank(Law::Exact, &[(frequency, 1.0)]);
        pulled.set_coupling(0, Coupling { pull: 1.0, ..Coupling::default() });
        run(&mut pulled, 1, Some(&strike()));
        assert!((pulled.settle() - 1.0).abs() < 1e-3, "{frequency}: {}", pulled.settle());
    }
}

#[test]
fn a_sweep_reaches_its_pitch_exactly_and_keeps_the_amplitude() {
    let mut bank = bank(Law::Exact, &[(1000.0, 60.0)]);
    run(&mut bank, 320, Some(&strike()));
    for step in 1..=100 {
        glide(&mut bank, 1.0 + f64::from(step) * 0.05);
    }
    assert!((bank.settle() - 1.0).abs() < 0.02, "{}", bank.settle());
    let samples = run(&mut bank, 48_000, None);
    let crossings = samples.windows(2).filter(|w| w[0] <= 0.0 && w[1] > 0.0).count();
    assert!((5999..=6001).contains(&crossings), "{crossings}");
}

#[test]
fn a_strike_is_as_strong_at_a_swept_pitch() {
    for ratio in [0.1, 1.0, 12.0, 20.0] {
        let mut bank = bank(Law::Exact, &[(1000.0, 60.0)]);
        glide(&mut bank, ratio);
        run(&mut bank, 32, Some(&strike()));
        assert!((bank.settle() - 1.0).abs() < 0.01, "{ratio}: {}", bank.settle());
    }
}

#[test]
fn modes_beyond_nyquist_are_silent() {
    let mut bank = bank(Law::Exact, &[(24_000.0, 1.0), (30_000.0, 1.0)]);
    assert!(run(&mut bank, 4800, Some(&strike())).iter().all(|sample| *sample == 0.0));
}

#[test]
fn classic_is_clamped_short_of_exploding() {
    for frequency in [15_000.0, 15_500.0, 23_000.0] {
        let mut bank = bank(Law::Classic, &[(frequency, 10.0)]);
        run(&mut bank, 32, Some(&strike()));
        glide(&mut bank, 8.0);
        assert!(run(&mut bank, 480_000, None).iter().all(|sample| sample.abs() < 20.0), "{frequency}");
    }
}

/// Ten million random coefficients of the exact law, as the bank rounds them: by Jury's criterion none grows.
/// A thousand of them are then run, swept to the limits.
#[test]
fn random_parameter_sets_are_stable() {
    let stream = key(5, 0);
    let unit = |n: u64| f64::from(uniform(stream, n)) * 0.5 + 0.5;
    let between = |n: u64, low: f64, high: f64| low * libm::pow(high / low, unit(n));
    for case in 0..10_000_000_u64 {
        let rate = between(4 * case, 8_000.0, 768_000.0);
        let theta = angle_from_frequency(between(4 * case + 1, 8.0, 0.5 * rate), rate).min(TOP_ANGLE);
        let t60 = between(4 * case + 2, 0.0005, 240.0);
        let c = Coefficients::from_polar(LN_MINUS_60_DB / (t60 * rate), theta, 1.0);
        let (zeta, omega2) = (f64::from(c.zeta as f32), f64::from(c.omega2 as f32));
        assert!(zeta > 0.0 && zeta < 2.0 && omega2 > 0.0 && omega2 < 4.0 - 2.0 * zeta, "{case}: {c:?}");
        if case % 10_000 == 0 {
            let mut bank = ModeBank::new(rate);
            let frequency = theta * rate / (2.0 * PI);
            bank.load(Law::Exact, [ModeSetup { frequency, t60, left: 1.0, right: 1.0 }].into_iter());
            bank.set_coupling(0, Coupling { push: 1.0, ..Coupling::default() });
            let mut peak = run(&mut bank, 1024, Some(&strike())).iter().fold(0.0_f32, |a, b| a.max(b.abs()));
            assert!(peak < 1.001, "{case}: {peak} from {frequency} Hz, {t60} s at {rate} Hz");
            // Jumps of pitch within a tick are no slow sweep and can pump a mode, but not without bound.
            for n in 0..8 {
                let mut samples = glide(&mut bank, between(4 * case + 3 + n, 0.03, 32.0));
                samples.extend(run(&mut bank, 256, None));
                peak = samples.iter().fold(peak, |a, b| a.max(b.abs()));
            }
            assert!(peak < 100.0, "{case}: {peak} from {frequency} Hz, {t60} s at {rate} Hz, swept");
        }
    }
}

#[test]
fn a_strike_above_the_spectrum_is_heard_when_the_sweep_comes_down() {
    let mut bank = bank(Law::Exact, &[(2000.0, 60.0)]);
    bank.jump_to(32.0);
    assert!(run(&mut bank, 64, Some(&strike())).iter().all(|sample| *sample == 0.0));
    assert!(bank.settle() > 0.01, "silent, but not at rest");
    for step in (10..32 * 4).rev() {
        glide(&mut bank, f64::from(step) / 4.0);
    }
    glide(&mut bank, 1.0);
    glide(&mut bank, 1.0);
    assert!((bank.settle() - 1.0).abs() < 0.2, "{}", bank.settle());
}

#[test]
fn retuning_is_continuous_and_reaches_every_pitch() {
    for (from, to) in [(440.0, 110.0), (300.0, 4000.0), (9000.0, 50.0)] {
        let mut bank = bank(Law::Exact, &[(from, 60.0), (from * 5.0, 60.0)]);
        let before = run(&mut bank, 3217, Some(&strike()));
        let mut kept = bank.clone();
        bank.retune([(to, 60.0), (to * 5.0, 60.0)].into_iter());
        let after = glide(&mut bank, from / to);
        // The same pitch by other coefficients: the same samples.
        let expected = run(&mut kept, 32, None);
        let worst = after.iter().zip(&expected).fold(0.0_f32, |worst, (a, b)| worst.max((a - b).abs()));
        assert!(worst < 2e-3, "{from} to {to}: {worst} after {}", before[3216]);
        glide(&mut bank, 1.0);
        let samples = run(&mut bank, 48_000, None);
        assert!(samples.iter().any(|sample| sample.abs() > 0.1), "{from} to {to}");
    }
}
