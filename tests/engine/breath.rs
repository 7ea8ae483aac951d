//! Breath and held noise in whole notes: pitch at every key, loudness and colour by pressure, beginnings, ends and slurs.

use crate::events::{event, off, on, played};
use sprung::engine::{Event, EventKind, Synth};
use sprung::params::Param;
use sprung::patch::routes::Source;
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::Preset;
use sprung::units::frequency_from_key;
use std::f64::consts::TAU;

const RATE: f64 = 48_000.0;
const OFF: f32 = -60.0;

/// A cone of 24 modes that is blown, and nothing else.
fn horn() -> Patch {
    tube(1)
}

/// A tube with every `step`-th harmonic up to the 24th: a cone, or a cylinder that is closed at one end.
fn tube(step: usize) -> Patch {
    let mode = |n: u8| Mode { ratio: n.into(), level: 1.0 / f32::from(n), decay: 1.0 / f32::from(n), ..Mode::UNIT };
    let modes: Vec<_> = (1..=24).step_by(step).map(mode).collect();
    Patch { modes: ModeTable::new(&modes), ..Patch::default() }
        .with(Param::MalletLevel, OFF)
        .with(Param::NoiseLevel, OFF)
        .with(Param::BreathLevel, -24.0)
        .with(Param::Decay, 0.3)
        .with(Param::Release, 0.1)
        .with(Param::Limiter, 0.0)
}

fn render(patch: &Patch, rate: f64, events: &[Event], frames: usize) -> Vec<f32> {
    played(patch, (rate, 1), events, frames)
}

/// RMS about the mean: a steady flow leaves a little steady pressure.
fn rms(sound: &[f32]) -> f64 {
    let mean = sound.iter().map(|sample| f64::from(*sample)).sum::<f64>() / sound.len() as f64;
    let squares = sound.iter().map(|sample| f64::from(*sample) - mean).map(|sample| sample * sample).sum::<f64>();
    (squares / sound.len() as f64).sqrt()
}

/// Brightness: RMS of the differences between successive samples, relative to the RMS of the samples.
fn brightness(sound: &[f32]) -> f64 {
    let steps: Vec<f32> = sound.windows(2).map(|pair| pair[1] - pair[0]).collect();
    rms(&steps) / rms(sound)
}

/// How many cents the fundamental of a steady tone lies above `wanted` Hz.
fn cents(sound: &[f32], rate: f64, wanted: f64) -> f64 {
    let (mut frequency, window) = (wanted, sound.len() / 2);
    for apart in [window / 64, window / 8, window] {
        let phase = |start: usize| {
            let (mut re, mut im) = (0.0, 0.0);
            for (i, sample) in sound[start..start + window].iter().enumerate() {
                let hann = f64::from(*sample) * (1.0 - libm::cos(TAU * i as f64 / window as f64));
                let angle = TAU * frequency * (start + i) as f64 / rate;
                (re, im) = (re + hann * libm::cos(angle), im - hann * libm::sin(angle));
            }
            libm::atan2(im, re)
        };
        let advance = phase(apart) - phase(0);
        frequency += (advance - TAU * libm::round(advance / TAU)) / TAU * rate / apart as f64;
    }
    1200.0 * libm::log2(frequency / wanted)
}

/// The patch without what moves its pitch: vibrato, sweep and oscillators.
fn steady(patch: &Patch) -> Patch {
    let mut patch = patch.clone().with(Param::Vibrato, 0.0).with(Param::Sweep, 0.0).with(Param::Limiter, 0.0);
    let moving: Vec<_> = patch.routes.iter().collect();
    for (place, route) in moving {
        if [Source::Lfo1, Source::Lfo2, Source::Lfo3].contains(&route.source) {
            patch.routes.set(place, None);
        }
    }
    patch.with(Param::Unison, 1.0)
}

fn blown() -> impl Iterator<Item = &'static Preset> {
    Preset::factory().iter().filter(|preset| preset.patch.get(Param::BreathLevel) > OFF)
}

