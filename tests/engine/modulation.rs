//! Audible effects of routes on a note: every source, and every kind of destination.

use crate::events::{event, off, played};
use sprung::engine::{Event, EventKind, Expression, NoteId, Notes, Synth};
use sprung::params::{PARAMS, Param, Param::*};
use sprung::patch::routes::{Response, Route, Source, amount_param};
use sprung::patch::{Mode, ModeTable, Patch};

const RATE: f64 = 48_000.0;
/// Frames after which two sounds are compared.
const BLOCK: usize = 2_000;

fn control(frame: u32, controller: u8, value: f32) -> Event {
    event(frame, EventKind::Control { controller, value })
}

/// A patch for a long note of one mass, at full level for every velocity. Routes are source, destination, amount in per
/// cent.
fn patch(routes: &[(Source, Param, f32)]) -> Patch {
    let mut patch = Patch::default().with(Decay, 60.0).with(Velocity, 0.0).with(Limiter, 0.0).with(Release, 60.0);
    for (place, (source, destination, amount)) in routes.iter().enumerate() {
        let route = Route { source: *source, destination: *destination, response: Response::Linear, scale: None };
        patch.routes.set(place, Some(route));
        patch.set(amount_param(place), *amount);
    }
    patch
}

fn render(patch: &Patch, seed: u64, events: &[Event], frames: usize) -> Vec<f32> {
    played(patch, (RATE, seed), events, frames)
}

/// Peak of 100 ms, starting at a time in seconds.
fn peak(sound: &[f32], seconds: f64) -> f32 {
    let start = (seconds * RATE) as usize;
    sound[start..start + 4800].iter().fold(0.0, |peak, sample| peak.max(sample.abs()))
}

/// Frequency of 100 ms, starting at a time in seconds, from the first and the last upward zero crossing.
fn frequency(sound: &[f32], seconds: f64) -> f64 {
    let start = (seconds * RATE) as usize;
    let part = &sound[start..start + 4800];
    let crossings: Vec<f64> = part
        .windows(2)
        .enumerate()
        .filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0)
        .map(|(n, pair)| n as f64 + f64::from(pair[0] / (pair[0] - pair[1])))
        .collect();
    (crossings.len() - 1) as f64 * RATE / (crossings[crossings.len() - 1] - crossings[0])
}

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found / expected - 1.0).abs() < tolerance, "{found}, not {expected}");
}

/// Checks how far a source moves the gain of a note, in dB: a sixth of the knob's range is 12 dB.
#[track_caller]
fn assert_moves_gain(source: Source, events: &[Event], expected_db: f64) {
    let frames = 24_000;
    let moved = render(&patch(&[(source, Gain, 100.0 / 6.0)]), 0, events, frames);
    let plain = render(&patch(&[]), 0, events, frames);
    let found = 20.0 * libm::log10(f64::from(peak(&moved, 0.35) / peak(&plain, 0.35)));
    assert!((found - expected_db).abs() < 0.02, "{source:?}: {found} dB, not {expected_db}");
}

