//! Exciters in whole notes: their sum, velocity, mallet contact, random variation, bow and audio input.

use crate::events::{event, off, on};
use crate::workers::Backwards;
use sprung::engine::{Ensemble, Event, EventKind, Synth};
use sprung::params::Param;
use sprung::patch::routes::Source;
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::Preset;
use sprung::sound::Sound;

const RATE: f64 = 48_000.0;

/// A bar of five modes without limiter, each exciter at a level.
fn bar(mallet: f32, pluck: f32, noise: f32) -> Patch {
    let modes = [(1.0, 0.5), (2.76, 0.3), (5.4, 0.2), (8.93, 0.1), (13.3, 0.05)];
    let modes = modes.map(|(ratio, level)| Mode { ratio, level, strike: 0.7, ..Mode::UNIT });
    let patch = Patch { modes: ModeTable::new(&modes), ..Patch::default() };
    patch
        .with(Param::MalletPulse, 1.0)
        .with(Param::MalletLevel, mallet)
        .with(Param::PluckLevel, pluck)
        .with(Param::NoiseLevel, noise)
        .with(Param::Limiter, 0.0)
}

fn synth(patch: &Patch, seed: u64) -> Synth {
    let mut synth = Synth::new(RATE, seed);
    synth.set_patch(patch);
    synth
}

fn render(patch: &Patch, seed: u64, events: &[Event], frames: usize) -> Vec<f32> {
    driven(patch, seed, events, &[], frames)
}

fn driven(patch: &Patch, seed: u64, events: &[Event], input: &[f32], frames: usize) -> Vec<f32> {
    let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
    synth(patch, seed).process_with_input(events, input, &mut left, &mut right);
    left
}

pub(crate) fn rms(sound: &[f32]) -> f64 {
    (sound.iter().map(|sample| f64::from(sample * sample)).sum::<f64>() / sound.len() as f64).sqrt()
}

/// Brightness: RMS of the differences between successive samples, relative to the RMS of the samples.
pub(crate) fn brightness(sound: &[f32]) -> f64 {
    let steps: Vec<f32> = sound.windows(2).map(|pair| pair[1] - pair[0]).collect();
    rms(&steps) / rms(sound)
}

fn strike(velocity: f32) -> Event {
    Event::note_on(0, 60, velocity)
}

const OFF: f32 = -60.0;

#[test]
fn exciters_add_up() {
    let alone = [bar(0.0, OFF, OFF), bar(OFF, -3.0, OFF), bar(OFF, OFF, 2.0)];
    let alone = alone.map(|patch| render(&patch, 1, &[on(5, 60)], 9600));
    let all = render(&bar(0.0, -3.0, 2.0), 1, &[on(5, 60)], 9600);
    for (n, sample) in all.iter().enumerate() {
        let sum: f32 = alone.iter().map(|one| one[n]).sum();
        assert!((sum - sample).abs() < 1e-4, "{n}: {sum} {sample}");
    }
    assert!(alone.iter().all(|one| rms(one) > 1e-3));
    let silent = render(&bar(OFF, OFF, OFF), 1, &[on(5, 60)], 9600);
    assert!(silent.iter().all(|sample| *sample == 0.0));
}

#[test]
fn each_exciter_follows_velocity_as_far_as_it_is_told() {
    let drop =
        |patch: &Patch| rms(&render(patch, 1, &[strike(0.5)], 4800)) / rms(&render(patch, 1, &[strike(1.0)], 4800));
    for (patch, own) in [
        (bar(0.0, OFF, OFF), Param::MalletVelocity),
        (bar(OFF, 0.0, OFF), Param::PluckVelocity),
        (bar(OFF, OFF, 0.0), Param::NoiseVelocity),
        (bar(OFF, OFF, OFF).with(Param::BowLevel, 0.0), Param::BowVelocity),
    ] {
        for (more, expected) in [(0.0, 0.25), (50.0, 0.125), (-50.0, 0.5), (-100.0, 1.0)] {
            let found = drop(&patch.clone().with(own, more));
            assert!((found / expected - 1.0).abs() < 0.01, "{own:?} {more}: {found}, not {expected}");
        }
    }
}

