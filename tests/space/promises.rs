//! What a reverb promises, whatever its body: passive, asleep in silence, smooth, and nothing allocated.

use crate::signal::{RATE, blocks_are_equal, impulse, noise, peak, rms};
use crate::{AllocDisabler, reverb};
use assert_no_alloc::{assert_no_alloc, violation_count};
use sprung::dsp::random::{key, uniform};
use sprung::dsp::space::{BodyMode, Decay, ModalReverb, ModeSet, Plate, Resonator, Spring, Strings};

const DECAY: Decay = Decay { low: 0.4, high: 0.2 };

/// A few hundred modes, quickly played.
fn small() -> ModeSet {
    Plate { length: 0.6, width: 0.35, thickness: 0.001, ..Plate::default() }.modes()
}

/// Numbers from −1 to 1, one after the other.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let (stream, mut n) = (key(17, seed), 0);
    move || {
        n += 1;
        f64::from(uniform(stream, n))
    }
}

#[test]
fn energy_never_exceeds_what_came_in() {
    for seed in 0..60 {
        let mut next = numbers(seed);
        let count = 16 + (200.0 * (1.0 + next())) as usize;
        let modes = ModeSet::new((0..count).map(|_| BodyMode {
            frequency: 20.0 * libm::exp2(5.0 * (1.0 + next())),
            drive: next(),
            left: next(),
            right: next(),
        }));
        let decay = |next: &mut dyn FnMut() -> f64| {
            let mut t60 = || 0.05 * libm::exp2(4.6 * (1.0 + next()));
            Decay { low: t60(), high: t60() }
        };
        let rate = [22_050.0, 44_100.0, 48_000.0, 192_000.0][seed as usize % 4];
        let mut reverb = ModalReverb::new(Resonator::new(&modes, decay(&mut next), rate));
        reverb.set_mix(1.0);
        let norm = (reverb.body().len() as f64).sqrt();
        let mut before = 0.0;
        for block in 0..400 {
            if next() > 0.7 {
                reverb.set_decay(decay(&mut next));
            }
            let level = if block % 8 < 4 { 10.0 } else { 0.0 };
            let (mut left, mut right) = ([0.0; 24], [0.0; 24]);
            left.fill_with(|| (level * next()) as f32);
            right.fill_with(|| (level * next()) as f32);
            let came: f64 = left.iter().zip(&right).map(|(l, r)| f64::from(0.5 * (l + r)).abs()).sum();
            reverb.process(&mut left, &mut right);
            let after = reverb.body().energy().sqrt();
            assert!(after <= (before + came * norm) * (1.0 + 1e-6), "seed {seed}: {before} + {came} to {after}");
            before = after;
        }
        assert!(before > 0.0);
    }
}

#[test]
fn it_sleeps_when_the_tail_is_over_and_says_when() {
    for (name, modes) in [("small plate", small()), ("springs", Spring::default().modes()), ("none", ModeSet::new([]))]
    {
        let mut reverb = reverb(&modes, DECAY, 1.0);
        assert!(reverb.is_silent() && reverb.tail_frames() == 0);
        let [mut left, mut right] = impulse(64);
        reverb.process(&mut left, &mut right);
        assert!(!reverb.is_silent());
        let told = reverb.tail_frames();
        let (mut frames, mut loudest) = (0, 0.0);
        while !reverb.is_silent() {
            let [mut left, mut right] = [[0.0; 32]; 2];
            reverb.process(&mut left, &mut right);
            loudest = peak(&left).max(peak(&right));
            frames += 32;
            assert!(frames < told + 32, "{name}: longer than {told} frames");
        }
        println!("{name}: {told} frames told, {frames} were");
        // What goes with the sleep is below −120 dBFS; and the bound is no wild one.
        assert!(loudest < 1e-6, "{name}: {loudest} at the end");
        assert!(told <= frames + frames / 5 + 4096, "{name}: {told} frames told, {frames} were");
        // Asleep, silence is left as it is; and what comes wakes it, as new.
        let [mut left, mut right] = [[-0.0; 100]; 2];
        reverb.process(&mut left, &mut right);
        assert!(left.iter().chain(&right).all(|sample| sample.to_bits() == (-0.0_f32).to_bits()));
        left[50] = 0.5;
        reverb.process(&mut left, &mut right);
        assert!(!reverb.is_silent());
    }
}

