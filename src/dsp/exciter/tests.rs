//! Tests of the areas, energies and spectra of the excitation, and of its repeatability.

use super::*;

const RATE: f64 = 48_000.0;

/// All forces of a strike: push, pull and noise.
fn collect(exciter: &mut Exciter) -> [Vec<f32>; 3] {
    let (mut all, mut drive) = ([vec![], vec![], vec![]], Drive::NONE);
    while exciter.is_active() {
        exciter.fill(7, &mut drive);
        let forces = [&drive.push, &drive.pull, &drive.noise];
        all.iter_mut().zip(forces).for_each(|(all, force)| all.extend_from_slice(&force[..7]));
    }
    all
}

fn struck(stroke: Stroke) -> [Vec<f32>; 3] {
    let mut exciter = Exciter::REST;
    exciter.strike(&stroke, RATE);
    collect(&mut exciter)
}

fn pushed(force: f32, frames: u32) -> Stroke {
    Stroke { push: (force, frames), ..Stroke::NONE }
}

fn burst(setup: BurstSetup) -> Vec<f32> {
    let [push, pull, noise] = struck(Stroke { noise: setup, ..Stroke::NONE });
    assert!(push.iter().chain(&pull).all(|force| *force == 0.0));
    noise
}

fn squares(noise: &[f32]) -> f64 {
    noise.iter().map(|n| f64::from(n * n)).sum()
}

/// The mean energy of a burst over many streams.
fn mean_energy(setup: BurstSetup) -> f64 {
    (0..400).map(|key| squares(&burst(BurstSetup { key, ..setup }))).sum::<f64>() / 400.0
}

#[test]
fn a_pulse_of_any_length_has_the_area_of_its_force() {
    for frames in [1, 2, 3, 5, 48, 481, 7680] {
        let [push, pull, noise] = struck(Stroke { pull: (-0.2, 2 * frames), ..pushed(0.7, frames) });
        for (force, expected) in [(push, 0.7), (pull, -0.2)] {
            let area: f64 = force.iter().map(|f| f64::from(*f)).sum();
            assert!((area / expected - 1.0).abs() < 1e-6, "{frames}: {area}");
        }
        assert!(noise.iter().all(|n| *n == 0.0));
    }
}

#[test]
fn one_frame_is_exactly_the_force() {
    for force in [1.0, 0.25, 0.617] {
        assert_eq!(struck(pushed(force, 1))[0][0], force);
    }
}

#[test]
fn what_is_off_lasts_no_time() {
    let mut exciter = Exciter::REST;
    exciter.strike(&Stroke { push: (0.0, 500), pull: (0.0, 900), noise: BurstSetup::NONE }, RATE);
    assert!(!exciter.is_active());
    exciter.strike(&Stroke { pull: (0.1, 30), ..pushed(0.5, 20) }, RATE);
    assert_eq!(exciter.frames_left(), 30);
}

#[test]
fn strikes_add_up_while_they_overlap() {
    let mut exciter = Exciter::REST;
    exciter.strike(&pushed(0.5, 100), RATE);
    exciter.fill(20, &mut Drive::NONE.clone());
    exciter.strike(&pushed(0.25, 50), RATE);
    let area: f32 = collect(&mut exciter)[0].iter().sum();
    let before: f32 = struck(pushed(0.5, 100))[0][..20].iter().sum();
    assert!((area + before - 0.75).abs() < 1e-6, "{area} {before}");
}

#[test]
fn a_long_strike_outlasts_many_short_ones() {
    let mut exciter = Exciter::REST;
    exciter.strike(&pushed(0.5, 1000), RATE);
    for _ in 0..2 * OVERLAPPING {
        exciter.strike(&pushed(0.25, 5), RATE);
        exciter.fill(7, &mut Drive::NONE.clone());
    }
    assert_eq!(exciter.frames_left(), 1000 - 14 * OVERLAPPING as u32);
    // One more than can be in progress replaces the one that would end first.
    let mut exciter = Exciter::REST;
    for frames in [900, 300, 600, 800, 700] {
        exciter.strike(&pushed(1.0, frames), RATE);
    }
    let forces = collect(&mut exciter);
    let force = |frame: usize| {
        [900, 600, 800, 700].map(|frames| struck(pushed(1.0, frames))[0].get(frame).copied().unwrap_or(0.0))
    };
    for frame in [100, 500, 650, 750, 850] {
        let expected: f32 = force(frame).iter().sum();
        assert!((forces[0][frame] - expected).abs() < 1e-6, "{frame}: {} for {expected}", forces[0][frame]);
    }
}

