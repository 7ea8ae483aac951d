//! Properties of a reverb with any body: it is passive, idle in silence, smooth, and allocates nothing.

use super::reverb;
use super::signal::{RATE, blocks_are_equal, decibels, impulse, noise, octave, peak, rms};
use assert_no_alloc::{assert_no_alloc, violation_count};
use sprung::internals::random::{Sequence, key};
use sprung::internals::space::{BodyMode, Decay, ModalReverb, ModeSet, Plate, Resonator, Spring, Strings};
use std::sync::LazyLock;

const DECAY: Decay = Decay { low: 0.4, high: 0.2 };

/// A plate with a few hundred modes, which takes little time to play.
fn small() -> ModeSet {
    Plate { length: 0.6, width: 0.35, thickness: 0.001, ..Plate::default() }.modes()
}

static SMALL: LazyLock<ModeSet> = LazyLock::new(small);
static SPRINGS: LazyLock<ModeSet> = LazyLock::new(|| Spring::default().modes());
static PAIR: LazyLock<ModeSet> = LazyLock::new(|| Strings::new([220.0, 330.0]).modes());

/// A reverb with room for the largest of these bodies.
fn with_room(sets: &[&ModeSet]) -> ModalReverb {
    let most = sets.iter().map(|modes| modes.len()).max().unwrap();
    ModalReverb::new(Resonator::with_room(most, DECAY, RATE))
}

#[test]
fn energy_never_exceeds_what_came_in() {
    for seed in 0..60 {
        let mut random = Sequence::new(key(17, seed));
        let mut next = || f64::from(random.uniform());
        let count = 16 + (200.0 * (1.0 + next())) as usize;
        let modes = ModeSet::new((0..count).map(|_| BodyMode {
            frequency: 20.0 * libm::exp2(5.0 * (1.0 + next())),
            drive: next(),
            left: next(),
            right: next(),
        }))
        .leak();
        let decay = |next: &mut dyn FnMut() -> f64| {
            let mut t60 = || 0.05 * libm::exp2(4.6 * (1.0 + next()));
            Decay { low: t60(), high: t60() }
        };
        let rate = [22_050.0, 44_100.0, 48_000.0, 192_000.0][seed as usize % 4];
        let mut reverb = ModalReverb::new(Resonator::new(modes, decay(&mut next), rate));
        reverb.set_mix(1.0);
        let norm = (modes.len() as f64).sqrt();
        // Input reaches the masses in the block after its own, slice by slice.
        let (mut before, mut came) = (0.0, [0.0; 2]);
        let (mut frames, body_block) = (0, reverb.body().block_frames());
        for block in 0..1200 {
            if next() > 0.7 {
                reverb.set_decay(decay(&mut next));
            }
            if next() > 0.8 {
                reverb.set_pitch(libm::exp2(3.0 * next()) as f32);
            }
            let level = if block % 200 < 100 { 10.0 } else { 0.0 };
            let (mut left, mut right) = ([0.0; 32], [0.0; 32]);
            left.fill_with(|| (level * next()) as f32);
            right.fill_with(|| (level * next()) as f32);
            came[0] += left.iter().zip(&right).map(|(l, r)| f64::from(0.5 * (l + r)).abs()).sum::<f64>();
            reverb.process(&mut left, &mut right);
            frames += 32;
            if frames % body_block == 0 {
                let after = reverb.body().energy().sqrt();
                assert!(
                    after <= (before + came[1] * norm) * (1.0 + 1e-6),
                    "seed {seed}: {before} + {came:?} to {after}"
                );
                (before, came) = (after, [0.0, came[0]]);
            }
        }
        assert!(before > 0.0);
    }
}

