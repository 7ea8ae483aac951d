//! Compares bodies with banks in double precision, which step every mode at every frame.

use super::*;
use crate::dsp::random::{key, uniform};
use crate::dsp::space::{BodyMode, Plate, Room, Spring, Strings};
use libm::{cos, exp, log10, sin};
use std::f64::consts::{LN_10, TAU};

/// An impulse, and a tenth of a second of noise after some frames.
fn signal(frames: usize, noise: std::ops::Range<usize>) -> Vec<f32> {
    let stream = key(5, 5);
    let sample = |n: usize| if noise.contains(&n) { 0.1 * uniform(stream, n as u64) } else { 0.0 };
    (0..frames).map(|n| if n == 100 { 1.0 } else { sample(n) }).collect()
}

/// A body's output.
fn played(body: &mut Resonator, input: &[f32]) -> [Vec<f64>; 2] {
    let mut out = [Vec::new(), Vec::new()];
    body.prepare();
    for input in input.chunks(BODY_TICK) {
        body.tick(input.iter().map(|sample| f64::from(sample.abs())).sum());
        body.work();
        for (out, side) in out.iter_mut().zip(body.render(input)) {
            out.extend(side.iter().map(|sample| f64::from(*sample)));
        }
    }
    out
}

/// What the body of these modes should output.
fn exact(modes: &ModeSet, decay: Decay, pitch: f64, rate: f64, input: &[f32]) -> [Vec<f64>; 2] {
    struct Mass {
        turn: [f64; 2],
        gains: [f64; 2],
        state: [f64; 2],
    }
    let heard = modes.modes().iter().filter(|mode| mode.frequency * pitch < 0.49 * rate);
    let mut masses: Vec<Mass> = heard
        .map(|BodyMode { frequency, drive, left, right }| {
            let (angle, radius) =
                (TAU * frequency * pitch / rate, exp(-3.0 * LN_10 / (decay.t60_at(frequency * pitch) * rate)));
            let turn = [radius * cos(angle), radius * sin(angle)];
            Mass { turn, gains: [drive * left, drive * right], state: [0.0; 2] }
        })
        .collect();
    let mut out = [vec![0.0; input.len()], vec![0.0; input.len()]];
    for (n, force) in input.iter().enumerate() {
        let mut sums = [0.0; 2];
        for mass in &mut masses {
            let ([c, s], [y, x]) = (mass.turn, [mass.state[0] + f64::from(*force), mass.state[1]]);
            mass.state = [c * y - s * x, c * x + s * y];
            (0..2).for_each(|side| sums[side] += mass.gains[side] * mass.state[1]);
        }
        (out[0][n], out[1][n]) = (sums[0], sums[1]);
    }
    out
}

/// The largest difference of a body from the exact one, relative to the loudest frame, in dB.
fn difference(modes: &ModeSet, decay: Decay, pitch: f64, rate: f64, input: &[f32]) -> f64 {
    let mut body = Resonator::new(modes, decay, rate);
    body.tune(pitch);
    let (found, exact) = (played(&mut body, input), exact(modes, decay, pitch, rate, input));
    let (mut most, mut loudest) = (0.0_f64, 0.0_f64);
    for (found, exact) in found.iter().flatten().zip(exact.iter().flatten()) {
        (most, loudest) = (most.max((found - exact).abs()), loudest.max(exact.abs()));
    }
    20.0 * log10(most / loudest)
}

#[test]
#[ignore = "takes minutes"]
fn bodies_are_exact_at_all_settings() {
    let bodies = [
        ("plate", Plate::default().modes()),
        ("room", Room::default().modes()),
        ("spring", Spring::default().modes()),
        ("strings", Strings::new([65.4, 98.0, 220.0, 277.18]).modes()),
    ];
    let mut worst = f64::MIN;
    for (name, modes) in &bodies {
        for [low, high] in [[3.0, 1.0], [30.0, 10.0], [1.0, 30.0], [0.3, 0.2], [0.15, 0.1], [0.05, 0.05]] {
            for (pitch, rate) in
                [(1.0, 48_000.0), (4.0, 48_000.0), (0.2, 44_100.0), (1.0, 8_000.0), (1.0, 96_000.0), (1.7, 67_000.0)]
            {
                let input = signal(24_000, 3000..10_000);
                let found = difference(modes, Decay { low, high }, pitch, rate, &input);
                println!("{name}, {low} and {high} s, pitch {pitch} at {rate} Hz: {found:.1} dB");
                worst = worst.max(found);
            }
        }
    }
    assert!(worst < -100.0, "{worst} dB");
}