#[test]
fn velocity_0_is_without_force_even_if_forces_do_not_follow_velocity() {
    for velocity in [0.0, 100.0] {
        let silent = render(&bar(0.0, 0.0, 0.0).with(Param::Velocity, velocity), 1, &[strike(0.0)], 960);
        assert!(silent.iter().all(|sample| *sample == 0.0), "{velocity}");
    }
}

#[test]
fn contact_is_shorter_the_harder_the_strike_the_lighter_the_mallet_and_the_higher_the_key() {
    let soft = bar(0.0, OFF, OFF).with(Param::MalletHardness, 60.0).with(Param::Velocity, 100.0);
    let colour = |patch: &Patch, event| brightness(&render(patch, 1, &[event], 9600));
    let by_speed = |law| {
        let patch = soft.clone().with(Param::MalletSpeed, law);
        colour(&patch, strike(1.0)) / colour(&patch, strike(0.2))
    };
    assert!((by_speed(0.0) - 1.0).abs() < 1e-3 && by_speed(100.0) > 1.1, "{} {}", by_speed(0.0), by_speed(100.0));
    let heavy = soft.clone().with(Param::MalletMass, 5.0);
    assert!(colour(&soft, on(0, 60)) > 1.1 * colour(&heavy, on(0, 60)));

    // A soft mallet loses the top octave, unless it follows the key.
    let level = |patch: &Patch, key| rms(&render(patch, 1, &[on(0, key)], 4800));
    let felt = bar(0.0, OFF, OFF).with(Param::MalletHardness, 0.0);
    let follows = felt.clone().with(Param::MalletKey, 100.0);
    assert!(level(&felt, 96) < 0.05 * level(&felt, 36));
    for key in 24..109 {
        let share = level(&follows, key) / level(&follows, 24);
        assert!(share > 0.35, "{key}: {share}");
    }
    assert_eq!(render(&felt, 1, &[on(0, 36)], 4800), render(&follows, 1, &[on(0, 36)], 4800), "a period is longer");
}

#[test]
fn strikes_vary_by_chance_and_repeat_by_seed() {
    for vary in [(Param::VaryPosition, 10.0), (Param::VaryHardness, 50.0), (Param::VaryModes, 6.0)] {
        let patch = bar(0.0, -6.0, OFF).with(vary.0, vary.1).with(Param::Release, 0.005);
        let events = [on(0, 60), off(4000, 60), on(9600, 60)];
        let sound = render(&patch, 3, &events, 19_200);
        assert!(sound == render(&patch, 3, &events, 19_200));
        assert!(sound != render(&patch, 4, &events, 19_200), "another seed");
        let (first, second) = (&sound[..4000], &sound[9600..13_600]);
        assert!(first != second, "{vary:?}: another strike");
        let ratio = rms(first) / rms(second);
        assert!((0.5..2.0).contains(&ratio), "{vary:?}: {ratio}");
    }
    let still = bar(0.0, -6.0, OFF).with(Param::Release, 0.005);
    let sound = render(&still, 3, &[on(0, 60), off(4000, 60), on(9600, 60)], 19_200);
    assert!(sound[..4000] == sound[9600..13_600], "nothing varies by itself");
}

#[test]
fn a_bowed_note_sounds_until_it_is_let_go_and_then_ends() {
    for key in [36, 60, 84] {
        let patch = bar(OFF, OFF, OFF).with(Param::BowLevel, -6.0).with(Param::Decay, 1.0).with(Param::Release, 0.2);
        let mut synth = synth(&patch, 1);
        let (mut left, mut right) = (vec![0.0; 96_000], vec![0.0; 96_000]);
        synth.process(&[on(10, key)], &mut left, &mut right);
        let levels: Vec<_> = left.chunks(9600).map(rms).collect();
        assert!(levels[9] > 0.1 && (levels[9] / levels[5] - 1.0).abs() < 0.1, "{key}: {levels:?}");
        assert_eq!(synth.tail_frames(), u64::MAX);
        synth.process(&[off(0, key)], &mut left, &mut right);
        assert!(rms(&left[48_000..]) < 1e-4 * levels[9] && synth.is_silent());
        assert_eq!(synth.ended().len(), 1);
    }
}