#[test]
fn it_sleeps_when_the_tail_is_over_and_says_when() {
    for (name, modes) in [("small plate", small()), ("springs", Spring::default().modes()), ("none", ModeSet::new([]))]
    {
        let mut reverb = reverb(modes, DECAY, 1.0);
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
        // The last samples before it is silent are below −120 dBFS, and the tail that was told is not far too long.
        assert!(loudest < 1e-6, "{name}: {loudest} at the end");
        assert!(told <= frames + frames / 5 + 4096, "{name}: {told} frames told, {frames} were");
        // While it is idle, silence passes unchanged, and input wakes it.
        let [mut left, mut right] = [[-0.0; 100]; 2];
        reverb.process(&mut left, &mut right);
        assert!(left.iter().chain(&right).all(|sample| sample.to_bits() == (-0.0_f32).to_bits()));
        left[50] = 0.5;
        reverb.process(&mut left, &mut right);
        assert!(!reverb.is_silent());
    }
}

/// After noise, the first tail is a bound, which is far too long until the energy has been measured.
#[test]
fn what_is_measured_makes_tails_shorter() {
    let mut reverb = reverb(small(), DECAY, 1.0);
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
    let mut reverb = ModalReverb::new(Resonator::new(small().leak(), DECAY, RATE));
    let signal = noise(0.5, 4800, 4800);
    let [mut left, mut right] = signal.clone();
    reverb.process(&mut left, &mut right);
    assert_eq!([left, right], signal);
    assert!(reverb.is_silent() && reverb.tail_frames() == 0);
    // Switched on and off again, it becomes silent although input continues.
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
    let mut one = reverb(small(), DECAY, 0.4);
    one.set_pre_delay(0.013);
    let mut signal = noise(0.3, 3000, 80_000);
    // The reverb is idle in between, and input wakes it within a control tick.
    signal[0][70_007..70_100].fill(0.25);
    let turn = |reverb: &mut ModalReverb, frame: usize| match frame {
        1001 => reverb.set_decay(Decay { low: 0.3, high: 0.15 }),
        1500 => reverb.set_pre_delay(0.04),
        2003 => reverb.set_mix(0.7),
        2501 => reverb.set_body(&PAIR),
        2600 => reverb.set_pitch(0.7),
        66_003 => {
            assert!(reverb.is_silent());
            reverb.set_mix(0.6);
            reverb.set_decay(DECAY);
        }
        _ => reverb.set_mix(0.0),
    };
    blocks_are_equal(&one, &signal, &[1001, 1500, 2003, 2501, 2600, 66_003, 75_001], turn, ModalReverb::process);
}

#[test]
fn a_whole_plate_has_the_same_bits_in_blocks() {
    let one = reverb(Plate::default().modes(), Decay { low: 3.0, high: 1.0 }, 0.4);
    blocks_are_equal(&one, &noise(0.3, 500, 700), &[], |_, _| {}, ModalReverb::process);
}

#[test]
fn nothing_clicks() {
    let mut rings = reverb(small(), Decay { low: 2.0, high: 1.0 }, 1.0);
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
        ("body", |reverb| reverb.set_body(&SPRINGS)),
    ];
    for (name, turn) in turns {
        let mut turned = rings.clone();
        turn(&mut turned);
        let [mut left, mut right] = silence();
        turned.process(&mut left, &mut right);
        // The change fades in gradually.
        let steps = left.iter().zip(&plain).map(|(a, b)| f64::from(a - b)).collect::<Vec<_>>();
        let first = steps[..4].iter().fold(0.0_f64, |most, step| most.max(step.abs()));
        let most = steps.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        println!("{name}: {first:.2e} at first, at most {most:.2e} from sample to sample, of {level:.2e}");
        let undisturbed = f64::from(plain.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max));
        assert!(first < 0.02 * level && most < undisturbed * 1.01, "{name}");
    }
    // At a lower pitch, modes continue from their present state, by smaller steps.
    let step = |samples: &[f32]| samples.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    let mut lower = rings.clone();
    lower.set_pitch(0.6);
    let [mut left, mut right] = silence();
    lower.process(&mut left, &mut right);
    let (own, turned) = (step(&plain), step(&left));
    println!("pitch: {turned:.2e}, its own {own:.2e}");
    assert!(turned < 1.05 * own && left != plain, "{turned}, {own}");
}

