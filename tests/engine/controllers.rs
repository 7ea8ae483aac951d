//! Portamento, legato, mono and poly mode, and keys that are tuned anew: the pitches and strikes that they lead to.

use crate::events::{event, off, on};
use sprung::engine::{Event, EventKind, Synth};
use sprung::params::{Choice, Param, PlayMode};
use sprung::patch::Patch;
use sprung::sound::{Kit, Pad, Sound, Tuning};
use std::sync::Arc;

const RATE: usize = 48_000;

fn control(frame: u32, controller: u8, value: u8) -> Event {
    event(frame, EventKind::Control { controller, value: f32::from(value) / 127.0 })
}

/// A synth whose notes last, after events at their frames and up to a frame.
fn after(patch: &Patch, events: &[Event], frame: usize) -> Synth {
    let mut synth = Synth::new(RATE as f64, 0);
    synth.set_patch(patch);
    let (mut left, mut right) = (vec![0.0; frame], vec![0.0; frame]);
    // An event beyond the end would count as one at the last frame.
    let until = events.partition_point(|event| (event.frame as usize) < frame);
    synth.process(&events[..until], &mut left, &mut right);
    synth
}

fn patch() -> Patch {
    Patch::default().with(Param::Decay, 20.0)
}

/// The pitches that sound, the newest note first.
fn pitches(synth: &Synth) -> Vec<f32> {
    let mut snapshot = sprung::engine::Snapshot::default();
    synth.show(&mut snapshot);
    snapshot.notes.iter().flatten().map(|note| note.pitch).collect()
}

/// Seconds of a glide over 36 semitones at controller 5 = 64.
const SLOW: f64 = 2.06;

#[test]
fn portamento_glides_from_the_note_before_at_the_pace_of_controller_5() {
    let start = RATE / 2;
    let notes = [on(0, 48), off(1000, 48), on(start as u32, 60)];
    for (controllers, seconds) in [
        (&[control(0, 65, 127), control(0, 5, 64)][..], SLOW / 3.0),
        (&[control(0, 5, 64), control(0, 65, 127), control(0, 65, 0)], 0.0),
        (&[control(0, 65, 127), control(0, 5, 64), control(0, 121, 0)], 0.0),
        (&[control(0, 65, 127)], 0.0),
    ] {
        let events = [controllers, &notes].concat();
        for share in [0.25, 0.5, 0.75] {
            let at = start + (share * SLOW / 3.0 * RATE as f64) as usize;
            let pitch = f64::from(pitches(&after(&patch(), &events, at))[0]);
            let expected = if seconds > 0.0 { 48.0 + 12.0 * share } else { 60.0 };
            // The pitch is that at the next control tick, at most 32 frames later.
            assert!((pitch - expected).abs() < 0.03, "{controllers:?}: {pitch}, expected {expected}");
        }
    }
}

#[test]
fn a_key_to_glide_from_counts_once() {
    let events = [control(0, 5, 64), control(0, 84, 72), on(0, 60), on(RATE as u32, 62)];
    let half = (0.5 * SLOW / 3.0 * RATE as f64) as usize;
    let pitch = pitches(&after(&patch(), &events, half))[0];
    assert!((pitch - 66.0).abs() < 0.03, "{pitch}");
    assert_eq!(pitches(&after(&patch(), &events, RATE + 64))[0], 62.0);
}

#[test]
fn without_a_time_portamento_takes_that_of_the_patch() {
    let gliding = patch().with(Param::Glide, 1.0).with(Param::GlideWhen, sprung::params::GlideWhen::Legato.value());
    let notes = [on(0, 48), off(1000, 48), on(24_000, 60)];
    let at = 24_000 + RATE / 2;
    let pitch = pitches(&after(&gliding, &[&[control(0, 65, 127)], &notes[..]].concat(), at))[0];
    assert!((pitch - 54.0).abs() < 0.03, "{pitch}");
    assert_eq!(pitches(&after(&gliding, &notes, at))[0], 60.0);
}

#[test]
fn modes_are_those_that_the_controllers_choose() {
    let chord = [on(100, 60), on(200, 64), on(300, 67)];
    let voices = |patch: &Patch, first: &[Event]| pitches(&after(patch, &[first, &chord].concat(), 4800)).len();
    let mono = patch().with(Param::Mode, PlayMode::Mono.value());
    assert_eq!(voices(&patch(), &[]), 3);
    assert_eq!(voices(&mono, &[]), 1);
    for (first, count) in [
        (&[control(0, 126, 1)][..], 1),
        (&[control(0, 68, 127)], 1),
        (&[control(0, 126, 1), control(0, 127, 0)], 3),
        (&[control(0, 68, 127), control(0, 68, 0)], 3),
        (&[control(0, 68, 127), control(0, 121, 0)], 3),
        (&[control(0, 126, 1), control(0, 121, 0)], 1),
    ] {
        assert_eq!(voices(&patch(), first), count, "{first:?}");
    }
    assert_eq!(voices(&mono, &[control(0, 127, 0)]), 3);
    let poly = Event { channel: 1, ..control(0, 127, 0) };
    assert_eq!(
        voices(&patch(), &[control(0, 126, 1), poly, control(0, 126, 1)]),
        1,
        "the last message of all channels"
    );
}

