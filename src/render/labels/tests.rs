//! Tests of labels: of single notes, and of strikes on notes that sound.

use super::*;
use crate::engine::EventKind;
use crate::io::{Song, SongEvent};
use crate::params::Param;
use crate::patch::{Mode, ModeTable, Patch};
use crate::render::{Options, Tail};
use crate::sound::Kit;

const OPTIONS: Options = Options { sample_rate: 48_000, seed: 0, block: 256, tail: Tail::None };

/// The labels of a song.
fn of(song: &Song, patch: &Patch) -> Vec<NoteLabel> {
    let kit = Kit::of_patch(patch);
    let job = Job::new(song, &kit, OPTIONS);
    let mut labels = Labels::new(&job);
    job.render_labelled(Some(&mut labels), |_, _| Ok(())).unwrap();
    labels.finish()
}

/// Reading labels changes no sample.
fn assert_unheard(song: &Song, patch: &Patch) {
    let kit = Kit::of_patch(patch);
    let job = Job::new(song, &kit, OPTIONS);
    let render = |labels: Option<&mut Labels>| {
        let mut samples = Vec::new();
        let sink = |left: &[f32], right: &[f32]| {
            samples.extend(left.iter().chain(right).map(|sample| sample.to_bits()));
            Ok(())
        };
        job.render_labelled(labels, sink).unwrap();
        samples
    };
    assert!(render(Some(&mut Labels::new(&job))) == render(None));
}

fn labels(patch: &Patch, keys: &[f64]) -> Vec<NoteLabel> {
    let song = Song::chord(keys, 1.0, 1.0);
    assert_unheard(&song, patch);
    of(&song, patch)
}

#[test]
fn an_impulse_has_the_levels_of_the_table() {
    let high = Mode { ratio: 2.5, level: 0.5, decay: 0.5, ..Mode::UNIT };
    let mut patch = Patch::default().with(Param::Decay, 2.0).with(Param::Gain, -6.0);
    patch.modes = ModeTable::new(&[Mode::UNIT, high]);
    let labels = labels(&patch, &[69.0, 81.0]);
    assert_eq!(labels.iter().map(|label| label.key).collect::<Vec<_>>(), [69, 81]);
    for (label, pitch) in labels.iter().zip([440.0, 880.0]) {
        assert_eq!((label.onset, label.channel, label.unison), (0, 0, 0));
        let passed = label.free as f64 / 48_000.0;
        for (mode, (ratio, level_db, decay)) in label.modes.iter().zip([(1.0, -6.0, 2.0), (2.5, -12.0206, 1.0)]) {
            assert!((mode.frequency / (pitch * ratio) - 1.0).abs() < 1e-12, "{mode:?}");
            assert_eq!(mode.t60, decay);
            assert!((mode.level_db - (level_db - 60.0 * passed / decay)).abs() < 0.01, "{mode:?} {passed}");
        }
    }
}

#[test]
fn a_strike_is_waited_for_and_a_release_is_not() {
    let noisy =
        Patch::default().with(Param::NoiseLevel, 0.0).with(Param::NoiseReach, 100.0).with(Param::NoiseTime, 0.1);
    let [long] = labels(&noisy, &[60.0]).try_into().unwrap();
    assert!((4800..4900).contains(&long.free), "{}", long.free);
    let song = Song::chord(&[60.0], 1.0, 0.0005);
    let patch = Patch::default().with(Param::Decay, 3.0).with(Param::Release, 0.05);
    let labels = of(&song, &patch);
    assert_eq!(labels[0].modes[0].t60, 3.0);
}

#[test]
fn a_voice_that_is_silenced_during_its_strike_is_waited_for_no_longer() {
    use crate::engine::Notes;
    let mut song = Song::chord(&[60.0], 1.0, 0.5);
    let kind = EventKind::Silence { notes: Notes::default() };
    song.events.insert(1, SongEvent { seconds: 0.01, channel: 0, kind });
    let patch =
        Patch::default().with(Param::NoiseLevel, 0.0).with(Param::NoiseReach, 100.0).with(Param::NoiseTime, 0.4);
    let kit = Kit::of_patch(&patch);
    let job = Job::new(&song, &kit, OPTIONS);
    let mut labels = Labels::new(&job);
    job.render_labelled(Some(&mut labels), |_, _| Ok(())).unwrap();
    assert!(labels.open.is_empty(), "{:?}", labels.open);
    let [label] = labels.finish().try_into().unwrap();
    assert!((480..4800).contains(&label.free), "{}", label.free);
}

/// A song of note ons: each has a time in seconds, a key and a velocity.
fn strikes(notes: &[(f64, u8, f32)]) -> Song {
    let event = |(seconds, key, velocity): &(f64, u8, f32)| {
        let kind = EventKind::NoteOn { key: *key, detune: 0.0, velocity: *velocity, id: None };
        SongEvent { seconds: *seconds, channel: 0, kind }
    };
    Song { events: notes.iter().map(event).collect(), seconds: 1.0 }
}