#[test]
fn sources_of_the_strike_and_the_hand_move_a_gain() {
    let pressure = event(9600, EventKind::ChannelPressure(0.5));
    let key_pressure = event(9600, EventKind::PolyPressure { key: 60, pressure: 0.5 });
    let timbre = EventKind::Express { notes: Notes::default(), expression: Expression::Brightness, value: 0.25 };
    for (source, events, expected) in [
        (Source::Velocity, vec![Event::note_on(0, 60, 0.5)], 6.0),
        (Source::ReleaseVelocity, vec![Event::note_on(0, 60, 1.0), off(2400, 60)], 6.0),
        (Source::Key, vec![Event::note_on(0, 90, 1.0)], 6.0),
        (Source::Key, vec![Event::note_on(0, 30, 1.0)], -6.0),
        (Source::Alternation, vec![Event::note_on(0, 60, 1.0)], 12.0),
        (Source::Alternation, vec![Event::note_on(0, 60, 1.0), Event::note_on(4800, 60, 1.0)], -12.0),
        (Source::Pressure, vec![Event::note_on(0, 60, 1.0), pressure], 6.0),
        (Source::Pressure, vec![Event::note_on(0, 60, 1.0), key_pressure], 6.0),
        (Source::Timbre, vec![Event::note_on(0, 60, 1.0), event(9600, timbre)], -6.0),
        (Source::Bend, vec![Event::note_on(0, 60, 1.0), event(9600, EventKind::PitchBend(-1.0))], -12.0),
        (Source::Wheel, vec![Event::note_on(0, 60, 1.0), control(9600, 1, 1.0)], 12.0),
        (Source::Breath, vec![Event::note_on(0, 60, 1.0), control(9600, 2, 0.5)], 6.0),
        (Source::Expression, vec![Event::note_on(0, 60, 1.0), control(9600, 11, 0.5)], 6.0),
        (
            Source::Macro3,
            vec![Event::note_on(0, 60, 1.0), event(9600, EventKind::Param { param: Macro3, value: 25.0 })],
            3.0,
        ),
        (Source::Envelope1, vec![Event::note_on(0, 60, 1.0)], 6.0),
    ] {
        // The vibrato from wheel and pressure changes no level, so peaks can be compared.
        assert_moves_gain(source, &events, expected);
    }
}

#[test]
fn an_oscillator_at_the_vibrato_s_rate_and_depth_is_a_vibrato() {
    let vibrato = patch(&[]).with(Vibrato, 96.0).with(VibratoRate, 6.0);
    // 96 cents are 1 % of the range of `tune`.
    let routed = patch(&[(Source::Lfo1, Tune, 1.0)]).with(Lfo1Rate, 6.0);
    let events = [Event::note_on(100, 69, 1.0)];
    let (expected, found) = (render(&vibrato, 0, &events, 48_000), render(&routed, 0, &events, 48_000));
    let worst = expected.iter().zip(&found).fold(0.0f32, |worst, (a, b)| worst.max((a - b).abs()));
    assert!(worst < 2e-3, "{worst}");
}

#[test]
fn a_tempo_sets_the_rate_and_a_fade_lets_it_begin_slowly() {
    // A square wave with a period of one beat: up for half a beat, then down.
    let square = patch(&[(Source::Lfo2, Tune, 10.0)]).with(Lfo2Sync, 4.0).with(Lfo2Shape, 3.0);
    let sound = render(&square, 0, &[event(0, EventKind::Tempo(60.0)), Event::note_on(0, 69, 1.0)], 96_000);
    let (up, down) = (440.0 * libm::exp2(9.6 / 12.0), 440.0 * libm::exp2(-9.6 / 12.0));
    for (seconds, expected) in [(0.1, up), (0.6, down), (1.1, up), (1.6, down)] {
        assert_near(frequency(&sound, seconds), expected, 1e-4);
    }
    let sound = render(
        &square.with(Lfo2Fade, 1.0).with(Lfo2Sync, 0.0).with(Lfo2Rate, 0.01),
        0,
        &[Event::note_on(0, 69, 1.0)],
        96_000,
    );
    assert_near(frequency(&sound, 0.45), 440.0 * libm::exp2(4.8 / 12.0), 2e-3);
    assert_near(frequency(&sound, 1.5), up, 1e-4);
}

#[test]
fn an_envelope_follows_the_key() {
    let envelope = patch(&[(Source::Envelope2, Tune, 12.5)])
        .with(Envelope2Delay, 0.2)
        .with(Envelope2Attack, 0.001)
        .with(Envelope2Hold, 0.2)
        .with(Envelope2Decay, 0.001)
        .with(Envelope2Sustain, 50.0)
        .with(Envelope2Release, 0.001);
    let sound = render(&envelope, 0, &[Event::note_on(0, 57, 1.0), off(38_400, 57)], 58_000);
    for (seconds, semitones) in [(0.05, 0.0), (0.25, 12.0), (0.5, 6.0), (0.9, 0.0)] {
        assert_near(frequency(&sound, seconds), 220.0 * libm::exp2(semitones / 12.0), 1e-4);
    }
}