/// Every `step`-th key of every blown preset sounds within three cents of its pitch, at the velocity of the tuning.
fn are_in_tune(step: usize) {
    assert!(blown().count() >= 10);
    for preset in blown() {
        let patch = steady(&preset.patch);
        for key in (preset.guide.lowest..=preset.guide.highest).step_by(step) {
            let sound = render(&patch, RATE, &[Event::note_on(0, key, 0.75)], 48_000);
            let steady = &sound[28_800..];
            let off = cents(steady, RATE, frequency_from_key(key.into(), 440.0));
            assert!(rms(steady) > 1e-4, "{} {key} does not speak: {}", preset.name, rms(steady));
            assert!(off.abs() < 3.0, "{} {key}: {off:.2} cents", preset.name);
        }
    }
}

#[test]
fn winds_are_in_tune_at_two_keys_or_three() {
    are_in_tune(25);
}

#[test]
#[ignore = "takes minutes"]
fn winds_are_in_tune_at_every_key() {
    are_in_tune(1);
}

#[test]
fn a_wind_has_one_pitch_at_all_rates() {
    for (valve, pressure) in [(0.0, 65.0), (1.0, 100.0), (2.0, 60.0)] {
        let patch = horn().with(Param::BreathValve, valve).with(Param::BreathPressure, pressure);
        for rate in [44_100.0, 96_000.0] {
            let sound = render(&patch, rate, &[Event::note_on(0, 76, 0.75)], rate as usize);
            let off = cents(&sound[(0.6 * rate) as usize..], rate, frequency_from_key(76.0, 440.0));
            assert!(off.abs() < 2.0, "{valve} at {rate}: {off:.2} cents");
        }
    }
}

#[test]
fn more_breath_is_louder_and_brighter() {
    let valves = [(0.0, 2, [45.0, 60.0, 80.0]), (1.0, 1, [80.0, 120.0, 180.0]), (2.0, 1, [40.0, 70.0, 110.0])];
    for (valve, step, pressures) in valves {
        let patch = tube(step).with(Param::BreathValve, valve).with(Param::BreathOpening, 40.0);
        let sounds = pressures
            .map(|pressure| render(&patch.clone().with(Param::BreathPressure, pressure), RATE, &[on(0, 60)], 48_000));
        let steady = sounds.each_ref().map(|sound| &sound[24_000..]);
        let (levels, colours) = (steady.map(rms), steady.map(brightness));
        assert!(levels.is_sorted() && levels[2] > 1.2 * levels[0], "{valve}: {levels:?}");
        assert!(colours[2] > 1.1 * colours[0], "{valve}: {colours:?}");
    }
    let soft = render(&horn().with(Param::BreathPressure, 15.0), RATE, &[on(0, 60)], 48_000);
    let spoken = render(&horn(), RATE, &[on(0, 60)], 48_000);
    assert!(rms(&soft[36_000..]) < 1e-3 * rms(&spoken[36_000..]), "too little breath does not speak");
}

#[test]
fn a_bore_in_which_waves_steepen_is_the_darker_the_softer_it_is_blown() {
    let lips = horn().with(Param::BreathValve, 1.0).with(Param::BreathTongue, 0.0);
    let steady = |steepening: f32, pressure: f32| {
        let patch = lips.clone().with(Param::BreathSteepening, steepening).with(Param::BreathPressure, pressure);
        render(&patch, RATE, &[on(0, 60)], 48_000)[24_000..].to_vec()
    };
    let colours = |steepening: f32| [80.0, 120.0, 180.0].map(|pressure| brightness(&steady(steepening, pressure)));
    let ([plain_soft, _, plain_loud], [soft, middle, loud]) = (colours(0.0), colours(4.0));
    assert!(soft < middle && middle < loud && loud < plain_loud, "{soft} {middle} {loud} {plain_loud}");
    assert!(loud / soft > 1.5 * plain_loud / plain_soft, "{soft} to {loud}, {plain_soft} to {plain_loud}");
    assert_eq!(steady(4.0, 200.0), steady(0.0, 200.0), "the levels are those of the loudest breath");
}

/// With all that players have for it.
#[test]
fn the_hardest_breath_is_the_loudest() {
    for preset in blown() {
        let patch = steady(&preset.patch);
        let level = |breath: f32| {
            let events = [
                event(0, EventKind::Control { controller: 2, value: breath }),
                event(0, EventKind::ChannelPressure(breath)),
                Event::note_on(0, preset.guide.home, 1.0),
            ];
            rms(&render(&patch, RATE, &events, 24_000)[12_000..])
        };
        let levels = [0.0, 0.5, 1.0].map(level);
        assert!(levels.is_sorted() && levels[2] > 1.2 * levels[0], "{}: {levels:?}", preset.name);
    }
}