#[test]
fn pressure_can_be_what_bows() {
    let patch = bar(OFF, OFF, OFF).with_route(0, Source::Pressure, Param::BowLevel, 70.0);
    let press = |frame, pressure| event(frame, EventKind::ChannelPressure(pressure));
    let sound = render(&patch, 1, &[on(0, 60), press(24_000, 1.0), press(72_000, 0.0)], 144_000);
    assert!(sound[..24_000].iter().all(|sample| *sample == 0.0));
    assert!(rms(&sound[62_000..72_000]) > 0.05 && rms(&sound[134_000..]) < 0.01 * rms(&sound[62_000..72_000]));
}

/// Input at the pitch of a held note makes it ring, input beside that pitch does not. The input itself is not heard.
#[test]
fn what_comes_in_drives_held_notes() {
    let tone = |frequency: f64| -> Vec<f32> {
        (0..48_000).map(|n| libm::sin(std::f64::consts::TAU * frequency * f64::from(n) / RATE) as f32 * 0.1).collect()
    };
    let patch = bar(OFF, OFF, OFF).with(Param::InputLevel, -20.0).with(Param::Release, 0.05);
    let held = [on(0, 69)];
    let at = driven(&patch, 1, &held, &tone(440.0), 48_000);
    let beside = driven(&patch, 1, &held, &tone(500.0), 48_000);
    assert!(rms(&at[24_000..]) > 10.0 * rms(&beside[24_000..]) && rms(&at) > 1e-3);
    assert!(at.iter().all(|sample| sample.is_finite()));
    assert!(driven(&patch, 1, &[], &tone(440.0), 48_000).iter().all(|sample| *sample == 0.0), "no note");
    assert!(render(&patch, 1, &held, 48_000).iter().all(|sample| *sample == 0.0), "no input");
    let released = driven(&patch, 1, &[on(0, 69), off(24_000, 69)], &tone(440.0), 48_000);
    assert!(rms(&released[36_000..]) < 1e-3 * rms(&at[36_000..]), "let go");
    let without = bar(0.0, OFF, OFF);
    assert!(driven(&without, 1, &held, &tone(440.0), 9600) == render(&without, 1, &held, 9600), "off costs no bit");

    // The same input in blocks of other lengths gives the same bits. Non-finite and huge input never makes the output non-finite.
    let short = &tone(440.0)[..1000];
    let mut long = short.to_vec();
    long.resize(9600, 0.0);
    let loud = patch.clone().with(Param::MalletLevel, 0.0);
    let whole = driven(&loud, 1, &held, &long, 9600);
    let mut odd = synth(&loud, 1);
    let (mut left, mut right) = (vec![0.0; 9600], vec![0.0; 9600]);
    let mut start = 0;
    for frames in [1, 31, 7, 500, 448, 13, 9600 - 1000] {
        let events = if start == 0 { &held[..] } else { &[] };
        let (left, right) = (&mut left[start..start + frames], &mut right[start..start + frames]);
        odd.process_with_input(events, &long[start..start + frames], left, right);
        start += frames;
    }
    assert!(left == whole);
    let nonsense: Vec<f32> = [f32::NAN, f32::INFINITY, -1e30].into_iter().cycle().take(9600).collect();
    assert!(driven(&patch, 1, &held, &nonsense, 9600).iter().all(|sample| sample.is_finite()));
}