#[test]
fn what_a_strike_reads_is_moved_by_what_it_knows() {
    // The velocity sets the sweep: 15 semitones at full velocity.
    let routed = patch(&[(Source::Velocity, Sweep, 12.5)]).with(SweepTime, 0.2);
    for velocity in [0.25, 1.0] {
        let plain = patch(&[]).with(SweepTime, 0.2).with(Sweep, 15.0 * velocity);
        let events = [Event::note_on(0, 60, velocity)];
        assert!(render(&routed, 0, &events, 9600) == render(&plain, 0, &events, 9600), "{velocity}");
    }
    // The same for the times of the modulators.
    let envelope = |amount| patch(&[(Source::Velocity, Envelope1Hold, amount), (Source::Envelope1, Tune, 12.5)]);
    let plain = envelope(0.0).with(Envelope1Hold, 5.0);
    assert!(
        render(&envelope(50.0), 0, &[Event::note_on(0, 60, 1.0)], 48_000)
            == render(&plain, 0, &[Event::note_on(0, 60, 1.0)], 48_000)
    );
}

#[test]
fn random_strikes_differ_and_repeat_with_the_seed() {
    let random =
        patch(&[(Source::Random, Tune, 10.0), (Source::Lfo3, Gain, 20.0)]).with(Lfo3Shape, 4.0).with(Lfo3Rate, 40.0);
    let events = [Event::note_on(0, 60, 1.0)];
    let sound = |seed| render(&random, seed, &events, 9600);
    assert!(sound(1) == sound(1) && sound(1) != sound(2));
    let twice =
        render(&random, 1, &[Event::note_on(0, 60, 1.0), off(100, 60), Event::note_on(24_000, 72, 1.0)], 48_000);
    assert!(libm::log2(frequency(&twice, 0.1) / 261.63).abs() > 1e-4, "it is moved");
}

#[test]
fn routes_scale_each_other() {
    let mut by_wheel = patch(&[(Source::Macro1, Tune, 12.5), (Source::Wheel, Route1, -50.0)]);
    let pitch = |patch: &Patch, wheel| {
        let full = event(0, EventKind::Param { param: Macro1, value: 100.0 });
        let sound = render(patch, 0, &[full, control(0, 1, wheel), Event::note_on(0, 57, 1.0)], 20_000);
        12.0 * libm::log2(frequency(&sound, 0.2) / 220.0)
    };
    // Vibrato from the wheel would disturb the measurement.
    by_wheel.set(Route14, 0.0);
    // An amount of 12.5 % moved down by half of its range is −87.5 %.
    assert!((pitch(&by_wheel, 0.0) - 12.0).abs() < 0.01);
    assert!((pitch(&by_wheel, 0.125) - 0.0).abs() < 0.01);
    let mut scaled = patch(&[(Source::Macro1, Tune, 12.5)]).with(Route14, 0.0);
    let route = scaled.routes.get(0).unwrap();
    scaled.routes.set(0, Some(Route { scale: Some(Source::Wheel), response: Response::Squared, ..route }));
    assert!((pitch(&scaled, 0.25) - 3.0).abs() < 0.01);
    assert!((pitch(&scaled.with(Macro1, 50.0), 0.0) - 0.0).abs() < 0.01);
}

#[test]
fn a_shared_oscillator_is_the_same_for_all_notes() {
    let one = patch(&[(Source::Lfo1, Tune, 5.0)]).with(Lfo1Rate, 1.0).with(Lfo1Shape, 2.0);
    for (scope, same) in [(1.0, true), (0.0, false)] {
        let patch = one.clone().with(Lfo1Scope, scope);
        let late = render(
            &patch.clone().with(Voices, 1.0),
            0,
            &[Event::note_on(0, 45, 1.0), Event::note_on(14_400, 57, 1.0)],
            48_000,
        );
        let early = render(&patch, 0, &[Event::note_on(0, 57, 1.0)], 48_000);
        let ratio = frequency(&late, 0.6) / frequency(&early, 0.6);
        // The pitch rises by 10 semitones per second, so within 100 ms the zero crossings depend slightly on the phase.
        assert_eq!((ratio - 1.0).abs() < 4e-3, same, "{ratio}");
    }
}

