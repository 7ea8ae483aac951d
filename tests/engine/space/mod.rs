//! Measures the space behind the voices: decay, level and correlation of reverbs, and properties that all processors share.

mod effects;
mod promises;
mod signal;

use signal::{RATE, correlation, decibels, impulse, noise, octave, rms, t60};
use sprung::internals::space::{Decay, ModalReverb, ModeSet, Plate, Resonator, Room, Spring, Strings};

const OCTAVES: [f64; 7] = [125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0];

fn reverb(modes: ModeSet, decay: Decay, mix: f32) -> ModalReverb {
    let mut reverb = ModalReverb::new(Resonator::new(modes.leak(), decay, RATE));
    reverb.set_mix(mix);
    reverb.reset();
    reverb
}

#[test]
fn a_plate_decays_as_asked_in_every_octave() {
    let plate = Plate::default().modes();
    for decay in [Decay { low: 2.0, high: 0.7 }, Decay { low: 0.8, high: 1.2 }] {
        let [mut left, mut right] = impulse(120_000);
        reverb(plate.clone(), decay, 1.0).process(&mut left, &mut right);
        for centre in OCTAVES {
            let asked = decay.t60_at(centre);
            let found = t60(&[octave(&left, centre), octave(&right, centre)]);
            println!("{centre} Hz: {found:.3} s, {asked:.3} s asked ({:+.1} %)", 100.0 * (found / asked - 1.0));
            assert!((found / asked - 1.0).abs() < 0.05, "{centre} Hz: {found} s, {asked} s asked");
        }
    }
}

#[test]
fn pick_ups_hear_different_things() {
    for (name, modes, most) in [
        ("plate", Plate::default().modes(), 0.12),
        ("room", Room::default().modes(), 0.35),
        ("spring", Spring::default().modes(), 0.6),
    ] {
        let [mut left, mut right] = impulse(48_000);
        reverb(modes, Decay { low: 1.5, high: 1.0 }, 1.0).process(&mut left, &mut right);
        for centre in [500.0, 1000.0, 2000.0, 4000.0] {
            let found = correlation(&octave(&left, centre), &octave(&right, centre));
            println!("{name}, {centre} Hz: {found:.3}");
            assert!(found.abs() < most, "{name}, {centre} Hz: {found}");
        }
    }
}

#[test]
fn noise_stays_as_loud_as_it_was() {
    for (name, modes) in [
        ("plate", Plate::default().modes()),
        ("room", Room::default().modes()),
        ("spring", Spring::default().modes()),
        ("strings", Strings::new([110.0, 164.8, 220.0]).modes()),
    ] {
        for decay in [Decay { low: 1.0, high: 1.0 }, Decay { low: 2.0, high: 0.5 }] {
            let [mut left, mut right] = noise(0.1, 96_000, 96_000);
            // Both channels are equal, because their sum drives the body.
            right.copy_from_slice(&left);
            let before = rms(&left);
            reverb(modes.clone(), decay, 1.0).process(&mut left, &mut right);
            let both = rms(&[&left[48_000..], &right[48_000..]].concat());
            let change = decibels(both / before);
            println!("{name}: {change:+.2} dB");
            assert!(change.abs() < 2.0, "{name}: {change} dB");
        }
    }
}

/// Echoes along a spring: low frequencies arrive sooner than those near the transition.
#[test]
fn springs_chirp() {
    // Without the short waves above the transition.
    let spring = Spring { wires: [6.0; 3], top: 3200.0, ..Spring::default() };
    let [mut left, mut right] = impulse(9600);
    reverb(spring.modes(), Decay { low: 2.0, high: 2.0 }, 1.0).process(&mut left, &mut right);
    let arrival = |centre: f64| {
        let band = octave(&left, centre);
        let loudest = band.iter().fold(0.0_f64, |peak, x| peak.max(x.abs()));
        band.iter().position(|x| x.abs() > 0.9 * loudest).unwrap() as f64 / RATE
    };
    let (low, high) = (arrival(700.0), arrival(2900.0));
    println!("700 Hz after {low:.4} s, 2.9 kHz after {high:.4} s");
    assert!((0.03..0.05).contains(&low) && high > low + 0.01, "{low} s, {high} s");
}
