//! Tests of the soundbox: its response, its bounds, its sleep, and that blocks do not matter.

use super::*;
use crate::dsp::random::{Sequence, key};
use libm::pow;
use std::f64::consts::TAU;

const BODIES: [fn() -> &'static BoxBody; 5] =
    [BoxBody::violin, BoxBody::guitar, BoxBody::soundboard, BoxBody::voice, BoxBody::horn];

fn wet(body: &'static BoxBody, sample_rate: f64) -> Soundbox {
    let mut soundbox = Soundbox::new(sample_rate);
    soundbox.set_body(body);
    soundbox.set_mix(1.0);
    soundbox.reset();
    soundbox
}

/// What both sides give for an impulse.
fn response(soundbox: &mut Soundbox, frames: usize) -> [Vec<f32>; 2] {
    let mut sides = [vec![0.0; frames], vec![0.0; frames]];
    (sides[0][0], sides[1][0]) = (1.0, 1.0);
    let [left, right] = &mut sides;
    soundbox.process(left, right);
    sides
}

/// Gain of a lasting sine, from the response to an impulse.
fn gain(response: &[f32], frequency: f64, sample_rate: f64) -> f64 {
    let (sin, cos) = libm::sincos(TAU * frequency / sample_rate);
    let turned = |(re, im), y: &f32| (re * cos - im * sin + f64::from(*y), re * sin + im * cos);
    let (re, im) = response.iter().rev().fold((0.0, 0.0), turned);
    libm::hypot(re, im)
}

#[test]
fn the_response_is_the_sum_of_damped_sines() {
    for (place, body) in BODIES.iter().enumerate() {
        let (body, rate, size) = (body(), 48_000.0, 1.5);
        let mut soundbox = wet(body, rate);
        soundbox.set_size(size);
        soundbox.set_vowel(0.3);
        let [left, right] = response(&mut soundbox, 4800);
        let exact = |side: usize, n: usize| {
            let mode = |mode: Resonance| {
                let sigma = PI * mode.bandwidth / (size * rate);
                let phase = TAU * mode.frequency / (size * rate) * n as f64;
                let wave = if mode.is_velocity { cos(phase) } else { sin(phase) };
                let push = -2.0 * expm1(-sigma) * mode.gain;
                f64::from(mode.sides[side]) * push * libm::exp(-sigma * n as f64) * wave
            };
            body.at(0.3).map(mode).sum::<f64>()
        };
        let (mut error, mut loudest) = (0.0_f64, 0.0_f64);
        for n in 0..4799 {
            for (side, found) in [&left, &right].into_iter().enumerate() {
                let expected = exact(side, n + 1);
                error = error.max((f64::from(found[n]) - expected).abs());
                loudest = loudest.max(expected.abs());
            }
        }
        println!("body {place}: {:.1} dB", 20.0 * libm::log10(error / loudest));
        assert!(error < 1e-5 * loudest, "body {place}: {error}, loudest {loudest}");
    }
}

#[test]
fn vowels_have_their_formants_at_any_rate() {
    for rate in [22_050.0, 48_000.0, 96_000.0] {
        // A tenor's a and i.
        for (vowel, formants) in [(0.5, [650.0, 1080.0]), (1.0, [290.0, 1870.0])] {
            let mut voice = wet(BoxBody::voice(), rate);
            voice.set_vowel(vowel);
            let [left, _] = response(&mut voice, (0.1 * rate) as usize);
            for formant in formants {
                let ratios = (0..20).map(|n| 0.8 + 0.02 * f64::from(n));
                let gains = ratios.map(|ratio| (gain(&left, formant * ratio, rate), ratio));
                let (_, peak) = gains.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
                assert!((0.9..1.1).contains(&peak), "{formant} Hz of {vowel} at {rate} Hz: {peak}");
            }
        }
    }
}

#[test]
fn pink_noise_keeps_its_loudness() {
    for (place, body) in BODIES.iter().enumerate() {
        let [left, right] = response(&mut wet(body(), 48_000.0), 24_000);
        let steps = 400;
        let energy =
            (0..steps).map(|n| 50.0 * libm::pow(200.0, (f64::from(n) + 0.5) / f64::from(steps))).map(|frequency| {
                let gains = [&left, &right].map(|side| gain(side, frequency, 48_000.0));
                0.5 * (gains[0] * gains[0] + gains[1] * gains[1])
            });
        let decibels = 10.0 * libm::log10(energy.sum::<f64>() / f64::from(steps));
        println!("body {place}: {decibels:.1} dB");
        assert!(decibels.abs() < 0.5, "body {place}: {decibels} dB");
    }
}

#[test]
fn the_response_that_is_drawn_is_that_which_is_played() {
    for body in BODIES {
        let (response_of, [left, right]) = (body().response(0.4), {
            let mut soundbox = wet(body(), 48_000.0);
            soundbox.set_vowel(0.4);
            response(&mut soundbox, 24_000)
        });
        // The first half sample of each resonance is not played, which makes a decibel, and more far below them.
        for frequency in [300.0, 777.0, 2000.0] {
            let gains = [&left, &right].map(|side| gain(side, frequency, 48_000.0));
            let played = sqrt(0.5 * (gains[0] * gains[0] + gains[1] * gains[1]));
            let drawn = pow(10.0, response_of(frequency) / 20.0);
            assert!((played - drawn).abs() < 0.15, "{frequency} Hz: {played}, {drawn}");
        }
    }
}

/// Whatever moves, the output stays within the bound that is computed from the input's peak.
#[test]
fn nothing_exceeds_the_bound_while_all_moves() {
    for seed in 0..40 {
        let mut random = Sequence::new(key(31, seed));
        let mut soundbox = wet(BODIES[random.below(5)](), [8_000.0, 48_000.0, 192_000.0][random.below(3)]);
        let mut most = 0.0_f64;
        for _ in 0..300 {
            match random.below(5) {
                0 => soundbox.set_body(BODIES[random.below(5)]()),
                1 => soundbox.set_size(libm::exp2(4.0 * f64::from(random.uniform()))),
                2 => soundbox.set_vowel(random.uniform()),
                3 => soundbox.set_mix(0.5 + 0.5 * random.uniform()),
                _ => {}
            }
            let (mut left, mut right) = ([0.0; 50], [0.0; 50]);
            left.fill_with(|| random.uniform());
            right.fill_with(|| random.uniform());
            most = most.max(soundbox.peak_after(1.0));
            soundbox.process(&mut left, &mut right);
            let loudest = left.iter().chain(&right).fold(0.0_f32, |most, sample| most.max(sample.abs()));
            assert!(f64::from(loudest) <= most, "seed {seed}: {loudest} where {most} is the bound");
        }
    }
}

#[test]
fn it_sleeps_when_its_tail_is_over() {
    for body in BODIES {
        let mut soundbox = wet(body(), 48_000.0);
        response(&mut soundbox, 100);
        let told = soundbox.tail_frames_after(0, 0.0);
        let (mut frames, mut last) = (0, 0.0);
        while !soundbox.is_idle() {
            let (mut left, mut right) = ([0.0_f32; 32], [0.0; 32]);
            soundbox.process(&mut left, &mut right);
            last = left.iter().chain(&right).fold(0.0_f32, |most, sample| most.max(sample.abs()));
            frames += 32;
            assert!(frames <= told + 32);
        }
        assert!(last < 1e-6 && told < 3 * frames + 4800, "{told} frames told, {frames} were, {last} at the end");
        let mut silence = [[0.0; 100], [-0.0; 100]];
        let [left, right] = &mut silence;
        soundbox.process(left, right);
        assert!(silence[1].iter().all(|sample| sample.to_bits() == (-0.0_f32).to_bits()));
    }
}

/// While one body fades out, bounds of level and tail already hold for the body that waits.
#[test]
fn a_body_that_waits_is_foreseen() {
    let mut soundbox = wet(BoxBody::violin(), 48_000.0);
    response(&mut soundbox, 50);
    soundbox.set_body(BoxBody::voice());
    let (mut most, mut frames) = (vec![], 0);
    while frames < 1600 {
        most.push(soundbox.peak_after(1.0));
        let mut sides = [[0.0_f32; 40], [0.0; 40]];
        // The body that waits is driven at its strongest resonance.
        sides.as_flattened_mut().iter_mut().zip(0..).for_each(|(sample, n)| {
            *sample = sin(TAU * 650.0 / 48_000.0 * (frames + n % 40) as f64) as f32;
        });
        let [left, right] = &mut sides;
        soundbox.process(left, right);
        let loudest = sides.as_flattened().iter().fold(0.0_f32, |most, sample| most.max(sample.abs()));
        assert!(most.iter().all(|most| f64::from(loudest) <= *most), "{loudest} at frame {frames}: {most:?}");
        frames += 40;
    }
    // The same fade in silence.
    let mut soundbox = wet(BoxBody::violin(), 48_000.0);
    response(&mut soundbox, 50);
    soundbox.set_body(BoxBody::voice());
    let (mut told, mut frames) = (vec![], 0);
    while !soundbox.is_idle() {
        told.push(frames + soundbox.tail_frames_after(0, 0.0));
        soundbox.process(&mut [0.0; 40], &mut [0.0; 40]);
        frames += 40;
    }
    assert!(told.iter().all(|told| frames <= told + 40), "{frames}, told {told:?}");
}

#[test]
fn blocks_do_not_matter() {
    let play = |block: usize| {
        let mut soundbox = wet(BoxBody::voice(), 48_000.0);
        let mut random = Sequence::new(key(5, 0));
        let mut sides =
            [0, 1].map(|_| (0..24_000).map(|n| if n < 9000 { random.uniform() } else { 0.0 }).collect::<Vec<f32>>());
        let [left, right] = &mut sides;
        // Changes at the same frames for all blocks.
        for (n, (left, right)) in left.chunks_mut(1000).zip(right.chunks_mut(1000)).enumerate() {
            match n {
                3 => soundbox.set_vowel(0.9),
                5 => soundbox.set_body(BoxBody::horn()),
                7 => soundbox.set_size(2.0),
                8 => soundbox.set_mix(0.4),
                _ => {}
            }
            for (left, right) in left.chunks_mut(block).zip(right.chunks_mut(block)) {
                soundbox.process(left, right);
            }
        }
        sides.map(|side| side.into_iter().map(f32::to_bits).collect::<Vec<_>>())
    };
    let whole = play(1000);
    for block in [1, 7, 64, 333] {
        assert!(play(block) == whole, "blocks of {block}");
    }
}

#[test]
fn off_it_changes_nothing() {
    let mut soundbox = Soundbox::new(48_000.0);
    let signal = [0.3, -0.2, f32::NAN, 1e9, -0.0];
    let (mut left, mut right) = (signal, signal);
    soundbox.process(&mut left, &mut right);
    assert!(left.map(f32::to_bits) == signal.map(f32::to_bits) && right.map(f32::to_bits) == signal.map(f32::to_bits));
    // Neither NaN nor large input makes its masses overflow.
    soundbox.set_mix(1.0);
    let (mut left, mut right) = ([f32::NAN; 3000], [f32::INFINITY; 3000]);
    soundbox.process(&mut left, &mut right);
    let (mut left, mut right) = ([0.0; 3000], [0.0; 3000]);
    soundbox.process(&mut left, &mut right);
    assert!(left.iter().chain(&right).all(|sample| sample.is_finite()));
}

/// A body that grows by a tenth in 20 ms under a sine makes no more noise far above it than a straight ramp of the mix does.
#[test]
fn what_moves_does_not_click() {
    let noise = |turn: fn(&mut Soundbox)| {
        let mut soundbox = wet(BoxBody::guitar(), 48_000.0);
        let mut left: Vec<f32> = (0..12_000).map(|n| sin(0.0144 * f64::from(n)) as f32).collect();
        let mut right = left.clone();
        soundbox.process(&mut left[..10_000], &mut right[..10_000]);
        turn(&mut soundbox);
        soundbox.process(&mut left[10_000..], &mut right[10_000..]);
        // The fourth difference leaves nothing of the sine.
        let fourth = |w: &[f32]| f64::from(w[0] - 4.0 * w[1] + 6.0 * w[2] - 4.0 * w[3] + w[4]).abs();
        left[9990..].windows(5).map(fourth).fold(0.0, f64::max)
    };
    let [still, mixed, larger] =
        [noise(|_| {}), noise(|soundbox| soundbox.set_mix(0.5)), noise(|soundbox| soundbox.set_size(1.1))];
    println!("{still:.1e} at rest, {mixed:.1e} by the mix, {larger:.1e} by the size");
    assert!(still < 1e-5 && larger < mixed, "{larger} by the size, {mixed} by the mix");
}