#[test]
fn a_note_keeps_its_routes_when_the_patch_changes() {
    let vibrato = patch(&[(Source::Lfo1, Tune, 2.0), (Source::Wheel, Gain, 10.0)]);
    let mut synth = Synth::new(RATE, 0);
    synth.set_patch(&vibrato);
    let mut sound = [vec![0.0; 48_000], vec![0.0; 48_000]];
    let [left, right] = &mut sound;
    synth.process(&[Event::note_on(0, 69, 1.0)], &mut left[..4800], &mut right[..4800]);
    synth.set_patch(&patch(&[(Source::Macro1, Tune, 50.0)]).with(Macro1, 100.0));
    synth.process(&[], &mut left[4800..], &mut right[4800..]);
    assert!(sound[0] == render(&vibrato, 0, &[Event::note_on(0, 69, 1.0)], 48_000));
}

#[test]
fn a_route_without_amount_changes_nothing() {
    let events = [Event::note_on(0, 60, 0.8), Event::note_on(2000, 64, 0.3), off(9000, 60)];
    let idle = patch(&[(Source::Lfo1, Tune, 0.0), (Source::Velocity, Decay, 0.0), (Source::Envelope1, Gain, 0.0)]);
    assert!(render(&idle, 0, &events, 24_000) == render(&patch(&[]), 0, &events, 24_000));
}

#[test]
fn a_synchronised_oscillator_keeps_the_tempo_whatever_routes_lead_to_its_rate() {
    let plain = patch(&[(Source::Lfo1, Tune, 2.0)]).with(Lfo1Sync, 4.0);
    let routed = patch(&[(Source::Lfo1, Tune, 2.0), (Source::Velocity, Lfo1Rate, 20.0)]).with(Lfo1Sync, 4.0);
    assert!(
        render(&plain, 0, &[Event::note_on(0, 60, 1.0)], 24_000)
            == render(&routed, 0, &[Event::note_on(0, 60, 1.0)], 24_000)
    );
    let (faster, plain) = (routed.with(Lfo1Sync, 0.0), plain.with(Lfo1Sync, 0.0));
    assert!(
        render(&plain, 0, &[Event::note_on(0, 60, 1.0)], 24_000)
            != render(&faster, 0, &[Event::note_on(0, 60, 1.0)], 24_000)
    );
}

#[test]
fn a_macro_that_moves_while_the_last_note_ends_has_arrived_at_the_next() {
    let routed = patch(&[(Source::Macro1, Tune, 12.5)]).with(Decay, 0.005);
    let full = |frame| event(frame, EventKind::Param { param: Macro1, value: 100.0 });
    let late = render(&routed, 0, &[Event::note_on(0, 57, 1.0), full(1000), Event::note_on(48_000, 57, 1.0)], 60_000);
    let early = render(&routed, 0, &[full(0), Event::note_on(48_000, 57, 1.0)], 60_000);
    assert!(late[48_000..].iter().any(|sample| sample.abs() > 0.01) && late[48_000..] == early[48_000..]);
}

#[test]
fn a_level_starts_where_its_modulation_starts() {
    let swell = patch(&[(Source::Envelope1, Gain, 100.0)]).with(Gain, -60.0).with(Envelope1Attack, 0.5);
    let sound = render(&swell, 0, &[Event::note_on(0, 90, 1.0)], 24_000);
    let largest =
        |range: std::ops::Range<usize>| sound[range].iter().fold(0.0, |most: f32, sample| most.max(sample.abs()));
    assert!(largest(0..32) < 2e-3 && largest(20_000..24_000) > 0.3, "{} {}", largest(0..32), largest(20_000..24_000));
}

