//! Tension, bloom and touch: pitch and spectrum that follow the energy, and a finger that damps modes by their shapes.

use crate::damped_sine::fit;
use crate::events::{event, on, played};
use sprung::engine::{Event, EventKind, Synth};
use sprung::internals::CONTROL_FRAMES;
use sprung::internals::measures::spectrum::spectrum;
use sprung::params::Param;
use sprung::patch::routes::Source;
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::Preset;
use std::f64::consts::TAU;

const RATE: f64 = 48_000.0;

fn render(patch: &Patch, events: &[Event], seconds: f64) -> Vec<f32> {
    played(patch, (RATE, 1), events, (seconds * RATE) as usize)
}

/// A mass that is struck within one sample, at full level.
fn mass(t60: f32) -> Patch {
    Patch::default().with(Param::Decay, t60).with(Param::Gain, 0.0).with(Param::Limiter, 0.0)
}

fn set(frame: u32, param: Param, value: f32) -> Event {
    event(frame, EventKind::Param { param, value })
}

/// Pitch in cents above 220 Hz and amplitude in the middle of each stretch of 25 ms, from `start` in seconds.
fn pitches(sound: &[f32], start: f64, t60: f64, guess: f64) -> Vec<(f64, f64)> {
    let length = (0.025 * RATE) as usize;
    let mut guess = guess;
    let stretches = sound[(start * RATE) as usize..].chunks_exact(length);
    let measured = stretches.map_while(|stretch| {
        let found = fit(stretch, RATE, guess, t60)?;
        guess = found.frequency;
        let amplitude = found.amplitude * libm::exp10(-3.0 * 0.0125 / found.t60);
        Some((1200.0 * libm::log2(found.frequency / 220.0), amplitude))
    });
    measured.collect()
}

/// The rise in cents at an amplitude relative to a full strike.
fn law(tension: f64, amplitude: f64) -> f64 {
    600.0 * libm::log2(1.0 + (libm::exp2(tension / 6.0) - 1.0) * amplitude * amplitude)
}

