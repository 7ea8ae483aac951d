//! The effect of a tuning on notes that sound, glide and choke; unmapped keys do nothing.

use super::{SAMPLE_RATE, cents, heard, tuning};
use crate::damped_sine::fit_unknown;
use crate::events::on_with_id as on;
use sprung::engine::{Ensemble, Event, EventKind, NoteId, Synth};
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::patch::routes::Source;
use sprung::sound::Tuning;

const FRAMES: usize = 12_000;

fn off(channel: u8, key: u8) -> Event {
    Event { channel, ..Event::note_off(0, key) }
}

/// A quarter of a second of the left channel.
fn play(synth: &mut Synth, events: &[Event]) -> Vec<f32> {
    let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
    synth.process(events, &mut left, &mut right);
    left
}

fn frequency(samples: &[f32]) -> f64 {
    fit_unknown(samples, SAMPLE_RATE.into()).unwrap().frequency
}

#[test]
fn sounding_notes_keep_their_pitch_and_new_ones_take_the_tuning() {
    let mut synth = Synth::new(SAMPLE_RATE.into(), 0);
    play(&mut synth, &[on(0, 0, 60, -1)]);
    synth.set_tuning(&tuning("just c-256"));
    assert!(cents(frequency(&play(&mut synth, &[])), 261.625_565).abs() < 0.01);
    let choke = Event { frame: 0, channel: 0, kind: EventKind::Control { controller: 120, value: 0.0 } };
    play(&mut synth, &[choke]);
    assert!(cents(frequency(&play(&mut synth, &[on(0, 0, 60, -1)])), 256.0).abs() < 0.01);
    synth.reset();
    assert!(cents(frequency(&play(&mut synth, &[on(0, 0, 60, -1)])), 256.0).abs() < 0.01, "a reset keeps the tuning");
    synth.prepare(f64::from(SAMPLE_RATE) / 2.0);
    assert!(cents(frequency(&play(&mut synth, &[on(0, 0, 60, -1)])), 512.0).abs() < 0.01, "a new sample rate as well");
}

/// Key tracking follows the tuned pitch: in quarter tones, two keys are a semitone.
#[test]
fn everything_that_follows_pitch_follows_the_tuned_pitch() {
    let patch = Patch::default()
        .with(Param::Glide, 0.1)
        .with(Param::KeyTrack, 70.0)
        .with_route(0, Source::Key, Param::Decay, -18.4)
        .with(Param::Vibrato, 0.3)
        .with(Param::Tuning, 443.0);
    for mode in [0.0, 1.0, 2.0] {
        let bits = |tuning: &Tuning, step: i32| {
            let mut synth = Synth::new(SAMPLE_RATE.into(), 7);
            synth.set_patch(&patch.clone().with(Param::Mode, mode));
            synth.set_tuning(tuning);
            let key = |semitones: i32| (69 + step * semitones) as u8;
            let script =
                [on(0, 0, key(-3), -1), on(0, 0, key(4), -1), on(0, 0, key(1), -1), off(0, key(1)), off(0, key(4))];
            script.iter().flat_map(|event| play(&mut synth, &[*event])).map(f32::to_bits).collect::<Vec<_>>()
        };
        assert!(bits(&tuning("24-equal"), 2) == bits(&Tuning::EQUAL, 1), "mode {mode}");
    }
}

#[test]
fn key_tracking_stretches_the_tuned_pitch() {
    let tuning = tuning("carlos-alpha");
    let tracked = |percent: f32| heard(&tuning, &Patch::default().with(Param::KeyTrack, percent), 89);
    let (none, half, whole) = (tracked(0.0), tracked(50.0), tracked(100.0));
    assert!(cents(none, 261.625_565).abs() < 0.01);
    assert!(cents(whole, 440.0).abs() > 1000.0);
    assert!((cents(half, none) - cents(whole, half)).abs() < 0.01);
}

#[test]
fn a_note_on_an_unmapped_key_starts_nothing() {
    for mode in [0.0, 1.0, 2.0] {
        let mut synth = Synth::new(SAMPLE_RATE.into(), 0);
        synth.set_patch(&Patch::default().with(Param::Mode, mode));
        synth.set_tuning(&tuning("diatonic white-keys"));
        let silent = play(&mut synth, &[on(0, 0, 61, 5)]);
        assert!(silent.iter().all(|sample| *sample == 0.0) && synth.is_silent(), "mode {mode}");
        let ended: Vec<Option<NoteId>> = synth.ended().iter().map(|note| note.id).collect();
        assert_eq!(ended, [NoteId::new(5)], "it has ended as it began");
        play(&mut synth, &[off(0, 61)]);
        assert!(synth.is_silent() && synth.ended().is_empty());

        // It does not affect a sounding note either: it neither steals, retunes nor releases it.
        assert!(
            cents(frequency(&play(&mut synth, &[on(0, 0, 69, 6), on(0, 0, 61, 7), off(0, 61)])), 440.0).abs() < 0.01
        );
        assert_eq!(synth.ended().iter().map(|note| note.id).collect::<Vec<_>>(), [NoteId::new(7)]);
    }
}

#[test]
fn an_ensemble_tunes_every_channel_and_unmapped_keys_choke_nothing() {
    let mut ensemble =
        Ensemble::new(SAMPLE_RATE.into(), 0, &Patch::default().with(Param::Choke, 1.0).with(Param::Decay, 4.0), &[]);
    ensemble.set_tuning(&tuning("diatonic white-keys"));
    let mut play = |events: &[Event]| {
        let (mut left, mut right) = (vec![0.0; FRAMES], vec![0.0; FRAMES]);
        ensemble.process(events, &mut left, &mut right);
        left
    };
    play(&[on(0, 3, 60, -1)]);
    assert!(cents(frequency(&play(&[on(0, 9, 61, -1), off(9, 61)])), 264.0).abs() < 0.01, "choked by a silent key");
    play(&[on(0, 9, 69, -1)]);
    assert!(cents(frequency(&play(&[])), 440.0).abs() < 0.01, "a key that sounds does choke");
}