/// After noise, where the bound is far above what there is until the energy has been measured.
#[test]
fn what_is_measured_makes_tails_shorter() {
    let mut reverb = reverb(&small(), DECAY, 1.0);
    let [mut left, mut right] = noise(0.5, 48_000, 48_000);
    reverb.process(&mut left, &mut right);
    let told = reverb.tail_frames();
    let mut frames = 0;
    while !reverb.is_silent() {
        reverb.process(&mut [0.0; 32], &mut [0.0; 32]);
        frames += 32;
    }
    println!("{told} frames told, {frames} were");
    assert!(frames <= told && frames > 24_000);
}

#[test]
fn off_it_touches_nothing() {
    let mut reverb = ModalReverb::new(Resonator::new(&small(), DECAY, RATE));
    let signal = noise(0.5, 4800, 4800);
    let [mut left, mut right] = signal.clone();
    reverb.process(&mut left, &mut right);
    assert_eq!([left, right], signal);
    assert!(reverb.is_silent() && reverb.tail_frames() == 0);
    // On and off again: it comes to rest while input goes on.
    reverb.set_mix(0.5);
    let [mut left, mut right] = signal.clone();
    reverb.process(&mut left, &mut right);
    assert_ne!([&left, &right], [&signal[0], &signal[1]]);
    reverb.set_mix(0.0);
    let [mut left, mut right] = signal.clone();
    reverb.process(&mut left, &mut right);
    let [mut left, mut right] = signal.clone();
    reverb.process(&mut left, &mut right);
    assert_eq!([left, right], signal);
    assert!(reverb.is_silent());
}

#[test]
fn blocks_do_not_matter() {
    let mut one = reverb(&small(), DECAY, 0.4);
    one.set_pre_delay(0.013);
    let mut signal = noise(0.3, 3000, 80_000);
    // Asleep in between, and woken within a tick.
    signal[0][70_007..70_100].fill(0.25);
    let other = Resonator::new(&Strings::new([220.0, 330.0]).modes(), DECAY, RATE);
    let turn = |reverb: &mut ModalReverb, frame: usize| match frame {
        1001 => reverb.set_decay(Decay { low: 0.3, high: 0.15 }),
        1500 => reverb.set_pre_delay(0.04),
        2003 => reverb.set_mix(0.7),
        2501 => assert!(reverb.replace_body(other.clone()).is_ok()),
        66_003 => {
            assert!(reverb.is_silent());
            reverb.set_mix(0.6);
            reverb.set_decay(DECAY);
        }
        _ => reverb.set_mix(0.0),
    };
    blocks_are_equal(&one, &signal, &[1001, 1500, 2003, 2501, 66_003, 75_001], turn, ModalReverb::process);
}

#[test]
fn a_whole_plate_has_the_same_bits_in_blocks() {
    let one = reverb(&Plate::default().modes(), Decay { low: 3.0, high: 1.0 }, 0.4);
    blocks_are_equal(&one, &noise(0.3, 500, 700), &[], |_, _| {}, ModalReverb::process);
}

