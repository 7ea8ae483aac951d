//! What plugin hosts and MPE controllers need from the engine: expressions, modulation, ended notes, tails.

use crate::events::{event, on_with_id as on};
use proptest::prelude::*;
use sprung::engine::{Event, EventKind, Expression, NoteId, Notes, Synth};
use sprung::internals::CONTROL_FRAMES;
use sprung::params::{PARAMS, Param};
use sprung::patch::routes::Source;
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::Preset;

const RATE: usize = 48_000;

fn express(frame: u32, id: i32, expression: Expression, value: f32) -> Event {
    let notes = Notes { id: NoteId::new(id), ..Notes::default() };
    event(frame, EventKind::Express { notes, expression, value })
}

fn modulate(frame: u32, id: Option<i32>, param: Param, offset: f32) -> Event {
    event(frame, EventKind::Modulate { id: id.and_then(NoteId::new), param, offset })
}

fn control(channel: u8, controller: u8, value: u8) -> Event {
    Event { frame: 0, channel, kind: EventKind::Control { controller, value: f32::from(value) / 127.0 } }
}

fn synth(patch: &Patch) -> Synth {
    let mut synth = Synth::new(RATE as f64, 0);
    synth.set_patch(patch);
    synth
}

fn render(patch: &Patch, events: &[Event], frames: usize) -> [Vec<f32>; 2] {
    let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
    synth(patch).process(events, &mut left, &mut right);
    [left, right]
}

/// A sine that hardly decays, at full level and without further processing.
fn sine() -> Patch {
    Patch::default().with(Param::Decay, 60.0).with(Param::Gain, 0.0).with(Param::Limiter, 0.0)
}

fn periods(samples: &[f32]) -> usize {
    samples.windows(2).filter(|pair| pair[0] <= 0.0 && pair[1] > 0.0).count()
}

fn peak(samples: &[f32]) -> f32 {
    samples.iter().fold(0.0, |peak, sample| peak.max(sample.abs()))
}

#[test]
fn an_expression_reaches_its_note_alone() {
    for (expression, value, changed) in [
        (Expression::Tuning, 12.0, (440, 1.0, 1.0)),
        (Expression::Volume, 0.5, (220, 0.5, 0.5)),
        (Expression::Volume, 2.0, (220, 2.0, 2.0)),
        (Expression::Swell, 0.5, (220, 0.25, 0.25)),
        (Expression::Pan, -1.0, (220, 1.414, 0.0)),
    ] {
        for frame in [0, 12_000] {
            for (sounding, told, (expected, left, right)) in [(7, 7, changed), (8, 7, (220, 1.0, 1.0))] {
                let events = [on(0, 0, 57, sounding), express(frame, told, expression, value)];
                let [l, r] = render(&sine(), &events, 2 * RATE);
                let what = format!("{expression:?} {value} at {frame} to {told}");
                assert!(periods(&l[RATE - 1..]).max(periods(&r[RATE - 1..])).abs_diff(expected) <= 1, "{what}");
                assert!((peak(&l[RATE..]) - left).abs() < 0.15 * left.max(0.01), "{what}: {}", peak(&l[RATE..]));
                assert!((peak(&r[RATE..]) - right).abs() < 0.15 * right.max(0.01), "{what}: {}", peak(&r[RATE..]));
            }
        }
    }
}

#[test]
fn what_is_said_with_a_note_is_heard_from_its_start() {
    let [quiet, _] = render(&sine(), &[on(0, 0, 57, 1), express(0, 1, Expression::Volume, 0.0)], 4800);
    assert_eq!(peak(&quiet), 0.0);
    let louder = [on(0, 0, 57, 1), modulate(0, Some(1), Param::Gain, -1.0)];
    assert!(peak(&render(&sine(), &louder, 4800)[0]) < 0.0011, "60 dB less");
}

#[test]
fn wildcards_choose_notes() {
    for (notes, left) in [
        (Notes::default(), 0),
        (Notes { channel: Some(1), ..Notes::default() }, 2),
        (Notes { key: Some(60), ..Notes::default() }, 1),
        (Notes { id: NoteId::new(3), ..Notes::default() }, 2),
        (Notes { id: NoteId::new(9), ..Notes::default() }, 3),
        (Notes::on(0, 64), 2),
    ] {
        for kind in [EventKind::Silence { notes }, EventKind::Release { notes, velocity: 0.5 }] {
            let mut synth = synth(&sine().with(Param::Release, 0.005));
            let (mut l, mut r) = (vec![0.0; 9600], vec![0.0; 9600]);
            let events = [on(0, 0, 60, 1), on(0, 0, 64, 2), on(0, 1, 60, 3), event(4800, kind)];
            synth.process(&events, &mut l, &mut r);
            assert_eq!(synth.ended().len(), 3 - left, "{kind:?}");
        }
    }
}