#[test]
fn a_blown_note_lasts_while_it_is_held_and_then_ends() {
    for (valve, pressure) in [(0.0, 70.0), (1.0, 120.0), (2.0, 70.0)] {
        let mut synth = Synth::new(RATE, 1);
        synth.set_patch(&horn().with(Param::BreathValve, valve).with(Param::BreathPressure, pressure));
        let (mut left, mut right) = (vec![0.0; 96_000], vec![0.0; 96_000]);
        synth.process(&[on(10, 57)], &mut left, &mut right);
        let levels: Vec<_> = left.chunks(9600).map(rms).collect();
        assert!(levels[9] > 0.01 && (levels[9] / levels[5] - 1.0).abs() < 0.02, "{valve}: {levels:?}");
        assert_eq!(synth.tail_frames(), u64::MAX);
        synth.process(&[off(0, 57)], &mut left, &mut right);
        assert!(rms(&left[24_000..]) < 1e-4 * levels[9] && synth.is_silent(), "{valve}");
        assert_eq!(synth.ended().len(), 1);
    }
}

/// An event in every frame changes nothing of how fast the pressure comes.
#[test]
fn breath_comes_as_fast_under_many_events() {
    let patch = horn().with(Param::BreathAttack, 1.0).with(Param::BreathPressure, 120.0);
    let stray = (1..24_000).map(|frame| event(frame, EventKind::Control { controller: 20, value: 0.5 }));
    let alone = render(&patch, RATE, &[on(0, 60)], 24_000);
    let among = render(&patch, RATE, &std::iter::once(on(0, 60)).chain(stray).collect::<Vec<_>>(), 24_000);
    // Not the same, since a note grows from what little first moves the air.
    for window in [9600..14_400, 14_400..24_000] {
        let [alone, among] = [&alone, &among].map(|sound| rms(&sound[window.clone()]));
        assert!((0.6..1.6).contains(&(among / alone)), "{window:?}: {alone} {among}");
    }
}

/// What swings under one level is another pressure under another: too much of it is not felt until it has decayed.
#[test]
fn a_soft_note_speaks_after_a_loud_one_on_the_same_key() {
    let patch = horn().with(Param::BreathLevel, -44.0).with_route(0, Source::Velocity, Param::BreathLevel, 60.0);
    let events = [Event::note_on(0, 60, 1.0), Event::note_on(48_000, 60, 0.02)];
    let sound = render(&patch, RATE, &events, 192_000);
    let soft = render(&patch, RATE, &[Event::note_on(0, 60, 0.02)], 96_000);
    let [after, alone] = [rms(&sound[160_000..]), rms(&soft[64_000..])];
    assert!((after / alone - 1.0).abs() < 0.2, "{after} {alone}");
}

/// Breath, pressure and the tongue are heard; a slur goes on with the air in the tube.
#[test]
fn gestures_are_heard() {
    let patch = horn().with(Param::BreathPressure, 20.0).with_route(0, Source::Breath, Param::BreathPressure, 25.0);
    let blow = |frame, value| event(frame, EventKind::Control { controller: 2, value });
    let sound = render(&patch, RATE, &[on(0, 60), blow(24_000, 1.0), blow(72_000, 0.0)], 96_000);
    let [before, blown, after] = [18_000..24_000, 60_000..72_000, 90_000..96_000].map(|part| rms(&sound[part]));
    assert!(blown > 0.01 && before < 1e-3 * blown && after < 1e-2 * blown, "{before} {blown} {after}");

    let early = |tongue| rms(&render(&horn().with(Param::BreathTongue, tongue), RATE, &[on(0, 60)], 2400));
    assert!(early(100.0) > 1.05 * early(0.0), "{} {}", early(100.0), early(0.0));

    let legato = horn().with(Param::Mode, 2.0);
    let slurred = render(&legato, RATE, &[on(0, 60), on(48_000, 64), off(48_000, 60)], 96_000);
    let steps = slurred.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let most = |steps: &[f32]| steps.iter().copied().fold(0.0, f32::max);
    let steps: Vec<f32> = steps.collect();
    let (slur, after) = (most(&steps[47_900..52_000]), most(&steps[72_000..]));
    assert!(slur < 1.1 * after, "a slur makes no step that the note after it has not: {slur} {after}");
    let off = cents(&slurred[72_000..], RATE, frequency_from_key(64.0, 440.0));
    assert!(off.abs() < 3.0 && rms(&slurred[48_480..50_000]) > 0.3 * rms(&slurred[40_000..48_000]), "{off:.2}");
}

