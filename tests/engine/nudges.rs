//! Nudges: one mass is pushed, and nothing else changes.

use crate::events::{event, off, on};
use sprung::engine::{Event, EventKind, Expression, NoteId, Notes, Snapshot, Synth};
use sprung::internals::CONTROL_FRAMES;
use sprung::params::{Param, PlayMode};
use sprung::patch::{Mode, ModeTable, Patch};
use sprung::preset::Preset;

const RATE: f64 = 48_000.0;

/// The mode that is nudged, its level, and its frequency in Hz at key 60.
const M: u16 = 2;
const LEVEL: f32 = 0.25;
const HZ: f64 = 261.63 * 5.4;

/// Three modes with noise but no mallet, without limiter.
fn bar() -> Patch {
    let modes = [(1.0, 0.5), (2.76, 0.5), (5.4, LEVEL)].map(|(ratio, level)| Mode { ratio, level, ..Mode::UNIT });
    let patch = Patch { modes: ModeTable::new(&modes), ..Patch::default() };
    patch.with(Param::Decay, 5.0).with(Param::Gain, 0.0).with(Param::Limiter, 0.0)
}

fn nudge(frame: u32, mode: u16, amplitude: f32) -> Event {
    event(frame, EventKind::Nudge { key: 60, mode, amplitude })
}

/// A note in which only a nudged mode moves.
fn alone(frame: u32, mode: u16, amplitude: f32) -> [Event; 2] {
    [Event::note_on(frame, 60, 0.0), nudge(frame, mode, amplitude)]
}

/// A synth after `frames` frames, and its output to the left.
fn played(patch: &Patch, events: &[Event], frames: usize) -> (Synth, Vec<f32>) {
    let mut synth = Synth::new(RATE, 3);
    synth.set_patch(patch);
    let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
    synth.process(events, &mut left, &mut right);
    (synth, left)
}

fn energies(synth: &Synth) -> Vec<f32> {
    let mut snapshot = Snapshot::default();
    synth.show(&mut snapshot);
    snapshot.masses[..3].iter().map(|mass| mass.energy).collect()
}

fn peak(sound: &[f32]) -> f32 {
    sound.iter().fold(0.0, |peak, sample| peak.max(sample.abs()))
}

#[test]
fn at_rest_only_the_nudged_mass_moves() {
    for coefficients in [0.0, 1.0] {
        let patch = bar().with(Param::Coefficients, coefficients);
        let (synth, sound) = played(&patch, &alone(7, M, 0.5), 1000);
        let energies = energies(&synth);
        assert!(
            energies.iter().enumerate().all(|(m, energy)| (*energy > 0.0) == (m == usize::from(M))),
            "{energies:?}"
        );
        // A T60 of 5 s loses 2 % of the amplitude by then; the original formulas give a mode of 1.4 kHz 10 % more.
        let amplitude = peak(&sound) / (0.5 * LEVEL);
        assert!((0.95..1.0 + 0.12 * coefficients).contains(&amplitude), "{coefficients}: {amplitude}");
        assert!(sound[..7].iter().all(|sample| *sample == 0.0) && sound[7] != 0.0);
        let steepest = std::f64::consts::TAU * HZ / RATE * f64::from(0.5 * LEVEL);
        assert!(f64::from(sound[7].abs()) < 1.1 * steepest, "no click: {} of {steepest}", sound[7]);
    }
}

#[test]
fn what_sounds_goes_on() {
    // At these frames the modes ring freely; they are driven by noise; and their pitch moves.
    let moving = [event(0, EventKind::PitchBend(0.0)), on(1, 60), event(4_990, EventKind::PitchBend(1.0))];
    let noisy = bar().with(Param::NoiseLevel, 0.0).with(Param::NoiseTime, 1.0);
    let cases = [(bar(), vec![on(0, 60)]), (noisy, vec![on(0, 60)]), (bar(), moving.to_vec())];
    for (case, (patch, events)) in cases.into_iter().enumerate() {
        for frame in [4_992, 5_003] {
            let (before, _) = played(&patch, &events, frame as usize);
            let own = energies(&before)[usize::from(M)].sqrt();
            let frames = frame as usize + 1;
            let (without, quiet) = played(&patch, &events, frames);
            let all = [&events[..], &[nudge(frame, M, 0.6)]].concat();
            let (with, sound) = played(&patch, &all, frames);
            for (m, (with, without)) in energies(&with).into_iter().zip(energies(&without)).enumerate() {
                let amplitude = with.sqrt();
                if m == usize::from(M) {
                    let added = 0.6 * LEVEL;
                    let least = (without + added * added).sqrt();
                    assert!((0.99 * least..1.01 * (own + added)).contains(&amplitude), "{case}: {least} {amplitude}");
                } else {
                    // A state that is rendered by tables is up to a control tick old.
                    let change = (amplitude / without.sqrt() - 1.0).abs();
                    assert!(change < 1.5e-3, "{case}: mode {m}: {change}");
                }
            }
            let jump = (sound[frames - 1] - quiet[frames - 1]).abs();
            assert!(f64::from(jump) < std::f64::consts::TAU * HZ / RATE * 0.7 * f64::from(LEVEL), "{case}: {jump}");
        }
    }
}