#[test]
fn modulation_by_key_or_channel_is_that_of_each_of_its_notes() {
    let notes = [on(0, 0, 57, 1), on(0, 0, 64, 2), on(9, 3, 57, 3), on(10, 3, 50, -1)];
    for (selected, ids) in [
        (Notes::default(), &[1, 2, 3][..]),
        (Notes { key: Some(57), ..Notes::default() }, &[1, 3]),
        (Notes { channel: Some(0), ..Notes::default() }, &[1, 2]),
        (Notes::on(3, 57), &[3]),
        (Notes { id: NoteId::new(2), ..Notes::default() }, &[2]),
        (Notes::on(5, 57), &[]),
    ] {
        // The note without an id is left out, since no single modulation finds it.
        let with = |modulations: Vec<Event>| {
            let later = on(9_000, 0, 57, 4);
            let events: Vec<Event> = notes[..3].iter().copied().chain(modulations).chain([later]).collect();
            render(&sine(), &events, 12_000)
        };
        let (param, offset) = (Param::Tune, 0.03);
        let together = with(vec![event(4_000, EventKind::ModulateNotes { notes: selected, param, offset })]);
        let each = with(ids.iter().map(|id| modulate(4_000, Some(*id), param, offset)).collect());
        assert!(together == each, "{selected:?}");
        assert_eq!(together == with(vec![]), ids.is_empty(), "{selected:?}");
    }
    let by_key = Notes { key: Some(50), ..Notes::default() };
    let [left, _] = render(
        &sine(),
        &[notes[3], event(10, EventKind::ModulateNotes { notes: by_key, param: Param::Tune, offset: 12.0 / 96.0 })],
        RATE + 2_000,
    );
    assert!(periods(&left[2_000..]).abs_diff(294) <= 1, "a note without an id, an octave up from D3");
}

/// Spectral centroid over the harmonics of a note, as a harmonic number.
fn centroid(samples: &[f32], frequency: f64, harmonics: usize) -> f64 {
    let (mut sum, mut weighted) = (0.0, 0.0);
    for harmonic in 1..=harmonics {
        let (mut re, mut im) = (0.0, 0.0);
        for (n, sample) in samples.iter().enumerate() {
            let phase = std::f64::consts::TAU * frequency * harmonic as f64 * n as f64 / RATE as f64;
            re += f64::from(*sample) * libm::cos(phase);
            im += f64::from(*sample) * libm::sin(phase);
        }
        let power = re * re + im * im;
        sum += power;
        weighted += power * harmonic as f64;
    }
    weighted / sum
}

#[test]
fn brightness_tilts_the_strike_and_damps_what_sounds() {
    let mut patch = sine();
    patch.modes = ModeTable::new(&[1.0, 2.0, 3.0, 4.0].map(|ratio| Mode { ratio, level: 0.3, ..Mode::UNIT }));
    let hear = |events: &[Event], from: usize| centroid(&render(&patch, events, from + 9600)[0][from..], 220.0, 4);
    let plain = hear(&[on(0, 0, 57, 1)], 0);
    let told = |value| express(0, 1, Expression::Brightness, value);
    let (dull, same, bright) = (
        hear(&[on(0, 0, 57, 1), told(0.0)], 0),
        hear(&[on(0, 0, 57, 1), told(0.5)], 0),
        hear(&[on(0, 0, 57, 1), told(1.0)], 0),
    );
    assert!(dull < plain - 0.5 && bright > plain + 0.5 && same == plain, "{dull} {plain} {bright}");
    let timbre = |value| hear(&[control(0, 74, value), on(0, 0, 57, 1)], 0);
    assert!((timbre(127) - bright).abs() < 1e-6 && (timbre(0) - dull).abs() < 1e-6 && timbre(64) == plain);
    let short = patch.with(Param::Decay, 2.0);
    let later = |value| {
        let events = [on(0, 0, 57, 1), express(4800, 1, Expression::Brightness, value)];
        centroid(&render(&short, &events, 33_600)[0][24_000..], 220.0, 4)
    };
    assert!(later(0.0) < later(0.5) - 0.1 && later(1.0) == later(0.5), "{} {}", later(0.0), later(0.5));
}