/// A note that is struck again ends, though its sound is replaced or its breath switched off in the same moment.
#[test]
fn a_note_ends_whose_sound_goes_as_it_is_struck_again() {
    let bowed = horn().with(Param::BreathLevel, OFF).with(Param::BowLevel, -20.0).with(Param::Decay, 2.0);
    for patch in [horn(), horn().with(Param::BreathValve, 2.0), bowed] {
        for later in [0, 1, 7, 31] {
            let mut synth = Synth::new(RATE, 1);
            synth.set_patch(&patch);
            let play = |synth: &mut Synth, events: &[Event], frames: usize| {
                let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
                synth.process(events, &mut left, &mut right);
                rms(&left)
            };
            let before = play(&mut synth, &[on(0, 60)], 24_010);
            if later > 0 {
                play(&mut synth, &[on(0, 60)], later);
                synth.set_patch(&Patch::default());
            } else {
                synth.set_patch(&Patch::default());
                play(&mut synth, &[on(0, 60)], 1);
            }
            play(&mut synth, &[off(0, 60)], 24_000);
            let after = play(&mut synth, &[], 96_000);
            assert!(before > 1e-3 && after < before, "{later}: {before} {after}");
            play(&mut synth, &[], 960_000);
            assert!(synth.is_silent(), "{later}");
        }
    }
    // The louder the strike, the less breath: at full velocity, none.
    for valve in [0.0, 2.0] {
        let patch = horn().with(Param::BreathValve, valve).with_route(0, Source::Velocity, Param::BreathLevel, -50.0);
        let again = [Event::note_on(0, 60, 0.04), Event::note_on(24_000, 60, 1.0), off(36_000, 60)];
        let sound = render(&patch, RATE, &again, 96_000);
        assert!(sound.iter().all(|sample| sample.is_finite()), "{valve}");
        assert!(rms(&sound[12_000..24_000]) > 1e-3 && rms(&sound[72_000..]) < 1e-4, "{valve}");
    }
}

/// Noise that is held keeps a mode with a T60 of 1 s at the amplitude that its level says, for as long as the key is down.
#[test]
fn held_noise_has_its_level_and_ends() {
    let patch = Patch::default()
        .with(Param::MalletLevel, OFF)
        .with(Param::NoiseLevel, OFF)
        .with(Param::NoiseReach, 100.0)
        .with(Param::NoiseHeld, -12.0)
        .with(Param::Decay, 1.0)
        .with(Param::Release, 0.1)
        .with(Param::Gain, 0.0)
        .with(Param::Limiter, 0.0);
    for rate in [RATE, 96_000.0] {
        let seconds = |s: usize| s * rate as usize;
        let sound = render(&patch, rate, &[on(0, 69), off(seconds(60) as u32, 69)], seconds(62));
        // An amplitude of 1 has an RMS of √½. The mean over a minute of a band that is some Hz wide is within 1 dB.
        let level = 20.0 * libm::log10(rms(&sound[seconds(2)..seconds(60)]) * 2_f64.sqrt());
        assert!((level + 12.0).abs() < 1.0, "{rate}: {level:.2} dB");
        assert!(rms(&sound[seconds(61)..]) < 1e-6);
    }
    let routed = patch.with(Param::NoiseHeld, OFF).with_route(0, Source::Pressure, Param::NoiseHeld, 60.0);
    let press = |frame, pressure| event(frame, EventKind::ChannelPressure(pressure));
    let sound = render(&routed, RATE, &[on(0, 69), press(24_000, 1.0)], 72_000);
    assert!(sound[..24_000].iter().all(|sample| *sample == 0.0) && rms(&sound[48_000..]) > 1e-3);
}