#[test]
fn a_decay_that_moves_only_in_the_first_tick_stays_there() {
    // From a T60 of about 7 s to one of 30 ms, shortly after the strike and before it.
    let falls = patch(&[(Source::Lfo1, Decay, 30.0)]).with(Decay, 0.5).with(Lfo1Shape, 3.0).with(Lfo1Rate, 0.1);
    let [late, early] = [49.999, 50.001]
        .map(|phase| render(&falls.clone().with(Lfo1Phase, phase), 0, &[Event::note_on(0, 60, 1.0)], 24_000));
    assert!(peak(&early, 0.0) > 0.1 && peak(&early, 0.1) < 1e-3, "{}", peak(&early, 0.1));
    assert!(peak(&late, 0.1) < 1e-3, "{}", peak(&late, 0.1));
}

#[test]
fn a_brightness_does_not_read_a_strike_again() {
    // The envelope is 0 at the strike; its later movement does not change values that were read at the strike.
    let routed = patch(&[(Source::Envelope1, Tilt, 50.0)]).with(Envelope1Attack, 0.1);
    let events = [Event::note_on(0, 60, 1.0), control(12_000, 74, 0.2)];
    assert!(render(&routed, 0, &events, 24_000) == render(&patch(&[]), 0, &events, 24_000));
}

#[test]
fn a_host_modulates_macros_and_amounts_for_single_notes() {
    let routed = patch(&[(Source::Macro1, Tune, 12.5)]);
    let note = EventKind::NoteOn { key: 57, detune: 0.0, velocity: 1.0, id: NoteId::new(7) };
    let modulated = |param, offset| event(0, EventKind::Modulate { id: NoteId::new(7), param, offset });
    let pitch = |patch: &Patch, events: &[Event]| frequency(&render(patch, 0, events, 20_000), 0.2) / 220.0;
    assert_near(pitch(&routed, &[event(0, note), modulated(Macro1, 1.0)]), 2.0, 1e-4);
    let turned = routed.with(Macro1, 100.0).with(Route1, 0.0);
    assert_near(pitch(&turned, &[event(0, note), modulated(Route1, 0.0625)]), 2.0, 1e-4);
}

#[test]
fn what_a_host_moves_of_a_sounding_note_slides_all_the_way() {
    let routed = patch(&[(Source::Macro1, Tune, 12.5)]);
    let note = EventKind::NoteOn { key: 57, detune: 0.0, velocity: 1.0, id: NoteId::new(7) };
    let later = |param, offset| event(4_000, EventKind::Modulate { id: NoteId::new(7), param, offset });
    let pitch = |patch: &Patch, later| frequency(&render(patch, 0, &[event(0, note), later], 24_000), 0.2) / 220.0;
    assert_near(pitch(&routed, later(Macro1, 1.0)), 2.0, 1e-4);
    let turned = routed.with(Macro1, 100.0).with(Route1, 0.0);
    assert_near(pitch(&turned, later(Route1, 0.0625)), 2.0, 1e-4);
}

