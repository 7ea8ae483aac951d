//! Tests of the upper bound of a bow's energy, and of the sound of a bowed bank.

use crate::dsp::CONTROL_FRAMES;
use crate::dsp::exciter::{Bow, Drive};
use crate::dsp::mode_bank::{ExcitationGains, ExcitationRows, MAX_MODES, ModeBank, ModeSetup};
use crate::dsp::random::{key, uniform};

const RATE: f64 = 48_000.0;
const SETTINGS: u64 = 10_000;

/// A sequence of numbers from 0 to 1.
struct Stream(u64, u64);

impl Stream {
    fn next(&mut self) -> f64 {
        self.1 += 1;
        f64::from(uniform(self.0, self.1)) * 0.5 + 0.5
    }
}

fn bank(stream: &mut Stream) -> ModeBank {
    let mut bank = ModeBank::new(RATE);
    let len = 1 + (stream.next() * MAX_MODES as f64) as usize;
    let modes: Vec<_> = (0..len)
        .map(|_| {
            let (frequency, t60) = (20.0 * libm::pow(1000.0, stream.next()), 0.01 * libm::pow(3000.0, stream.next()));
            ModeSetup { frequency, t60, left: 1.0, right: 0.5 }
        })
        .collect();
    bank.load(&modes.into_iter().collect());
    let weights: Vec<f64> = (0..bank.len()).map(|_| 2.0 * stream.next() - 1.0).collect();
    let scale = 1.0 / libm::sqrt(weights.iter().map(|weight| weight * weight).sum::<f64>());
    for (m, weight) in weights.iter().enumerate() {
        bank.set_bow_weight(m, (weight * scale) as f32);
    }
    bank.set_excitation_gains(&ExcitationRows::all(ExcitationGains { push: 1.0, ..ExcitationGains::NONE }));
    bank
}

fn energy(bank: &ModeBank) -> f64 {
    (0..bank.len()).map(|m| f64::from(bank.mass(m).1)).sum()
}

/// For all bows, bodies, states and pitch changes, no frame adds more energy than friction at the bow's speed.
#[test]
fn a_bow_gives_no_more_than_friction_at_its_speed() {
    let mut gained = 0;
    for seed in 0..SETTINGS {
        let mut stream = Stream(key(77, seed), 0);
        let mut bank = bank(&mut stream);
        let speed = [libm::pow(10.0, 4.0 * stream.next() - 3.0) as f32, 0.0];
        let force = [speed[0] * libm::pow(10.0, 5.0 * stream.next() - 4.0) as f32, 0.0];
        let mut bow = Bow { speed, force, passed: 0, width: (0.01 + stream.next()) as f32 };
        let most = 2.0 * f64::from(force[0]) * f64::from(speed[0]);
        let mut strike = Drive::NONE;
        strike.push[0] = (stream.next() * stream.next() * 4.0) as f32;
        bank.sweep_to(0.5 + stream.next(), CONTROL_FRAMES);
        bank.render(Some(&strike), CONTROL_FRAMES);
        for _ in 0..2 {
            bank.sweep_to(0.5 + stream.next(), CONTROL_FRAMES);
            for _ in 0..CONTROL_FRAMES {
                let before = energy(&bank);
                bank.render_bowed(None, Some(&bow), 1);
                bow.passed += 1;
                let after = energy(&bank);
                gained += u32::from(after > before);
                assert!(after <= before * (1.0 + 1e-6) + most * (1.0 + 1e-3), "{seed}: {before} {after} {most}");
            }
        }
    }
    assert!(gained > 50_000, "the bow moved what it was to move: {gained}");
}

/// The force is at most the given friction, and its direction is towards the bow's speed.
#[test]
fn friction_pulls_towards_the_speed_of_the_bow() {
    let mut stream = Stream(key(78, 0), 0);
    for _ in 0..SETTINGS {
        let (speed, force) = (stream.next() as f32, stream.next() as f32);
        let bow = Bow { speed: [speed, 0.0], force: [force, 0.0], passed: 0, width: 0.2 };
        let velocity = (8.0 * stream.next() - 4.0) as f32;
        let found = bow.force_on(0, velocity);
        assert!(found.abs() <= force && found * (speed - velocity) >= 0.0, "{bow:?} {velocity}: {found}");
    }
    let bow = Bow { speed: [0.0; 2], force: [0.0; 2], passed: 0, width: 0.2 };
    assert_eq!(bow.force_on(0, 0.0), 0.0);
}

/// A glass under a bow: it starts to ring without a strike, and its amplitude stays near the bow's speed.
#[test]
fn a_bowed_mode_rings_for_as_long_as_it_is_bowed() {
    let mut bank = ModeBank::new(RATE);
    bank.load(&[ModeSetup { frequency: 440.0, t60: 2.0, left: 1.0, right: 1.0 }].into_iter().collect());
    bank.set_bow_weight(0, 1.0);
    let bow = Bow { speed: [0.5, 0.0], force: [0.02, 0.0], passed: 0, width: 0.2 };
    let mut rms = vec![];
    for _ in 0..10 {
        let mut squares = 0.0;
        for _ in 0..150 {
            bank.sweep_to(1.0, CONTROL_FRAMES);
            let [left, _] = bank.render_bowed(None, Some(&bow), CONTROL_FRAMES);
            squares += left.iter().map(|sample| f64::from(sample * sample)).sum::<f64>();
        }
        rms.push(libm::sqrt(squares / 4800.0));
    }
    assert!(rms[9] > 0.25 && rms[9] < 0.8 && (rms[9] / rms[8] - 1.0).abs() < 0.01, "{rms:?}");
}

#[test]
fn a_bowed_bank_has_the_same_bits_in_any_division() {
    let play = |pieces: &[usize]| {
        let mut bank = bank(&mut Stream(key(79, 1), 0));
        let mut bow = Bow { speed: [0.3, 0.001], force: [0.05, -0.0001], passed: 0, width: 0.3 };
        let mut sides = [vec![], vec![]];
        for tick in 0..20 {
            bank.sweep_to(1.0 + 0.01 * f64::from(tick), CONTROL_FRAMES);
            bow.passed = 0;
            for frames in pieces {
                let rendered = bank.render_bowed(None, Some(&bow), *frames);
                sides.iter_mut().zip(rendered).for_each(|(side, part)| side.extend_from_slice(part));
                bow.passed += *frames as u32;
            }
        }
        sides
    };
    let whole = play(&[32]);
    assert!(whole[0].iter().any(|sample| sample.abs() > 0.01));
    assert!(play(&[1, 20, 11]) == whole);
}