#[test]
fn an_ensemble_hears_input_as_a_synth_does() {
    let patch = bar(0.0, OFF, OFF).with(Param::InputLevel, -10.0);
    let input: Vec<f32> = (0..9600).map(|n| if n % 400 == 0 { 0.5 } else { 0.0 }).collect();
    let alone = driven(&patch, 7, &[on(40, 60)], &input, 9600);
    let mut ensemble = Ensemble::new(RATE, 7, &patch, &[]).with_chunk(512);
    let (mut left, mut right) = (vec![0.0; 9600], vec![0.0; 9600]);
    ensemble.process_by(&Backwards, &[on(40, 60)], &input, &mut left, &mut right);
    assert!(left == alone);
}

#[test]
fn contacts_tell_material_position_and_impulse() {
    let sound = Sound::new(bar(0.0, OFF, OFF));
    let hit = |material, position, impulse| {
        let contact = sound.strike(material, position, impulse);
        render(sound.patch(), 1, &[event(0, EventKind::Strike { key: 60, contact })], 9600)
    };
    assert!(brightness(&hit(0.9, 0.0, 1.0)) > 1.5 * brightness(&hit(0.2, 0.0, 1.0)));
    assert!(brightness(&hit(0.9, 0.0, 1.0)) > 1.02 * brightness(&hit(0.9, 0.0, 0.05)), "contact by the law of Hertz");
    let level = |impulse| rms(&hit(0.9, 0.0, impulse));
    assert!((level(1.0) / level(0.5) / 2.0 - 1.0).abs() < 0.05, "{}", level(1.0) / level(0.5));
    assert!(rms(&hit(0.9, 1.0, 1.0)) < 0.7 * level(1.0), "the end of a bar hardly moves its lowest mode");
    // A contact of full impulse with the mallet's own hardness equals a note of full velocity.
    let patch = bar(0.0, OFF, OFF).with(Param::MalletHardness, 60.0);
    let contact = Sound::new(patch.clone()).strike(0.6, 0.0, 1.0);
    let hit = render(&patch, 1, &[event(0, EventKind::Strike { key: 60, contact })], 9600);
    assert_eq!(hit, render(&patch, 1, &[on(0, 60)], 9600));
}

/// All exciters at once, on a factory sound, give the same bits in blocks of any length.
#[test]
fn all_exciters_at_once_do_not_depend_on_blocks() {
    let mut patch = Preset::find("Kalimba").unwrap().patch.clone();
    for (param, value) in [
        (Param::PluckLevel, -6.0),
        (Param::NoiseReach, 50.0),
        (Param::NoiseDecay, 1.0),
        (Param::NoiseAttack, 0.01),
        (Param::NoiseHits, 3.0),
        (Param::NoiseColour, -40.0),
        (Param::BowLevel, -12.0),
        (Param::InputLevel, -20.0),
        (Param::VaryModes, 3.0),
        (Param::Unison, 3.0),
    ] {
        patch.set(param, value);
    }
    let input: Vec<f32> = (0..24_000).map(|n| if n % 333 < 20 { 0.2 } else { 0.0 }).collect();
    let events = [on(3, 60), on(1000, 67), off(12_000, 60), on(13_001, 60), off(15_000, 67), off(15_001, 60)];
    let whole = driven(&patch, 5, &events, &input, 24_000);
    assert!(rms(&whole) > 0.01);
    for block in [1, 64, 479] {
        let mut synth = synth(&patch, 5);
        let (mut left, mut right) = (vec![0.0; 24_000], vec![0.0; 24_000]);
        for start in (0..24_000).step_by(block) {
            let end = (start + block).min(24_000);
            let own = |event: &&Event| (start..end).contains(&(event.frame as usize));
            let own = events.iter().filter(own).map(|event| Event { frame: event.frame - start as u32, ..*event });
            let own: Vec<_> = own.collect();
            let (left, right) = (&mut left[start..end], &mut right[start..end]);
            synth.process_with_input(&own, &input[start..end], left, right);
        }
        assert!(left == whole, "blocks of {block}");
    }
}