/// A patch in five forms: every parameter is audible in at least one of them, and many sources are routed to the pitch. The forms
/// are excited by an impulse, by a mallet's contact, by a pluck, by noise and a bow, and by breath;
/// in two of them, something rattles.
fn busy(form: usize) -> Patch {
    let pitch = [
        Source::Lfo1,
        Source::Lfo2,
        Source::Lfo3,
        Source::Envelope1,
        Source::Envelope2,
        Source::Macro1,
        Source::Macro2,
        Source::Macro3,
        Source::Macro4,
        Source::Macro5,
        Source::Macro6,
        Source::Macro7,
        Source::Macro8,
        Source::Random,
        Source::Wheel,
    ];
    let mut patch = patch(&pitch.map(|source| (source, Tune, 1.0)));
    let modes = [1.0, 2.3, 3.9].map(|ratio| Mode { ratio, pan: ratio - 2.0, strike: 0.5, ..Mode::UNIT });
    patch.modes = ModeTable::new(&modes);
    for (param, value) in [
        (MalletPulse, if form == 1 { 1.0 } else { 0.0 }),
        (MalletHardness, 20.0),
        (MalletLevel, if form < 2 { 0.0 } else { -60.0 }),
        (PluckLevel, if form == 2 { 0.0 } else { -60.0 }),
        (NoiseReach, if form == 3 { 80.0 } else { 0.0 }),
        (NoiseHits, 2.0),
        (BowLevel, if form == 3 { -12.0 } else { -60.0 }),
        (BreathLevel, if form == 4 { -12.0 } else { -60.0 }),
        (BreathNoise, 5.0),
        (BreathSteepening, if form == 4 { 3.0 } else { 0.0 }),
        (Rattle, [0.0, 2.0, 1.0, 0.0, 0.0][form]),
        (RattleGap, 0.5),
        (Velocity, 50.0),
        (Sweep, 12.0),
        (SweepTime, 0.2),
        (Vibrato, 30.0),
        (VibratoDelay, 0.1),
        (Lfo1Fade, 0.2),
        (Lfo2Fade, 0.2),
        (Lfo3Fade, 0.2),
        (Envelope1Delay, 0.05),
        (Envelope2Delay, 0.05),
        (Decay, 2.0),
        (Release, 0.2),
        (Gain, -12.0),
        (Damper, 20.0),
        (DriftLevel, 3.0),
        (Bloom, if form == 0 { 60.0 } else { 0.0 }),
        (Touch, if form == 1 { 40.0 } else { 0.0 }),
        (Unison, 3.0),
        (Soundbox, if form == 0 { 4.0 } else { 0.0 }),
        (SoundboxMix, 60.0),
        (StringsLevel, if form == 0 { 30.0 } else { 0.0 }),
        (TremoloDepth, 30.0),
        (TremoloStereo, 50.0),
        (Space, if form == 1 { 3.0 } else { 0.0 }),
        (SpacePreDelay, 0.1),
    ] {
        patch.set(param, value);
    }
    for param in [Macro2, Macro3, Macro4, Macro5, Macro6, Macro7, Macro8] {
        patch.set(param, 40.0);
    }
    patch
}

/// Whether a patch has this sound, played as far as it has.
fn sounds_as(sound: &[f32], patch: &Patch, events: &[Event]) -> bool {
    let mut synth = Synth::new(RATE, 0);
    synth.set_patch(patch);
    sound.chunks(BLOCK).zip(0..).all(|(sound, block)| {
        let [mut left, mut right] = [[0.0; BLOCK]; 2];
        let here = events.iter().filter(|event| event.frame / BLOCK as u32 == block);
        let here: Vec<Event> = here.map(|event| Event { frame: event.frame % BLOCK as u32, ..*event }).collect();
        synth.process(&here, &mut left, &mut right);
        sound == left
    })
}

#[test]
fn every_quantity_can_be_moved_and_is_heard() {
    let events = [
        Event::note_on(0, 64, 0.6),
        control(2000, 1, 0.5),
        event(2000, EventKind::ChannelPressure(0.4)),
        event(2000, EventKind::PitchBend(0.5)),
        event(14_000, EventKind::NoteOff { key: 64, velocity: 0.9, id: None }),
    ];
    // Without audio input, its level is not audible.
    let heard = PARAMS.iter().filter(|info| info.is_modulatable() && ![Route16, InputLevel].contains(&info.param));
    let frames = 20_000;
    let plain = [0, 1, 2, 3, 4].map(|form| {
        let patch = busy(form).with(Macro1, 100.0).with(Route16, -25.0);
        let sound = render(&patch, 0, &events, frames);
        (patch, sound)
    });
    assert!(plain.iter().all(|(patch, sound)| sounds_as(sound, patch, &events)));
    let deaf = heard.filter(|info| {
        plain.iter().all(|(patch, sound)| {
            let mut moved = patch.clone();
            let route =
                Route { source: Source::Macro1, destination: info.param, response: Response::Linear, scale: None };
            moved.routes.set(15, Some(route));
            // Moves the parameter down, or up if it is at its minimum.
            sounds_as(sound, &moved, &events) && sounds_as(sound, &moved.with(Route16, 25.0), &events)
        })
    });
    let deaf: Vec<_> = deaf.map(|info| info.id).collect();
    assert!(deaf.is_empty(), "{deaf:?} make no difference");
}
