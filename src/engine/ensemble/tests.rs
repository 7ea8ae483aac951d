//! An ensemble compared with a single synth: channels, keys, zones and block lengths.

use super::Ensemble;
use crate::engine::{Event, EventKind, Notes, Synth};
use crate::params::Param;
use crate::patch::Patch;
use crate::sound::Kit;

const FRAMES: usize = 480;

fn on(channel: u8, key: u8) -> Event {
    Event { channel, ..Event::note_on(20, key, 1.0) }
}

fn off(channel: u8, key: u8) -> Event {
    Event { channel, ..Event::note_off(0, key) }
}

/// The output of a synth and of an ensemble for the same events, each event in a block of its own.
fn both(events: &[Event]) -> [Vec<f32>; 2] {
    let patch = Patch::default().with(Param::Release, 0.01);
    let mut synth = Synth::new(48_000.0, 0);
    synth.set_patch(&patch);
    let mut ensemble = Ensemble::new(48_000.0, 0, &patch, &[]);
    let (mut alone, mut mixed) = (Vec::new(), Vec::new());
    for event in events {
        let (mut left, mut right) = ([9.0; FRAMES], [9.0; FRAMES]);
        synth.process(&[*event], &mut left, &mut right);
        alone.extend(left);
        ensemble.process(&[*event], &mut left, &mut right);
        mixed.extend(left);
    }
    [alone, mixed]
}

#[test]
fn channels_and_keys_beyond_midi_are_the_last() {
    let expected = both(&[on(15, 127), off(15, 127)]);
    assert!(expected.iter().flatten().any(|sample| sample.abs() > 0.01), "it sounds");
    assert!(expected[0] != both(&[on(15, 127), off(0, 127)])[0], "a note-off elsewhere releases nothing");
    for (channel, key) in [(16, 127), (31, 200), (255, 255), (15, 128)] {
        assert!(both(&[on(channel, key), off(15, 127)]) == expected, "{channel} {key}");
        assert!(both(&[on(15, 127), off(channel, key)]) == expected, "{channel} {key}");
        let notes = Notes { id: None, channel: Some(channel), key: Some(key) };
        let release = Event { frame: 0, channel, kind: EventKind::Release { notes, velocity: 0.5 } };
        assert!(both(&[on(15, 127), release]) == expected, "{channel} {key}");
    }
    let mut ensemble = Ensemble::new(48_000.0, 0, &Patch::default(), &[]);
    ensemble.set_kit(200, &Kit::of_patch(&Patch::default().with(Param::Gain, -3.0)));
    assert_eq!(ensemble.parts[15].synth.values().get(Param::Gain), -3.0);
}

#[test]
fn the_members_of_a_zone_play_on_their_master_s_instrument() {
    let control = |channel, controller, value: u8| {
        let kind = EventKind::Control { controller, value: f32::from(value) / 127.0 };
        Event { frame: 0, channel, kind }
    };
    let bend = |channel, bend| Event { frame: 0, channel, kind: EventKind::PitchBend(bend) };
    let pressure = |channel| Event { frame: 7, channel, kind: EventKind::ChannelPressure(0.7) };
    for (master, first, second) in [(0, 1, 15), (15, 14, 3)] {
        let zone = [control(master, 101, 0), control(master, 100, 6), control(master, 6, 15)];
        let notes = [bend(first, 0.25), on(first, 57), on(second, 60), bend(second, -0.5), bend(master, 1.0)];
        let rest = [pressure(first), off(first, 57), control(master, 64, 127), off(second, 60), on(second, 60)];
        let events: Vec<Event> = zone.into_iter().chain(notes).chain(rest).collect();
        let [alone, mixed] = both(&events);
        // Seeds differ between channels, but nothing in this patch is random.
        assert!(alone == mixed, "{master}");
        assert!(alone.iter().any(|sample| sample.abs() > 0.01), "it sounds");
    }
}