#[test]
fn nothing_clicks() {
    let mut rings = reverb(&small(), Decay { low: 2.0, high: 1.0 }, 1.0);
    let [mut left, mut right] = noise(0.3, 24_000, 24_100);
    rings.process(&mut left, &mut right);
    let level = rms(&left[20_000..]);
    let silence = || [vec![0.0; 2400], vec![0.0; 2400]];
    let [mut plain, mut plain_right] = silence();
    rings.clone().process(&mut plain, &mut plain_right);
    type Turn = fn(&mut ModalReverb);
    let turns: [(&str, Turn); 4] = [
        ("decay", |reverb| reverb.set_decay(Decay { low: 0.1, high: 0.1 })),
        ("mix", |reverb| reverb.set_mix(0.0)),
        ("delay", |reverb| reverb.set_pre_delay(0.1)),
        ("body", |reverb| {
            let other = Resonator::new(&Spring::default().modes(), DECAY, RATE);
            assert!(reverb.replace_body(other).is_ok());
        }),
    ];
    for (name, turn) in turns {
        let mut turned = rings.clone();
        turn(&mut turned);
        let [mut left, mut right] = silence();
        turned.process(&mut left, &mut right);
        // What is taken away comes gradually.
        let steps = left.iter().zip(&plain).map(|(a, b)| f64::from(a - b)).collect::<Vec<_>>();
        let first = steps[..4].iter().fold(0.0_f64, |most, step| most.max(step.abs()));
        let most = steps.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        println!("{name}: {first:.2e} at first, at most {most:.2e} from sample to sample, of {level:.2e}");
        let undisturbed = f64::from(plain.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max));
        assert!(first < 0.02 * level && most < undisturbed * 1.01, "{name}");
    }
}

#[test]
fn a_replaced_body_is_handed_out() {
    let mut rings = reverb(&small(), DECAY, 1.0);
    let body = || Resonator::new(&Spring::default().modes(), DECAY, RATE);
    let springs = body().len();
    // At rest, at once.
    assert!(rings.replace_body(body()).is_ok() && rings.body().len() == springs);
    assert!(rings.replace_body(body()).is_err(), "the first has not been taken");
    assert!(rings.take_replaced().is_some());
    let [mut left, mut right] = noise(0.3, 1000, 1000);
    rings.process(&mut left, &mut right);
    assert!(rings.replace_body(Resonator::new(&small(), DECAY, RATE)).is_ok());
    assert!(rings.take_replaced().is_none() && rings.tail_frames() >= 4800);
    let [mut left, mut right] = noise(0.3, 6000, 6000);
    rings.process(&mut left, &mut right);
    assert_eq!(rings.take_replaced().map(|body| body.len()), Some(springs));
}

#[test]
fn nonsense_is_survived() {
    let mut rings = reverb(&small(), DECAY, 0.5);
    for value in [f32::NAN, f32::INFINITY, -f32::INFINITY, f32::MAX, 1e-40, -0.0] {
        rings.process(&mut [value; 100], &mut [value; 100]);
        rings.set_mix(value);
        rings.set_levels(value, value);
        rings.set_pre_delay(value.into());
        rings.set_decay(Decay { low: value.into(), high: (-value).into() });
    }
    rings.set_mix(0.5);
    rings.process(&mut [0.0; 100], &mut [0.0; 100]);
    let [mut left, mut right] = noise(0.5, 24_000, 24_000);
    rings.process(&mut left, &mut right);
    assert!(left.iter().chain(&right).all(|sample| sample.is_finite()));
    rings.process(&mut [0.0; 3], &mut []);
}

#[test]
fn nothing_is_allocated() {
    let _: &AllocDisabler = &crate::ALLOCATOR;
    let mut rings = reverb(&small(), DECAY, 0.5);
    let [mut left, mut right] = noise(0.5, 2000, 40_000);
    let mut next = numbers(1);
    let mut body = Some(Resonator::new(&Spring::default().modes(), DECAY, RATE));
    assert_no_alloc(|| {
        for (left, right) in left.chunks_mut(100).zip(right.chunks_mut(100)) {
            rings.set_mix(next() as f32);
            rings.set_decay(Decay { low: 1.0 + 0.5 * next(), high: 1.0 });
            rings.set_pre_delay(0.2 * next());
            rings.process(left, right);
            std::hint::black_box((rings.tail_frames(), rings.is_silent()));
            if let Some(replaced) = body.take() {
                body = rings.replace_body(replaced).err();
            }
            body = body.take().or(rings.take_replaced());
        }
        rings.reset();
    });
    assert_eq!(violation_count(), 0);
}