#[test]
fn bursts_of_every_form_carry_the_energy_of_their_force_and_repeat_by_key() {
    let plain = BurstSetup { force: 0.5, frames: 1000, ..BurstSetup::NONE };
    for setup in [
        plain,
        BurstSetup { attack: 400, ..plain },
        BurstSetup { decay: Decay::Exponential, ..plain },
        BurstSetup { decay: Decay::Exponential, attack: 300, ..plain },
        BurstSetup { hits: 4, spacing: 300, ..plain },
        BurstSetup { hits: 3, spacing: 2000, decay: Decay::Exponential, ..plain },
        BurstSetup { hits: 5, spacing: 100, attack: 250, ..plain },
    ] {
        let energy = mean_energy(setup);
        assert!((energy / 0.25 - 1.0).abs() < 0.03, "{energy} of {setup:?}");
        let of_key = |key| burst(BurstSetup { key, ..setup });
        assert_eq!(of_key(3), of_key(3));
        assert_ne!(of_key(3), of_key(4));
    }
}

#[test]
fn an_exponential_burst_falls_by_60_db_in_its_time() {
    let setup = BurstSetup { force: 1.0, frames: 8000, decay: Decay::Exponential, ..BurstSetup::NONE };
    let energy =
        |from: usize| (0..100).map(|key| squares(&burst(BurstSetup { key, ..setup })[from..from + 400])).sum::<f64>();
    let fallen = 10.0 * libm::log10(energy(400) / energy(6400));
    assert!((fallen - 45.0).abs() < 1.0, "{fallen}");
}

#[test]
fn hits_begin_where_they_are_asked_for() {
    let setup = BurstSetup { force: 1.0, frames: 200, hits: 3, spacing: 700, key: 5, ..BurstSetup::NONE };
    let noise = burst(setup);
    for hit in 0..3 {
        let sounding = squares(&noise[hit * 700..hit * 700 + 200]);
        assert!((sounding - 1.0 / 3.0).abs() < 0.2, "{sounding}");
    }
    assert!(noise[200..700].iter().chain(&noise[900..1400]).all(|n| *n == 0.0));
    assert!(noise.len() <= 1600 + 7);
}

/// The squared magnitude of a burst at a frequency, in Hz.
fn power(noise: &[f32], frequency: f64) -> f64 {
    let angle = std::f64::consts::TAU * frequency / RATE;
    let (sin, cos) = noise.iter().enumerate().fold((0.0, 0.0), |(sin, cos), (n, force)| {
        let (angle, force) = (angle * n as f64, f64::from(*force));
        (sin + force * libm::sin(angle), cos + force * libm::cos(angle))
    });
    sin * sin + cos * cos
}

#[test]
fn colours_take_highs_or_lows_and_never_add() {
    let at = |colour: f64, frequency: f64| {
        let of_key =
            |key| power(&burst(BurstSetup { force: 1.0, frames: 1500, colour, key, ..BurstSetup::NONE }), frequency);
        10.0 * libm::log10(
            (0..150).map(of_key).sum::<f64>()
                / (0..150)
                    .map(|key| {
                        power(&burst(BurstSetup { force: 1.0, frames: 1500, key, ..BurstSetup::NONE }), frequency)
                    })
                    .sum::<f64>(),
        )
    };
    // At −0.5 the corner is at √(100 · 16,000) = 1,265 Hz: −3 dB there, −10.2 dB at three times that.
    for (frequency, expected) in [(100.0, 0.0), (1265.0, -3.0), (3795.0, -10.1)] {
        let found = at(-0.5, frequency);
        assert!((found - expected).abs() < 1.0, "{frequency}: {found}");
    }
    for (frequency, expected) in [(300.0, -12.7), (1265.0, -3.3), (9000.0, -0.3)] {
        let found = at(0.5, frequency);
        assert!((found - expected).abs() < 1.2, "{frequency}: {found}");
    }
    assert!(at(-1.0, 4000.0) < at(-0.5, 4000.0) - 10.0 && at(1.0, 500.0) < at(0.5, 500.0) - 10.0);
}