#[test]
fn a_bowed_sound_can_be_nudged_and_is_not_bowed_by_it() {
    let patch = &Preset::find("Bowed Bell").unwrap().patch;
    let (_, sound) = played(patch, &alone(0, 0, 1.0), 48_000);
    let (start, end) = (peak(&sound[..9_600]), peak(&sound[38_400..]));
    assert!(start > 0.01 && end < start, "{start} {end}");
}

#[test]
fn a_note_that_is_nudged_stays_as_it_was() {
    let id = NoteId::new(7);
    let patch = bar().with(Param::NoteOff, 0.0).with(Param::Release, 0.5).with(Param::Glide, 0.3);
    let tuning =
        EventKind::Express { notes: Notes { id, ..Notes::default() }, expression: Expression::Tuning, value: 3.0 };
    let before = [
        event(0, EventKind::NoteOn { key: 60, detune: 0.5, velocity: 0.8, id }),
        event(0, tuning),
        event(100, EventKind::NoteOff { key: 60, velocity: 0.5, id }),
    ];
    let shown = |events: &[Event]| {
        let (synth, _) = played(&patch, events, 4_000);
        let mut snapshot = Snapshot::default();
        synth.show(&mut snapshot);
        ((snapshot.voices, snapshot.notes, synth.ended().to_vec()), energies(&synth)[0])
    };
    let (with, without) = (shown(&[&before[..], &[nudge(2_000, M, 0.5)]].concat()), shown(&before));
    assert_eq!(with.0, without.0, "pitch, velocity and the note's identifier");
    assert!((with.1 / without.1 - 1.0).abs() < 1e-5, "the damper stays down: {} {}", with.1, without.1);
}

#[test]
fn in_every_play_mode_a_sounding_note_is_nudged_and_others_are_not() {
    for mode in [PlayMode::Poly, PlayMode::Mono, PlayMode::Legato] {
        let patch = bar().with(Param::Mode, mode as u8 as f32);
        let energy = |events: &[Event]| energies(&played(&patch, events, 3_000).0)[usize::from(M)];
        let held = energy(&[on(0, 60)]);
        assert!(energy(&[on(0, 60), nudge(1_000, M, 1.0)]) > 1.5 * held, "{mode:?}");
        assert_eq!(energy(&[on(0, 62), nudge(1_000, M, 1.0)]), energy(&[on(0, 62)]), "{mode:?}");
    }
}

#[test]
fn unison_voices_share_a_nudge() {
    for voices in [1.0, 4.0] {
        let patch = bar().with(Param::Unison, voices).with(Param::UnisonDetune, 0.0);
        let energy = energies(&played(&patch, &alone(0, M, 1.0), 64).0)[usize::from(M)];
        assert!((energy / (LEVEL * LEVEL) - 1.0).abs() < 0.01, "{voices}: {energy}");
    }
}

#[test]
fn the_end_of_what_was_nudged_is_known() {
    let patch = bar().with(Param::Decay, 0.2);
    for events in
        [&alone(0, M, 1.0)[..], &[on(0, 60), nudge(3_003, M, 1.0)], &[on(0, 60), off(900, 60), nudge(903, M, 1.0)]]
    {
        let (mut synth, _) = played(&patch, events, 3_072);
        let tail = synth.tail_frames() as usize;
        assert!((1_000..48_000).contains(&tail), "{tail}");
        let mut found = 0;
        while !synth.is_silent() {
            synth.process(&[], &mut [0.0], &mut [0.0]);
            found += 1;
        }
        assert!(tail.abs_diff(found) <= CONTROL_FRAMES, "{tail} told, {found} found: {events:?}");
    }
}

#[test]
fn nonsense_moves_nothing() {
    for (mode, amplitude) in [(3, 1.0), (u16::MAX, 1.0), (M, f32::NAN), (M, -1.0), (M, f32::NEG_INFINITY)] {
        let (synth, sound) = played(&bar(), &alone(0, mode, amplitude), 64);
        assert!(sound.iter().all(|sample| *sample == 0.0) && synth.is_silent(), "{mode} {amplitude}");
    }
    let (synth, _) = played(&bar(), &[nudge(0, M, 1.0)], 64);
    assert!(synth.is_silent(), "no note sounds that could be nudged");
    let (_, sound) = played(&bar(), &alone(0, M, f32::INFINITY), 4_800);
    assert!(peak(&sound) < 1.001 * LEVEL, "{}", peak(&sound));
}