#[test]
fn channels_keep_what_they_hold_when_a_zone_is_made_or_dissolved() {
    let at = |frame, channel, kind| Event { frame, channel, kind };
    let control = |frame, channel, controller, value: u8| {
        at(frame, channel, EventKind::Control { controller, value: f32::from(value) / 127.0 })
    };
    let zone = |frame, members| [control(frame, 0, 101, 0), control(frame, 0, 100, 6), control(frame, 0, 6, members)];
    let note = |frame, channel, key| at(frame, channel, on(channel, key).kind);
    let events: Vec<Event> = [control(5, 2, 7, 30), control(5, 2, 10, 100), at(6, 2, EventKind::PitchBend(0.5))]
        .into_iter()
        .chain([note(90, 2, 50), note(100, 5, 64)])
        .chain(zone(100, 15))
        .chain([note(100, 2, 57), note(101, 3, 60), control(1500, 2, 7, 90)])
        .chain(zone(1600, 0))
        .chain([note(1600, 2, 59), note(2000, 3, 62)])
        .collect();
    // A short release, so that notes struck before a zone change have ended before their channel gets another owner.
    let patch = Patch::default().with(Param::Release, 0.005).with(Param::Limiter, 0.0);
    let mut synth = Synth::new(48_000.0, 0);
    synth.set_patch(&patch);
    let mut alone = ([0.0; 3000], [0.0; 3000]);
    synth.process(&events, &mut alone.0, &mut alone.1);
    for block in [3000, 7, 64] {
        let mut ensemble = Ensemble::new(48_000.0, 0, &patch, &[]).with_chunk(50);
        let mut mixed = (vec![], vec![]);
        for start in (0..3000).step_by(block) {
            let frames = block.min(3000 - start);
            let here = events.iter().filter(|event| (start..start + frames).contains(&(event.frame as usize)));
            let here: Vec<Event> = here.map(|event| Event { frame: event.frame - start as u32, ..*event }).collect();
            let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
            ensemble.process(&here, &mut left, &mut right);
            mixed.0.extend(left);
            mixed.1.extend(right);
        }
        // In a single synth, an event on one channel restarts the parameter ramps of notes on other channels, towards
        // the same targets. So the outputs differ slightly.
        let worst = |one: &[f32], other: &[f32]| {
            one.iter().zip(other).map(|(one, other)| (one - other).abs()).fold(0.0, f32::max)
        };
        let worst = [worst(&alone.0, &mixed.0), worst(&alone.1, &mixed.1)];
        assert!(worst.iter().all(|worst| *worst < 0.01), "blocks of {block}: {worst:?}");
    }
    assert!(alone.0.iter().any(|sample| sample.abs() > 0.01), "it sounds");
}

#[test]
fn keys_that_are_held_while_a_zone_is_made_are_let_go() {
    let data = |controller, value: u8| {
        let kind = EventKind::Control { controller, value: f32::from(value) / 127.0 };
        Event { frame: 0, channel: 0, kind }
    };
    let mut ensemble = Ensemble::new(48_000.0, 0, &Patch::default().with(Param::Release, 0.01), &[]);
    let (mut left, mut right) = ([0.0; FRAMES], [0.0; FRAMES]);
    ensemble.process(&[on(5, 60)], &mut left, &mut right);
    assert!(!ensemble.is_silent(), "it sounds");
    ensemble.process(&[data(101, 0), data(100, 6), data(6, 15)], &mut left, &mut right);
    (0..10).for_each(|_| ensemble.process(&[], &mut left, &mut right));
    assert!(ensemble.is_silent());
}

#[test]
fn of_sides_that_differ_in_length_the_shorter_counts() {
    let patch = Patch::default();
    for (left_frames, right_frames) in [(100, 400), (400, 100), (0, 400)] {
        let mut synth = Synth::new(48_000.0, 0);
        let mut ensemble = Ensemble::new(48_000.0, 0, &patch, &[]).with_chunk(64);
        let (mut left, mut right) = (vec![9.0; left_frames], vec![9.0; right_frames]);
        synth.process(&[on(0, 60)], &mut left, &mut right);
        let alone = (left.clone(), right.clone());
        left.fill(9.0);
        right.fill(9.0);
        ensemble.process(&[on(0, 60)], &mut left, &mut right);
        assert!((left.clone(), right.clone()) == alone);
        let frames = left_frames.min(right_frames);
        for side in [&left, &right] {
            assert!(side[..frames].iter().all(|sample| *sample != 9.0));
            assert!(side[frames..].iter().all(|sample| *sample == 9.0), "the rest stays as it was");
        }
        assert!(frames == 0 || left[..frames].iter().any(|sample| sample.abs() > 0.01), "it sounds");
        // The next block continues where this one ended.
        let (mut rest, mut whole) = (([0.0; 300], [0.0; 300]), ([0.0; 400], [0.0; 400]));
        synth.process(&[], &mut rest.0, &mut rest.1);
        let mut other = Synth::new(48_000.0, 0);
        other.process(&[on(0, 60)], &mut whole.0, &mut whole.1);
        assert!(frames == 0 || whole.0[frames..] == rest.0[..400 - frames]);
    }
}