/// What of a signal is far above 2 kHz, relative to all of it, in dB: eight differences.
fn above(samples: &[f32]) -> f64 {
    let mut high: Vec<f64> = samples.iter().map(|sample| f64::from(*sample)).collect();
    for _ in 0..8 {
        high = high.windows(2).map(|pair| 0.5 * (pair[1] - pair[0])).collect();
    }
    let level = |samples: &[f64]| (samples.iter().map(|x| x * x).sum::<f64>() / samples.len() as f64).sqrt();
    decibels(level(&high) / rms(samples))
}

/// While pitch and decay move, nothing is heard where there are no modes. (A bank whose coefficients jump leaves −111 dB for the
/// semitone and −85 dB for the fifth.)
#[test]
fn moves_are_smooth() {
    let modes = Plate { length: 0.9, width: 0.5, top: 2000.0, ..Plate::default() }.modes();
    let decay = Decay { low: 2.0, high: 1.0 };
    let mut rings = reverb(modes, decay, 1.0);
    let [mut left, mut right] = impulse(24_000);
    rings.process(&mut left, &mut right);
    type Turn = fn(&mut ModalReverb);
    let turns: [(&str, f64, Turn); 4] = [
        ("a semitone", -120.0, |reverb| reverb.set_pitch(1.06)),
        ("a fifth", -105.0, |reverb| reverb.set_pitch(1.5)),
        ("an octave", -105.0, |reverb| reverb.set_pitch(0.5)),
        ("decay", -100.0, |reverb| reverb.set_decay(Decay { low: 0.4, high: 0.2 })),
    ];
    for (name, most, turn) in turns {
        let mut turned = rings.clone();
        turn(&mut turned);
        let [mut left, mut right] = [vec![0.0; 4000], vec![0.0; 4000]];
        turned.process(&mut left, &mut right);
        let found = above(&left);
        println!("{name}: {found:.1} dB");
        assert!(found < most, "{name}: {found} dB");
    }
}

/// A body that is switched on while input sounds is not excited by a sudden onset.
#[test]
fn what_sounds_already_comes_in_gently() {
    let tone = |n: usize| 0.3 * libm::sin(0.01 * n as f64) as f32;
    let heard = |turn: fn(&mut ModalReverb)| {
        let mut rings = with_room(&[&SMALL, &SPRINGS]);
        rings.set_body(&SPRINGS);
        let mut left: Vec<f32> = (0..24_000).map(tone).collect();
        let mut right = left.clone();
        rings.process(&mut left[..5150], &mut right[..5150]);
        turn(&mut rings);
        rings.process(&mut left[5150..], &mut right[5150..]);
        // Above 2 kHz there is only the effect of a sudden onset.
        let high = octave(&left, 4000.0)[5000..].iter().fold(0.0_f64, |most, sample| most.max(sample.abs()));
        assert!(rings.body().energy() > 0.0);
        high
    };
    let sudden = heard(|reverb| {
        reverb.set_levels(0.0, 1.0);
        reverb.reset();
    });
    let on = heard(|reverb| reverb.set_levels(0.0, 1.0));
    println!("{on:.2e} when it is switched on, {sudden:.2e} when it is struck");
    assert!(on < 0.05 * sudden, "{on}, {sudden}");
}

#[test]
fn a_body_goes_over_into_another() {
    let sets = [&*SMALL, &*SPRINGS];
    let mut rings = with_room(&sets);
    // At rest, the body is replaced at once.
    rings.set_body(&SPRINGS);
    assert_eq!(rings.body().len(), SPRINGS.len());
    rings.set_mix(1.0);
    let [mut left, mut right] = noise(0.3, 1000, 1000);
    rings.process(&mut left, &mut right);
    rings.set_body(&SMALL);
    rings.set_decay(DECAY);
    let told = rings.tail_frames();
    let heard = SMALL.modes().iter().filter(|mode| mode.frequency < 0.49 * RATE).count();
    let mut frames = 0;
    while !rings.is_silent() {
        let [mut left, mut right] = [[0.0; 32]; 2];
        rings.process(&mut left, &mut right);
        frames += 32;
    }
    assert!(rings.body().len() == heard && frames < told + 32, "{frames} frames, {told} told");
    let [mut left, mut right] = noise(0.3, 4800, 4800);
    rings.process(&mut left, &mut right);
    let new = reverb(small(), DECAY, 1.0);
    let [mut expected, mut expected_right] = noise(0.3, 4800, 4800);
    new.clone().process(&mut expected, &mut expected_right);
    assert!(left == expected && right == expected_right, "nothing is left of the one before");
}