/// A patch of three modes whose strikes take a while: a mallet and a burst of noise.
fn struck_slowly() -> Patch {
    let mut patch = Patch::default()
        .with(Param::MalletPulse, 1.0)
        .with(Param::NoiseLevel, -6.0)
        .with(Param::NoiseReach, 100.0)
        .with(Param::NoiseTime, 0.1)
        .with(Param::Decay, 4.0);
    patch.modes = ModeTable::new(&[Mode::UNIT, Mode { ratio: 2.7, ..Mode::UNIT }, Mode { ratio: 5.1, ..Mode::UNIT }]);
    patch
}

/// Each strike of key 60 has the label that it has if it alone is on that key. The others are moved to keys of their own, so that
/// the number of each note stays, and with it its noise.
fn assert_as_alone(patch: &Patch, notes: &[(f64, u8, f32)], voices: usize) {
    let together = of(&strikes(notes), patch);
    assert_eq!(together.len(), notes.len() * voices);
    for number in 0..notes.len() {
        if notes[number].2 == 0.0 {
            let silent = |label: &NoteLabel| label.modes.iter().all(|mode| mode.level_db == f64::NEG_INFINITY);
            assert!(together[number * voices..][..voices].iter().all(silent), "{number}");
            continue;
        }
        let moved = |(other, note): (usize, &(f64, u8, f32))| match other == number {
            true => *note,
            false => (note.0, 20 + other as u8, note.2),
        };
        let apart: Vec<_> = notes.iter().enumerate().map(moved).collect();
        let alone = of(&strikes(&apart), patch);
        let alone: Vec<_> = alone.iter().filter(|label| label.key == 60).collect();
        assert_eq!(alone.len(), voices);
        for (voice, alone) in alone.into_iter().enumerate() {
            let label = &together[number * voices + voice];
            let told = |label: &NoteLabel| (label.onset, label.free, label.velocity, label.unison);
            assert_eq!(told(label), told(alone), "{number}");
            for (mode, expected) in label.modes.iter().zip(&alone.modes) {
                assert_eq!((mode.frequency, mode.t60), (expected.frequency, expected.t60));
                let error = (mode.level_db - expected.level_db).abs();
                assert!(error < 0.001 || mode.level_db == expected.level_db, "{number}: {mode:?} {expected:?}");
            }
        }
    }
}

#[test]
fn strikes_of_one_key_have_a_label_each_with_what_each_has_added() {
    let two = [(0.0, 60, 1.0), (0.0, 60, 20.0 / 127.0)];
    let while_it_acts = [(0.0, 60, 0.3), (0.05, 60, 1.0), (0.07, 60, 0.5)];
    let while_it_rings = [(0.0, 60, 1.0), (0.4, 60, 0.1), (0.8, 60, 0.2)];
    let without_force = [(0.0, 60, 1.0), (0.01, 60, 0.0), (0.01, 60, 0.5)];
    let impulse = Patch::default().with(Param::Decay, 4.0);
    let classic = struck_slowly().with(Param::Coefficients, 1.0);
    // All voices with one phase: at a further strike, its phases hold for what is left of the earlier one too.
    let unison = struck_slowly().with(Param::Unison, 3.0).with(Param::UnisonPhase, 0.0);
    for (patch, voices) in [(impulse, 1), (struck_slowly(), 1), (classic, 1), (unison, 3)] {
        assert_unheard(&strikes(&while_it_acts), &patch);
        for notes in [&two[..], &while_it_acts, &while_it_rings, &without_force] {
            assert_as_alone(&patch, notes, voices);
        }
    }
}

#[test]
fn more_strikes_than_can_act_at_once_are_all_labelled() {
    let labels = of(&strikes(&[(0.0, 60, 0.5); 7]), &struck_slowly());
    assert_eq!(labels.len(), 7);
    // A further strike takes the place of the one that would end first, which has then added nothing.
    let silent = labels.iter().filter(|label| label.modes.iter().all(|mode| mode.level_db == f64::NEG_INFINITY));
    assert_eq!(silent.count(), 3);
}

#[test]
fn a_legato_note_in_the_same_tick_is_labelled_too() {
    let labels = of(&strikes(&[(0.0, 60, 1.0), (0.0, 62, 1.0)]), &struck_slowly().with(Param::Mode, 2.0));
    assert_eq!(labels.iter().map(|label| label.key).collect::<Vec<_>>(), [60, 62]);
    let levels = labels.iter().map(|label| label.modes[0].level_db).collect::<Vec<_>>();
    assert!(levels[0] == levels[1] && levels[0] > -40.0, "{levels:?}");
}

#[test]
fn late_notes_are_labelled_at_their_frames() {
    let mut song = Song::chord(&[60.0], 1.0, 0.1);
    let again = song.events.clone().into_iter().map(|event| SongEvent { seconds: event.seconds + 0.5, ..event });
    song.events.extend(again.collect::<Vec<_>>());
    song.seconds = 1.0;
    let labels = of(&song, &Patch::default());
    assert_eq!(labels.iter().map(|label| label.onset).collect::<Vec<_>>(), [0, 24_000]);
}