#[test]
fn a_note_with_an_offset_of_its_own_heeds_no_other() {
    let both = [on(0, 0, 57, 1), modulate(0, None, Param::Tune, 12.0 / 96.0), modulate(0, Some(1), Param::Tune, 0.0)];
    for (events, expected) in [
        (&both[..1], 220),
        (&both[..2], 440),
        (&both[..], 220),
        (&[both[0], both[1], modulate(RATE as u32, None, Param::Tune, 0.0)], 220),
        (&[both[0], modulate(0, Some(2), Param::Tune, 0.5)], 220),
        // The offset is added to the parameter's value, also when that changes later.
        (
            &[
                both[0],
                modulate(0, Some(1), Param::Tune, -12.0 / 96.0),
                event(0, EventKind::Param { param: Param::Tune, value: 24.0 }),
            ],
            440,
        ),
    ] {
        let [left, _] = render(&sine(), events, 2 * RATE + 2000);
        let found = periods(&left[RATE + 2000 - 1..]);
        assert!(found.abs_diff(expected) <= 1, "{events:?}: {found}");
    }
    let mut synth = synth(&sine());
    synth.handle(&modulate(0, None, Param::Gain, -0.5));
    assert_eq!(synth.values(), &sine().values, "what is modulated is not the patch");
}

#[test]
fn a_note_follows_its_patch_while_another_body_is_made_ready() {
    let events = [
        on(0, 0, 57, 1),
        modulate(4800, None, Param::Width, -0.5),
        event(9600, EventKind::Param { param: Param::Gain, value: -60.0 }),
    ];
    assert!(peak(&render(&sine(), &events, RATE)[0][24_000..]) < 2e-3);
}

#[test]
fn mpe_members_bend_by_48_semitones_and_their_master_bends_all() {
    // Registered parameter 6 on channel 1: a zone with fifteen members.
    let zone = [control(0, 101, 0), control(0, 100, 6), control(0, 6, 15)];
    let bend = |channel, value| Event { frame: 0, channel, kind: EventKind::PitchBend(value) };
    for (events, expected) in [
        (vec![bend(1, 0.25)], 440),
        (vec![bend(2, 0.25)], 220),
        (vec![bend(0, 1.0), bend(1, 0.25)], 494),
        (vec![bend(0, -1.0)], 196),
        (vec![control(5, 101, 0), control(5, 100, 0), control(5, 6, 24), bend(1, 0.5)], 440),
    ] {
        let all: Vec<_> = zone.iter().chain(&events).chain(&[on(0, 1, 57, -1)]).copied().collect();
        let [left, _] = render(&sine(), &all, 2 * RATE);
        assert!(periods(&left[RATE - 1..]).abs_diff(expected) <= 1, "{events:?}: {}", periods(&left[RATE - 1..]));
    }
    // The master channel's pedal holds the notes of its members until the zone is dissolved.
    let dissolve = control(0, 6, 0);
    let pedal = |events: &[Event]| {
        let off = Event { channel: 1, ..Event::note_off(4800, 57) };
        let all: Vec<_> = zone.iter().chain(events).chain(&[on(0, 1, 57, -1), off]).copied().collect();
        peak(&render(&sine().with(Param::Release, 0.01), &all, RATE)[0][24_000..])
    };
    let down = control(0, 64, 127);
    assert!(pedal(&[]) < 1e-3 && pedal(&[down]) > 0.9 && pedal(&[down, dissolve]) < 1e-3);
    let all = [&zone[..], &[dissolve, bend(1, 1.0), on(0, 1, 57, -1)]].concat();
    let [left, _] = render(&sine(), &all, 2 * RATE);
    assert!(periods(&left[RATE - 1..]).abs_diff(247) <= 1, "two semitones again: {}", periods(&left[RATE - 1..]));
}