#[test]
fn tension_raises_the_pitch_by_the_law_and_it_falls_back() {
    let mut failures = vec![];
    for (tension, velocity) in [(0.5_f32, 1.0), (3.0, 1.0), (3.0, 0.7), (3.0, 0.3), (12.0, 0.9)] {
        let patch = mass(20.0).with(Param::Tension, tension);
        let sound = render(&patch, &[Event::note_on(0, 57, velocity)], 0.6);
        let amplitude = f64::from(velocity) * f64::from(velocity);
        let guess = 220.0 * libm::exp2(law(tension.into(), amplitude) / 1200.0);
        let found = pitches(&sound, 0.01, 20.0, guess);
        assert!(found.len() > 20, "{tension} semitones at {velocity}: {found:?}");
        for (cents, amplitude) in &found {
            let expected = law(tension.into(), *amplitude);
            if (cents - expected).abs() > 1.0 {
                failures.push(format!("{tension} semitones at {velocity}: {cents:.2} instead of {expected:.2}"));
            }
        }
        if !found.windows(2).all(|pair| pair[1].0 < pair[0].0) {
            failures.push(format!("{tension} semitones at {velocity}: does not fall: {found:?}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    // A sound that has decayed is at its pitch.
    let sound = render(&mass(0.3).with(Param::Tension, 7.0), &[Event::note_on(0, 57, 1.0)], 0.4);
    let (last, _) = pitches(&sound, 0.3, 0.3, 220.0)[2];
    assert!(last.abs() < 0.05, "{last}");
}

#[test]
fn a_route_moves_tension() {
    let patch = mass(20.0).with_route(3, Source::Wheel, Param::Tension, 50.0);
    let wheel = event(4800, EventKind::Control { controller: 1, value: 1.0 });
    let sound = render(&patch.with(Param::Vibrato, 0.0), &[Event::note_on(0, 57, 1.0), wheel], 0.4);
    let cents = |start| pitches(&sound, start, 20.0, 220.0).first().map(|found| found.0);
    assert!(cents(0.02).is_some_and(|cents| cents.abs() < 0.1), "{:?}", cents(0.02));
    let sounds_high = fit(&sound[14_400..19_200], RATE, 430.0, 20.0).expect("a sinusoid").frequency;
    assert!(sounds_high > 390.0, "{sounds_high}");
}

/// No step between two samples is larger than the largest step of a sine with the amplitude of both strikes together, at the
/// highest pitch that the law allows.
#[test]
fn a_second_strike_bends_the_pitch_without_a_click() {
    for moment in (9_600..9_600 + 64).step_by(7) {
        let events = [Event::note_on(0, 57, 0.6), Event::note_on(moment, 57, 1.0)];
        let sound = render(&mass(5.0).with(Param::Tension, 12.0), &events, 0.5);
        let steepest = sound.windows(2).map(|pair| f64::from((pair[1] - pair[0]).abs())).fold(0.0, f64::max);
        let most = 0.36 + 1.0;
        let frequency = 220.0 * libm::exp2(law(12.0, most) / 1200.0);
        let bound = most * 2.0 * libm::sin(0.5 * TAU * frequency / RATE);
        assert!(steepest < bound, "{steepest} of {bound}");
        assert!(steepest > 0.2 * bound, "{steepest} of {bound}: the bound is not that loose");
    }
}

/// Spectral centroid in Hz over `seconds` from `start`.
fn centroid(sound: &[f32], start: f64, seconds: f64) -> f64 {
    let at = |time: f64| (time * RATE) as usize;
    let spectrum = spectrum(&sound[at(start)..at(start + seconds)], RATE);
    let (mut moment, mut sum) = (0.0, 0.0);
    for (bin, level) in spectrum.levels.iter().enumerate() {
        let power = libm::exp10(level / 10.0);
        moment += power * bin as f64 * spectrum.bin_width;
        sum += power;
    }
    moment / sum
}

fn gong() -> Patch {
    let mode = |m: u32| Mode {
        ratio: 1.0 + 0.41 * m as f32,
        level: 0.5 / ((1.0 + m as f32) * (1.0 + m as f32)),
        decay: 1.0 / (1.0 + 0.02 * m as f32),
        ..Mode::UNIT
    };
    let modes: Vec<Mode> = (0..128).map(mode).collect();
    Patch { modes: ModeTable::new(&modes), ..mass(10.0) }
}

#[test]
fn a_hard_stroke_blooms_for_some_tenths_of_a_second_and_a_soft_one_does_not() {
    let patch = gong().with(Param::Bloom, 70.0).with(Param::BloomTime, 0.3);
    let centroids = |velocity| {
        let sound = render(&patch, &[Event::note_on(0, 45, velocity)], 1.0);
        [0.03, 0.15, 0.3, 0.5].map(|start| centroid(&sound, start, 0.1))
    };
    let hard = centroids(1.0);
    assert!(hard.windows(2).take(2).all(|pair| pair[1] > 1.1 * pair[0]), "{hard:?}");
    assert!(hard[3] > 1.8 * hard[0], "{hard:?}");
    let soft = centroids(0.25);
    assert!(soft.windows(2).all(|pair| pair[1] < 1.02 * pair[0]), "{soft:?}");
}

/// The tail is an upper bound while the voice blooms and then exact, and the voice does end.
#[test]
fn a_blooming_voice_ends_within_its_tail() {
    let patch = gong().with(Param::Bloom, 80.0).with(Param::Decay, 1.5).with(Param::Tension, 1.0);
    let mut synth = Synth::new(RATE, 1);
    synth.set_patch(&patch);
    let (mut left, mut right) = ([0.0; CONTROL_FRAMES], [0.0; CONTROL_FRAMES]);
    synth.process(&[Event::note_on(0, 45, 1.0)], &mut left, &mut right);
    let (mut frames, mut ends) = (0_u64, vec![]);
    while !synth.is_silent() {
        if frames.is_multiple_of(64 * CONTROL_FRAMES as u64) {
            ends.push(frames + synth.tail_frames());
        }
        synth.process(&[], &mut left, &mut right);
        frames += CONTROL_FRAMES as u64;
        assert!(frames < 10 * RATE as u64, "it never ends");
    }
    // Exact to one control tick.
    let tick = CONTROL_FRAMES as u64;
    assert!(ends.iter().all(|end| end + tick >= frames), "{frames}: {ends:?}");
    assert!(ends.len() > 10 && ends[ends.len() / 2] <= frames, "{frames}: {ends:?}");
}

/// Amplitude of a partial in dB, over a tenth of a second from `start`.
fn level(sound: &[f32], frequency: f64, start: f64) -> f64 {
    let length = (0.1 * RATE) as usize;
    let stretch = &sound[(start * RATE) as usize..][..length];
    let (mut real, mut imaginary) = (0.0, 0.0);
    for (n, sample) in stretch.iter().enumerate() {
        let window = 0.5 - 0.5 * libm::cos(TAU * n as f64 / length as f64);
        let (sin, cos) = libm::sincos(TAU * frequency * n as f64 / RATE);
        real += f64::from(*sample) * window * cos;
        imaginary += f64::from(*sample) * window * sin;
    }
    20.0 * libm::log10(libm::hypot(real, imaginary) / length as f64 + 1e-12)
}

fn string() -> Patch {
    let mode = |n: u8| Mode { ratio: n.into(), level: 0.4 / f32::from(n), ..Mode::UNIT };
    let modes: Vec<Mode> = (1..=8).map(mode).collect();
    Patch { modes: ModeTable::new(&modes), ..mass(4.0) }
}

#[test]
fn a_touch_in_the_middle_kills_odd_partials_and_leaves_even_ones() {
    let free = render(&string(), &[Event::note_on(0, 57, 1.0)], 0.8);
    let touched = render(&string(), &[Event::note_on(0, 57, 1.0), set(9_600, Param::Touch, 100.0)], 0.8);
    let born = render(&string().with(Param::Touch, 100.0), &[Event::note_on(0, 57, 1.0)], 0.8);
    for sound in [touched, born] {
        for n in 1..=8_u8 {
            let [before, after] = [&free, &sound].map(|sound| level(sound, 220.0 * f64::from(n), 0.6));
            if n % 2 == 0 {
                assert!((after - before).abs() < 0.1, "partial {n}: {after} instead of {before}");
            } else {
                assert!(after < before - 60.0, "partial {n}: {after} of {before}");
            }
        }
    }
}

/// A touch only shortens the decay, follows its position, and ends when the pressure ends.
#[test]
fn a_touch_follows_its_place_and_pressure() {
    let fall = |patch: &Patch, events: &[Event], n: u8| {
        let sound = render(patch, &[&[Event::note_on(0, 57, 1.0)], events].concat(), 0.6);
        level(&sound, 220.0 * f64::from(n), 0.1) - level(&sound, 220.0 * f64::from(n), 0.45)
    };
    let free = fall(&string(), &[], 3);
    let at = |place| string().with(Param::Touch, 30.0).with(Param::TouchPosition, place);
    let falls = [0.0, 5.0, 16.7, 33.333_333].map(|place| fall(&at(place), &[], 3));
    assert!((falls[0] - free).abs() < 0.01 && (falls[3] - free).abs() < 0.01, "{falls:?}, free {free}");
    assert!(falls[1] > free + 3.0 && falls[2] > falls[1] + 3.0, "{falls:?}, free {free}");
    let moved = fall(&at(16.7), &[set(2_000, Param::TouchPosition, 33.333_333)], 3);
    assert!((moved - free).abs() < 1.0, "{moved}, free {free}");
    let pressed = string().with_route(4, Source::Pressure, Param::Touch, 100.0).with(Param::TouchPosition, 16.7);
    let press = |frame, pressure| event(frame, EventKind::ChannelPressure(pressure));
    assert!(fall(&pressed, &[press(8_000, 1.0)], 3) > 50.0);
    assert!((fall(&pressed, &[press(100, 1.0), press(400, 0.0)], 3) - free).abs() < 0.01);
    // A release still damps, and a touch at the same time adds to the damping.
    let released = |patch: &Patch| fall(&patch.clone().with(Param::Release, 0.5), &[crate::events::off(5_000, 57)], 2);
    let beside = at(25.0).with(Param::Touch, 20.0);
    assert!(released(&beside) > released(&string()) + 3.0);
}

/// Changes of touch and bloom while a note sounds do not click.
#[test]
fn touching_and_blooming_does_not_click() {
    let jump = |sound: &[f32]| sound.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    let free = jump(&render(&string(), &[Event::note_on(0, 57, 1.0)], 0.4)[4_800..]);
    for moment in (4_900..5_000).step_by(9) {
        let events =
            [Event::note_on(0, 57, 1.0), set(moment, Param::Touch, 100.0), set(moment + 900, Param::Touch, 0.0)];
        let touched = jump(&render(&string(), &events, 0.4)[4_800..]);
        assert!(touched <= free + 0.001, "{touched} instead of {free}");
    }
    // High modes that have bloomed have large steps; at the moment when bloom is switched on, no step is larger.
    let events = [Event::note_on(0, 45, 1.0), set(9_600, Param::Bloom, 100.0)];
    let sound = render(&gong().with(Param::Bloom, 0.0), &events, 1.0);
    let (start, later) = (jump(&sound[9_500..11_000]), jump(&sound[11_000..]));
    assert!(start <= later, "{start} and then {later}");
}

/// Parameters at 0 change no bit, whatever the others are.
#[test]
fn off_is_off() {
    for preset in [Preset::find("Gong"), Preset::find("Low Tom"), Preset::find("Plucked String")] {
        let patch = preset.expect("a factory preset").patch.clone();
        let patch = &patch.with(Param::Tension, 0.0).with(Param::Bloom, 0.0).with(Param::Touch, 0.0);
        let plain = render(patch, &[Event::note_on(0, 57, 1.0)], 0.5);
        let moved = patch.clone().with(Param::BloomTime, 0.1).with(Param::TouchPosition, 17.0);
        assert_eq!(render(&moved, &[Event::note_on(0, 57, 1.0)], 0.5), plain);
        for (param, value) in [(Param::Tension, 3.0), (Param::Bloom, 50.0), (Param::Touch, 50.0)] {
            assert_ne!(
                render(&moved.clone().with(param, value), &[Event::note_on(0, 57, 1.0)], 0.5),
                plain,
                "{param:?}"
            );
        }
    }
    assert_eq!(render(&mass(1.0), &[on(0, 57)], 0.1), render(&mass(1.0), &[Event::note_on(0, 57, 1.0)], 0.1));
}

/// Colour is a gain for each mode, by its octaves above the fundamental. It moves in 20 ms without a click, and back to nothing.
#[test]
fn colour_softens_modes_by_their_octaves() {
    const RATIOS: [f32; 4] = [0.5, 1.0, 2.0, 5.0];
    let of = |ratios: &[f32]| {
        let modes: Vec<Mode> = ratios.iter().map(|ratio| Mode { ratio: *ratio, ..Mode::UNIT }).collect();
        Patch { modes: ModeTable::new(&modes), ..mass(8.0) }
    };
    let turned = [Event::note_on(0, 57, 1.0), set(24_001, Param::Colour, -9.0), set(48_000, Param::Colour, 0.0)];
    let alone = RATIOS.map(|ratio| render(&of(&[ratio]), &turned[..1], 1.5));
    let found = render(&of(&RATIOS), &turned, 1.5);
    let sum = |n: usize, slope: f64| -> f64 {
        let gain = |ratio: f32| libm::exp10(slope * libm::log2(ratio.into()) / 20.0).min(1.0);
        RATIOS.iter().zip(&alone).map(|(ratio, sound)| gain(*ratio) * f64::from(sound[n])).sum()
    };
    for (stretch, slope) in [(0..24_001, 0.0), (25_100..48_000, -9.0), (49_100..72_000, 0.0)] {
        for n in stretch {
            let error = f64::from(found[n]) - sum(n, slope);
            assert!(error.abs() < 1e-4, "frame {n}, {slope} dB per octave: {error}");
        }
    }
    let step = |stretch: std::ops::Range<usize>| {
        found[stretch].windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max)
    };
    assert!(step(24_000..26_000) <= 1.01 * step(20_000..24_000) && step(48_000..50_000) <= 1.05 * step(50_000..54_000));
}

/// Modes wander by themselves within the bounds that are set, each for itself, by the seed, and without a click.
#[test]
fn modes_drift_within_their_bounds() {
    let of = |ratios: &[f32], level: f32, cents: f32| {
        let modes: Vec<Mode> = ratios.iter().map(|ratio| Mode { ratio: *ratio, ..Mode::UNIT }).collect();
        let patch = Patch { modes: ModeTable::new(&modes), ..mass(60.0) }.with(Param::DriftRate, 6.0);
        patch.with(Param::DriftLevel, level).with(Param::DriftPitch, cents)
    };
    let note = [Event::note_on(0, 57, 1.0)];
    let still = render(&of(&[1.0], 0.0, 0.0), &note, 4.0);
    let peaks = |sound: &[f32]| -> Vec<f32> {
        sound.chunks(2400).map(|part| part.iter().fold(0.0_f32, |most, sample| most.max(sample.abs()))).collect()
    };
    let fallen = render(&of(&[1.0], 12.0, 0.0), &note, 4.0);
    let gains: Vec<f32> = peaks(&fallen).iter().zip(peaks(&still)).map(|(drifted, still)| drifted / still).collect();
    assert!(gains.iter().all(|gain| (0.24..1.001).contains(gain)), "{gains:?}");
    let extreme = |gains: &[f32]| gains.iter().fold((1.0_f32, 0.0_f32), |(a, b), gain| (a.min(*gain), b.max(*gain)));
    assert!(extreme(&gains).0 < 0.5 && extreme(&gains).1 > 0.7, "{gains:?}");
    // Frames of zero crossings upwards: those of 100 rounds last as long as the pitch is low.
    let bent = render(&of(&[1.0], 0.0, 40.0), &note, 4.0);
    let rounds = |sound: &[f32]| -> Vec<f64> {
        let up = sound.windows(2).enumerate().filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0);
        let at: Vec<f64> = up.map(|(n, pair)| n as f64 + f64::from(pair[0] / (pair[0] - pair[1]))).collect();
        at.windows(11).map(|window| window[10] - window[0]).collect()
    };
    let cents: Vec<f64> = rounds(&bent).iter().map(|round| 1200.0 * libm::log2(rounds(&still)[0] / round)).collect();
    let (least, most) = cents.iter().fold((0.0_f64, 0.0_f64), |(a, b), cents| (a.min(*cents), b.max(*cents)));
    assert!((-40.5..-20.0).contains(&least) && (20.0..40.5).contains(&most), "{least} to {most} cents");
    assert!(peaks(&bent).iter().zip(peaks(&still)).all(|(bent, still)| (bent / still - 1.0).abs() < 0.01));
    let step = |sound: &[f32]| sound.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    assert!(step(&fallen).max(step(&bent)) <= 1.03 * step(&still));
    // Each mode by itself: the sum of two is not one of them twice, and every seed has its own.
    let both = render(&of(&[1.0, 1.0], 12.0, 0.0), &note, 4.0);
    let twice = both.iter().zip(&fallen).map(|(both, one)| (both - 2.0 * one).abs()).fold(0.0, f32::max);
    assert!(twice > 0.2 * step(&still), "{twice}");
    assert!(render(&of(&[1.0], 12.0, 40.0), &note, 1.0) == render(&of(&[1.0], 12.0, 40.0), &note, 1.0));
    // It can be switched off while it sounds, and leaves no trace.
    let off = [note[0], set(24_000, Param::DriftLevel, 0.0)];
    let ended = peaks(&render(&of(&[1.0], 12.0, 0.0), &off, 1.0));
    assert!((ended[15] / peaks(&still)[15] - 1.0).abs() < 1e-4, "{ended:?}");
}
