//! Compares bodies with banks in double precision, which step every mode at every frame.

use super::*;
use crate::dsp::random::{Sequence, key, uniform};
use crate::dsp::space::{BodyMode, Plate, Room, Spring, Strings};
use libm::{cos, exp, exp2, log10, sin};
use std::f64::consts::{LN_10, TAU};

/// An impulse, and a tenth of a second of noise after some frames.
fn signal(frames: usize, noise: std::ops::Range<usize>) -> Vec<f32> {
    let stream = key(5, 5);
    let sample = |n: usize| if noise.contains(&n) { 0.1 * uniform(stream, n as u64) } else { 0.0 };
    (0..frames).map(|n| if n == 100 { 1.0 } else { sample(n) }).collect()
}

/// A prepared body's output.
fn played(body: &mut Resonator, input: &[f32]) -> [Vec<f64>; 2] {
    body.prepare();
    rendered(body, input)
}

fn rendered(body: &mut Resonator, input: &[f32]) -> [Vec<f64>; 2] {
    let mut out = [Vec::new(), Vec::new()];
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
fn difference(modes: &'static ModeSet, decay: Decay, pitch: f64, rate: f64, input: &[f32]) -> f64 {
    let mut body = Resonator::new(modes, decay, rate);
    body.tune(pitch);
    let (found, exact) = (played(&mut body, input), exact(modes, decay, pitch, rate, input));
    let (mut most, mut loudest) = (0.0_f64, 0.0_f64);
    for (found, exact) in found.iter().flatten().zip(exact.iter().flatten()) {
        (most, loudest) = (most.max((found - exact).abs()), loudest.max(exact.abs()));
    }
    20.0 * log10(most / loudest)
}

/// A random body of some hundred modes.
fn random_body(random: &mut Sequence) -> &'static ModeSet {
    let mut next = || f64::from(random.uniform());
    let count = 16 + (200.0 * (1.0 + next())) as usize;
    let mode =
        |_| BodyMode { frequency: 20.0 * exp2(5.0 * (1.0 + next())), drive: next(), left: next(), right: next() };
    ModeSet::new((0..count).map(mode).collect::<Vec<_>>()).leak()
}

#[test]
fn random_bodies_are_exact() {
    for seed in 0..24 {
        let mut random = Sequence::new(key(19, seed));
        let modes = random_body(&mut random);
        let mut next = || f64::from(random.uniform());
        // All of the range.
        let mut t60 = || 0.05 * exp2(4.6 * (1.0 + next()));
        let decay = Decay { low: t60(), high: t60() };
        let rates = [8000.0, 22_050.0, 44_100.0, 48_000.0, 67_000.0, 192_000.0, 384_000.0, 768_000.0];
        let (pitch, rate) = (exp2(2.0 * next()), rates[seed as usize % rates.len()]);
        // Some blocks, so that the tail is heard.
        let input = signal((4 * block_frames(rate)).max(8000), 500..3000);
        let found = difference(modes, decay, pitch, rate, &input);
        println!("{} modes, {decay:?}, pitch {pitch:.2} at {rate} Hz: {found:.1} dB", modes.len());
        assert!(found < -100.0, "seed {seed}: {found} dB");
    }
}

#[test]
fn a_plate_is_exact() {
    let found = difference(
        Plate::default().modes().leak(),
        Decay { low: 3.0, high: 1.0 },
        1.0,
        48_000.0,
        &signal(4000, 500..3000),
    );
    assert!(found < -105.0, "{found} dB");
}