/// A plate of another size sounds like this plate at another pitch.
#[test]
fn pitch_is_that_of_a_body_made_so() {
    let decay = Decay { low: 0.8, high: 0.3 };
    for pitch in [0.25, 0.5, 2.0, 4.0_f32] {
        let own = Plate { length: 0.6, width: 0.35, thickness: 0.001, top: 5000.0, ..Plate::default() };
        let size = 1.0 / f64::from(pitch).sqrt();
        let made = Plate { length: size * own.length, width: size * own.width, top: 5000.0 * f64::from(pitch), ..own };
        let [mut left, mut right] = impulse(4800);
        reverb(made.modes(), decay, 1.0).process(&mut left, &mut right);
        let mut tuned = reverb(own.modes(), decay, 1.0);
        tuned.set_pitch(pitch);
        let [mut other, mut other_right] = impulse(4800);
        tuned.process(&mut other, &mut other_right);
        let heard = made.modes().modes().iter().filter(|mode| mode.frequency < 0.49 * RATE).count();
        assert_eq!(tuned.body().len(), heard, "{pitch}");
        let differences: Vec<f32> = left.iter().zip(&other).map(|(a, b)| a - b).collect();
        let error = decibels(rms(&differences) / rms(&left));
        println!("pitch {pitch}: {error:.1} dB");
        assert!(error < -50.0, "{pitch}: {error} dB");
    }
}

/// While it is idle, frames that are left out leave the same state as played silence.
#[test]
fn skipped_frames_are_silence() {
    let mut played = reverb(small(), DECAY, 0.5);
    let mut skipped = played.clone();
    let [mut left, mut right] = noise(0.3, 5000, 5000);
    let mut bits = |reverb: &mut ModalReverb| {
        [left, right] = noise(0.3, 5000, 5000);
        reverb.process(&mut left, &mut right);
        [&left, &right].map(|side| side.iter().map(|sample| sample.to_bits()).collect::<Vec<_>>())
    };
    for frames in [1, 63, 777, 10_000] {
        played.process(&mut vec![0.0; frames], &mut vec![0.0; frames]);
        assert_eq!(bits(&mut played), bits(&mut skipped), "{frames}");
        for reverb in [&mut played, &mut skipped] {
            while !reverb.is_idle() {
                reverb.process(&mut [0.0; 32], &mut [0.0; 32]);
            }
        }
    }
}

#[test]
fn nonsense_is_survived() {
    let mut rings = reverb(small(), DECAY, 0.5);
    for value in [f32::NAN, f32::INFINITY, -f32::INFINITY, f32::MAX, 1e-40, -0.0] {
        rings.process(&mut [value; 100], &mut [value; 100]);
        rings.set_mix(value);
        rings.set_levels(value, value);
        rings.set_pre_delay(value.into());
        rings.set_pitch(value);
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
    let bodies = [&*SMALL, &*SPRINGS, &*PAIR];
    let mut rings = with_room(&bodies);
    let [mut left, mut right] = noise(0.5, 2000, 40_000);
    let mut random = Sequence::new(key(17, 1));
    let mut next = || f64::from(random.uniform());
    assert_no_alloc(|| {
        for (left, right) in left.chunks_mut(100).zip(right.chunks_mut(100)) {
            rings.set_mix(next() as f32);
            rings.set_decay(Decay { low: 1.0 + 0.5 * next(), high: 1.0 });
            rings.set_pre_delay(0.2 * next());
            rings.process(left, right);
            std::hint::black_box((rings.tail_frames(), rings.is_silent()));
            rings.set_pitch(1.0 + next() as f32);
            if next() > 0.5 {
                rings.set_body(bodies[(1.5 + 1.5 * next()) as usize % 3]);
            }
        }
        rings.reset();
    });
    assert_eq!(violation_count(), 0);
}