/// With the footswitch down, a key that is pressed while another is down moves the pitch and does not strike.
#[test]
fn legato_moves_the_note_without_a_strike() {
    let played = |pedal: &[Event]| {
        let mut synth = Synth::new(RATE as f64, 0);
        synth.set_patch(&patch().with(Param::Decay, 0.6));
        let events = [pedal, &[on(0, 60), on(24_000, 62)]].concat();
        let (mut left, mut right) = (vec![0.0; RATE], vec![0.0; RATE]);
        synth.process(&events, &mut left, &mut right);
        let peak = |samples: &[f32]| samples.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        (peak(&left[..4800]), peak(&left[24_000..28_800]), pitches(&synth))
    };
    let (first, second, pitches) = played(&[control(0, 68, 127)]);
    assert!(second < 0.1 * first && pitches == [62.0], "{first} {second} {pitches:?}");
    let (first, second, _) = played(&[control(0, 126, 1)]);
    assert!(second > 0.5 * first, "{first} {second}");
}

#[test]
fn a_key_that_is_tuned_anew_sounds_so_now_or_from_the_next_note_on() {
    let tune = |frame, sounding| event(frame, EventKind::Tune { key: 60, pitch: 67.25, sounding });
    for (sounding, now) in [(false, 60.0), (true, 67.25)] {
        let events = [on(0, 60), on(0, 64), tune(1000, sounding), off(5000, 60), on(9600, 60)];
        let mut first = pitches(&after(&patch(), &events, 4800));
        first.sort_by(f32::total_cmp);
        assert_eq!(first, if sounding { [64.0, now] } else { [now, 64.0] });
        assert_eq!(pitches(&after(&patch(), &events, 9664))[0], 67.25);
    }
}

#[test]
fn keys_with_a_tuning_of_their_own_stay_and_pads_follow_the_key_whose_pitch_they_have() {
    let tune = |key, pitch| event(1000, EventKind::Tune { key, pitch, sounding: true });
    let sounding = |kit: &Arc<Kit>, key: u8, events: &[Event]| {
        let mut synth = Synth::new(RATE as f64, 0);
        synth.set_kit(kit);
        let events = [&[on(0, key)], events].concat();
        let (mut left, mut right) = (vec![0.0; 4800], vec![0.0; 4800]);
        synth.process(&events, &mut left, &mut right);
        pitches(&synth)[0]
    };
    let scale = Tuning::from_scala("\n2\n600.\n2/1\n", None).unwrap();
    let own = Kit::single("own".to_owned(), Arc::new(Sound::new(patch()).tuned(Some(scale))));
    assert_eq!(sounding(&own, 60, &[]), sounding(&own, 60, &[tune(60, 67.25)]));
    let pad = |pitch| Some(Pad { pitch, ..Pad::of(0) });
    let mut pads = vec![None; 128];
    (pads[36], pads[38]) = (pad(Some(60.25)), pad(None));
    let sounds = [patch(), patch()].map(|patch| Arc::new(Sound::new(patch)));
    let kit = Arc::new(Kit::new("kit".to_owned(), sounds.to_vec(), pads));
    for (key, tuned, pitch) in [(36, 36, 60.25), (36, 60, 67.5), (38, 38, 67.25), (38, 60, 38.0)] {
        assert_eq!(sounding(&kit, key, &[tune(tuned, 67.25)]), pitch, "key {key}, tuned {tuned}");
    }
}

/// The sustain pedal lets dampers down by degrees. A switch holds a note wholly or not at all, and a pedal that comes back does not
/// wake what was released.
#[test]
fn half_a_pedal_damps_by_degrees() {
    let patch = patch().with(Param::Release, 0.1);
    // The level in dB half a second after the key went up.
    let level = |pedals: &[(u32, u8)]| {
        let mut events = vec![on(0, 60), off(RATE as u32 / 10, 60)];
        events.extend(pedals.iter().map(|(frame, value)| control(*frame, 64, *value)));
        events.sort_by_key(|event| event.frame);
        let mut synth = after(&patch, &events, RATE * 6 / 10);
        let (mut left, mut right) = ([0.0; 480], [0.0; 480]);
        synth.process(&[], &mut left, &mut right);
        20.0 * libm::log10f(left.iter().fold(1e-9_f32, |most, sample| most.max(sample.abs())))
    };
    let [up, quarter, half, most, down] = [0, 31, 64, 80, 127].map(|value| level(&[(0, value)]));
    assert!((down - level(&[(0, 127), (9000, 96)])).abs() < 0.01, "a light pedal holds");
    assert!(up < -100.0 && (up - quarter).abs() < 0.01, "{up}, {quarter}");
    // At 64 the T60 is the geometric mean of 20 s and 0.1 s, nearly.
    let expected = down - 60.0 * 0.5 / (20.0 * libm::powf(0.005, 1.5 - 2.0 * 64.0 / 127.0)) + 60.0 * 0.5 / 20.0;
    assert!((half - expected).abs() < 0.5, "{half}, expected {expected}");
    assert!(half + 5.0 < most && most + 0.5 < down, "{half}, {most}, {down}");
    // It moves while it holds, up again too.
    let fluttered = level(&[(0, 127), (7000, 70), (9000, 127)]);
    assert!(half < fluttered && fluttered < down, "{fluttered}");
    // Once it has let go, it does not come back.
    let caught = level(&[(0, 127), (6000, 40), (6100, 127)]);
    assert!(caught < half, "{caught}");
    assert!(level(&[(0, 127), (6000, 0), (6100, 127)]) < -90.0);
}