/// Whether pitch and decay moved in silence or were set at rest makes no difference.
#[test]
fn moved_bodies_are_those_made_so() {
    for (pitch, low) in [(1.0, 0.2), (1.9, 1.0), (0.4, 0.1), (30.0, 2.0)] {
        let (modes, decay) = (random_body(&mut Sequence::new(key(19, 3))), Decay { low, high: 0.3 });
        let mut made = Resonator::new(modes, decay, 48_000.0);
        made.tune(pitch);
        let mut moved = Resonator::new(modes, Decay { low: 1.0, high: 1.0 }, 48_000.0);
        moved.prepare();
        moved.tune(pitch);
        moved.set_decay(decay);
        for _ in 0..3 * moved.block / BODY_TICK {
            moved.work();
            moved.render(&[0.0; BODY_TICK]);
        }
        assert!(!moved.is_changing());
        let input = signal(4000, 500..2000);
        assert!(played(&mut made, &input) == played(&mut moved, &input), "pitch {pitch}, {low} s");
    }
}

/// How much of a body is laid out ahead, and for which coefficients, makes no difference: not if it is then prepared, not if it begins
/// during a sound, and not if the coefficients are again those that its masses have.
#[test]
fn what_is_laid_out_ahead_makes_no_difference() {
    let (modes, decay) = (Plate::default().modes().leak(), Decay { low: 3.0, high: 1.0 });
    let input = signal(2000, 500..1500);
    type Start = fn(&mut Resonator);
    let starts: [Start; 2] = [Resonator::prepare, Resonator::begin];
    for (start, is_known) in starts.into_iter().flat_map(|start| [(start, true), (start, false)]) {
        let played = |slices: usize| {
            let mut body = Resonator::with_room(modes.len(), decay, 48_000.0);
            body.load(modes);
            if is_known {
                body.prepare();
            }
            for pitch in [1.3, 1.0] {
                body.tune(pitch);
                (0..slices).for_each(|_| body.prepare_ahead(1));
            }
            start(&mut body);
            rendered(&mut body, &input)
        };
        let expected = played(0);
        for slices in [1, 70, SLICES, SLICES + 9] {
            assert!(played(slices) == expected, "{slices} slices, {is_known}");
        }
    }
}

/// A body that began with other coefficients, and was set to rest before they were heard, plays as one made so.
#[test]
fn a_body_that_only_began_is_as_new() {
    let (modes, decay) = (random_body(&mut Sequence::new(key(19, 3))), Decay { low: 1.0, high: 0.3 });
    let (mut made, input) = (Resonator::new(modes, decay, 48_000.0), signal(2000, 500..1500));
    let mut began = made.clone();
    began.tune(1.5);
    began.begin();
    began.reset();
    began.tune(1.0);
    assert!(played(&mut made, &input) == played(&mut began, &input));
}

/// Of springs, only T60s are tried with which an echo arrives before it has decayed: with shorter ones, the loudest frame is
/// itself far below the masses, whose outputs cancel before an echo.
#[test]
#[ignore = "takes minutes"]
fn bodies_are_exact_at_all_settings() {
    let all = [[3.0, 1.0], [30.0, 10.0], [1.0, 30.0], [0.3, 0.2], [0.15, 0.1], [0.05, 0.05], [0.05, 30.0]];
    let bodies = [
        ("plate", Plate::default().modes().leak(), &all[..]),
        ("room", Room::default().modes().leak(), &all[..]),
        ("spring", Spring::default().modes().leak(), &all[..4]),
        ("strings", Strings::new([65.4, 98.0, 220.0, 277.18]).modes().leak(), &all[..]),
    ];
    let mut worst = f64::MIN;
    for (name, modes, decays) in &bodies {
        for [low, high] in *decays {
            let rates =
                [(1.0, 48_000.0), (4.0, 48_000.0), (0.2, 44_100.0), (1.0, 8000.0), (1.0, 96_000.0), (1.7, 67_000.0)];
            for (pitch, rate) in rates {
                let decay = Decay { low: *low, high: *high };
                let found = difference(modes, decay, pitch, rate, &signal(24_000, 3000..10_000));
                println!("{name}, {low} and {high} s, pitch {pitch} at {rate} Hz: {found:.1} dB");
                worst = worst.max(found);
            }
        }
    }
    assert!(worst < -100.0, "{worst} dB");
}