#[test]
fn a_synchronised_vibrato_keeps_the_beat() {
    let patch = sine().with(Param::Vibrato, 600.0).with(Param::VibratoSync, 4.0);
    // At 60 beats per minute a quarter note lasts a second: the first half is sharp, the second flat.
    let [left, _] = render(&patch, &[event(0, EventKind::Tempo(60.0)), on(0, 0, 69, 1)], RATE);
    let (sharp, flat) = (periods(&left[..RATE / 2]), periods(&left[RATE / 2..]));
    assert!(sharp > 260 && flat < 185, "{sharp} {flat}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_note_ends_once(
        mode in 0..3_u8,
        polyphony in 1..20_u8,
        steps in prop::collection::vec((0..8_u8, 50..56_u8, 0..2_u8, 0..2000_u32), 1..60),
    ) {
        let patch = Patch::default()
            .with(Param::Mode, mode.into())
            .with(Param::Voices, polyphony.into())
            .with(Param::Choke, f32::from(polyphony % 2))
            .with(Param::Decay, 0.05);
        let mut synth = synth(&patch);
        let mut ended = vec![];
        let (mut left, mut right) = (vec![0.0; 2000], vec![0.0; 2000]);
        let (mut id, mut started) = (0, vec![]);
        for (action, key, channel, frames) in steps {
            let pedal = |value| EventKind::Control { controller: 64, value };
            let kind = match action {
                0..=3 => {
                    id += 1;
                    started.push(id);
                    EventKind::NoteOn { key, detune: 0.0, velocity: 0.8, id: NoteId::new(id) }
                }
                4 => EventKind::NoteOff { key, velocity: 0.5, id: None },
                5 => EventKind::Release { notes: Notes { id: NoteId::new(id), ..Notes::default() }, velocity: 0.5 },
                6 => pedal(f32::from(key % 2)),
                _ => EventKind::Param { param: Param::Mode, value: f32::from(key % 3) },
            };
            let frames = frames as usize;
            synth.process(&[Event { frame: 0, channel, kind }], &mut left[..frames], &mut right[..frames]);
            ended.extend(synth.ended().iter().filter_map(|note| note.id.map(NoteId::number)));
        }
        let release = EventKind::Release { notes: Notes::default(), velocity: 0.5 };
        let silence = EventKind::Silence { notes: Notes::default() };
        synth.process(&[event(0, release), event(100, silence)], &mut left, &mut right);
        ended.extend(synth.ended().iter().filter_map(|note| note.id.map(NoteId::number)));
        prop_assert!(synth.is_silent());
        ended.sort_unstable();
        prop_assert_eq!(ended, started);
    }
}

/// Renders until silence and returns the frame at which it begins.
fn frames_to_silence(synth: &mut Synth) -> u64 {
    let (mut left, mut right) = ([0.0; CONTROL_FRAMES], [0.0; CONTROL_FRAMES]);
    let mut frames = 0;
    while !synth.is_silent() {
        synth.process(&[], &mut left[..1], &mut right[..1]);
        frames += 1;
        assert!(frames < 4_000_000);
    }
    // The first silent frame is included in `frames`.
    frames - 1
}

/// Whether oscillators or envelopes modulate a patch, something rattles, or a bow, breath, noise or audio input drives it while a key
/// is held: then its end is unknown.
fn is_moving(patch: &Patch) -> bool {
    use Source::{Envelope1, Envelope2, Lfo1, Lfo2, Lfo3};
    let moves = |source| matches!(source, Lfo1 | Lfo2 | Lfo3 | Envelope1 | Envelope2);
    let drives =
        |param: &Param| patch.get(*param) > -60.0 || patch.routes.iter().any(|(_, route)| route.destination == *param);
    [Param::BowLevel, Param::BreathLevel, Param::NoiseHeld, Param::InputLevel].iter().any(drives)
        || patch.get(Param::Rattle) > 0.0
        || patch.routes.iter().any(|(_, route)| moves(route.source) || route.scale.is_some_and(moves))
}

#[test]
fn some_tails_are_told_exactly() {
    tails(16);
}

#[test]
#[ignore = "takes minutes"]
fn all_tails_are_told_exactly() {
    tails(1);
}

/// The tails of every so many presets.
fn tails(step: usize) {
    let mut sounding = 0;
    for preset in Preset::factory().iter().step_by(step) {
        let patch = preset.patch.clone().with(Param::Decay, preset.patch.get(Param::Decay).min(1.0));
        for off in [false, true] {
            let mut synth = synth(&patch);
            // Longer than the longest exciter.
            let (mut left, mut right) = (vec![0.0; 60_017], vec![0.0; 60_017]);
            let release = EventKind::Release { notes: Notes::default(), velocity: 0.5 };
            let events = [on(0, 0, 60, 1), on(8_000, 0, 67, 2), event(59_000, release)];
            synth.process(&events[..if off { 3 } else { 2 }], &mut left, &mut right);
            let told = synth.tail_frames();
            if told == u64::MAX {
                assert!(is_moving(&preset.patch), "{}: no end is told", preset.name);
                continue;
            }
            let found = if synth.is_silent() { 0 } else { frames_to_silence(&mut synth) };
            sounding += usize::from(found > 0);
            // With effects behind the voices, bloom or hits that are still to come, the tail is an upper bound.
            let is_set = |param: &Param| preset.patch.get(*param) != param.info().default;
            let is_bound = PARAMS.iter().any(|info| info.param.is_behind_voices() && is_set(&info.param))
                || [Param::Bloom, Param::NoiseHits].iter().any(is_set);
            let is_right = told.abs_diff(found) <= CONTROL_FRAMES as u64 || (is_bound && told > found);
            assert!(is_right, "{}: {told} told, {found} found", preset.name);
            assert_eq!(synth.tail_frames(), 0);
        }
    }
    assert!(sounding * step > 40, "only {sounding} sounded when they were asked");
}

#[test]
fn a_tail_is_told_of_what_cannot_be_heard_yet_and_of_what_was_retuned() {
    let above = Patch::default().with(Param::Sweep, 60.0).with(Param::SweepTime, 2.0).with(Param::Decay, 4.0);
    let legato = Patch::default().with(Param::Mode, 2.0).with_route(0, Source::Key, Param::Decay, -37.0);
    for (patch, key, next) in [(above, 84, None), (legato, 84, Some(36))] {
        let mut synth = synth(&patch);
        let (mut left, mut right) = (vec![0.0; 9600], vec![0.0; 9600]);
        synth.process(&[on(0, 0, key, 1)], &mut left, &mut right);
        let before = synth.tail_frames();
        let retune: Vec<_> = next.map(|key| on(0, 0, key, 2)).into_iter().collect();
        synth.process(&retune, &mut left[..4800], &mut right[..4800]);
        let told = synth.tail_frames();
        let found = frames_to_silence(&mut synth);
        assert!(told.abs_diff(found) <= CONTROL_FRAMES as u64, "{key}: {told} told, {found} found, {before} before");
    }
}

#[test]
fn a_tail_told_during_a_strike_is_never_too_short() {
    for (pulse, mallet, reach, time) in [(0.0, 0.0, 0.0, 0.1), (1.0, 0.0, 0.0, 0.1), (0.0, -60.0, 100.0, 0.5)] {
        let patch = Patch::default()
            .with(Param::MalletPulse, pulse)
            .with(Param::MalletLevel, mallet)
            .with(Param::NoiseReach, reach)
            .with(Param::MalletHardness, 0.0)
            .with(Param::NoiseTime, time)
            .with(Param::Decay, 0.2);
        let mut synth = synth(&patch);
        let (mut left, mut right) = ([0.0; 40], [0.0; 40]);
        synth.process(&[on(0, 0, 60, 1)], &mut left, &mut right);
        let told = synth.tail_frames();
        let found = frames_to_silence(&mut synth);
        assert!(
            told + 1 >= found && told < found + 2 * RATE as u64,
            "{pulse}, {mallet}, {reach}: {told} told, {found} found"
        );
    }
}

#[test]
fn a_note_that_never_ends_has_an_endless_tail() {
    // The original formula rounds such a small damping to zero.
    let endless = Mode { ratio: 0.25, decay: 10.0, ..Mode::UNIT };
    let short = Mode { ratio: 2.0, decay: 0.01, ..Mode::UNIT };
    for modes in [&[endless][..], &[endless, short]] {
        let mut patch = Patch::default().with(Param::Coefficients, 1.0).with(Param::Decay, 60.0);
        patch = patch.with(Param::DecayTilt, 2.0);
        patch.modes = ModeTable::new(modes);
        let mut synth = synth(&patch);
        let (mut left, mut right) = (vec![0.0; 4800], vec![0.0; 4800]);
        for events in [&[on(0, 0, 110, 1)][..], &[]] {
            events.iter().for_each(|event| synth.handle(event));
            // Before the strike, and long after it.
            assert!(synth.tail_frames() > 1 << 49, "{} frames", synth.tail_frames());
            synth.process(&[], &mut left, &mut right);
        }
        assert!(left[4700..].iter().any(|sample| sample.abs() > 0.4), "it does ring on");
    }
}
