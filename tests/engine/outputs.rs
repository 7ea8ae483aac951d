//! Outputs beside the main one: each has the bits of its notes, and together they are what one output would be.

use crate::events::event;
use assert_no_alloc::{assert_no_alloc, violation_count};
use sprung::engine::{Event, EventKind, Outputs, Synth};
use sprung::internals::random::{key, uniform};
use sprung::params::Param;
use sprung::patch::Patch;
use sprung::preset::Preset;
use sprung::sound::{KEYS, Kit, OUTPUTS, Pad, Sound};
use std::sync::Arc;

const FRAMES: usize = 9_600;

/// Left and right of the main output, then of all others.
type All = Vec<[Vec<f32>; 2]>;

/// A kit of five sounds without limiter, with these effects. Each key's pad is on the output that `of` gives.
fn kit(effects: &[(Param, f32)], of: impl Fn(usize) -> u8) -> Arc<Kit> {
    let sound = |name: &str| {
        let patch = Preset::find(name).unwrap().patch.clone().with(Param::Limiter, 0.0).with(Param::Gain, -18.0);
        let off = [(Param::Space, 0.0), (Param::StringsLevel, 0.0), (Param::Drive, 0.0), (Param::TremoloDepth, 0.0)];
        let even = [(Param::ToneLow, 0.0), (Param::ToneHigh, 0.0), (Param::StereoWidth, 100.0)];
        let all = off.iter().chain(&even).chain(effects);
        Arc::new(Sound::new(all.fold(patch, |patch: Patch, (param, value)| patch.with(*param, *value))))
    };
    let sounds = ["Kick", "Snare", "Clap", "Vibraphone", "Wine Glass"].map(sound);
    let pads = (0..KEYS).map(|key| Some(Pad { output: of(key), ..Pad::of(key % sounds.len()) }));
    Arc::new(Kit::new(String::new(), sounds.to_vec(), pads.collect()))
}

fn spread(key: usize) -> u8 {
    (key % (OUTPUTS + 1)) as u8
}

/// Random notes, releases, bends, chokes and knobs on all channels.
fn storm(seed: u64) -> Vec<Event> {
    let stream = key(seed, 0);
    let random = |n: u64, most: u32| ((uniform(stream, n) + 1.0) / 2.0 * most as f32) as u32;
    let mut events: Vec<Event> = (0..240)
        .map(|n| {
            let (key, value) = (30 + random(5 * n, 60) as u8, random(5 * n + 1, 1000) as f32 / 1000.0);
            let kind = match random(5 * n + 2, 16) {
                0 => EventKind::NoteOff { key, velocity: value, id: None },
                1 => EventKind::PitchBend(value),
                2 => EventKind::Control { controller: 64, value: value.round() },
                3 => EventKind::Param { param: Param::Decay, value: 4.0 * value + 0.1 },
                4 => EventKind::Choke { group: 1 },
                _ => EventKind::NoteOn { key, detune: 0.0, velocity: value, id: None },
            };
            Event { channel: random(5 * n + 3, 16) as u8, ..event(random(5 * n + 4, FRAMES as u32), kind) }
        })
        .collect();
    events.sort_by_key(|event| event.frame);
    events
}

fn synth(kit: &Arc<Kit>) -> Synth {
    let mut synth = Synth::new(48_000.0, 1);
    synth.set_kit(kit);
    synth
}

/// What a synth without other outputs plays.
fn plain(kit: &Arc<Kit>, events: &[Event]) -> [Vec<f32>; 2] {
    let [mut left, mut right] = [(); 2].map(|()| vec![f32::NAN; FRAMES]);
    synth(kit).process(events, &mut left, &mut right);
    [left, right]
}

/// Plays in blocks without allocating.
fn split(kit: &Arc<Kit>, events: &[Event], block: usize) -> All {
    let mut synth = synth(kit);
    let mut all: All = (0..=OUTPUTS).map(|_| [(); 2].map(|()| vec![f32::NAN; FRAMES])).collect();
    for start in (0..FRAMES).step_by(block) {
        let end = FRAMES.min(start + block);
        let here = events.iter().filter(|event| (start..end).contains(&(event.frame as usize)));
        let here: Vec<Event> = here.map(|event| Event { frame: event.frame - start as u32, ..*event }).collect();
        let mut sides = all.iter_mut().map(|sides| sides.each_mut().map(|side| &mut side[start..end]));
        let [left, right] = sides.next().unwrap();
        let mut outputs = Outputs::new(sides);
        assert_no_alloc(|| synth.process_with_outputs(&here, &[], left, right, &mut outputs));
    }
    assert_eq!(violation_count(), 0, "allocations on the audio thread");
    all
}

fn is_silent([left, right]: &[Vec<f32>; 2]) -> bool {
    left.iter().chain(right).all(|sample| sample.to_bits() == 0)
}

fn bits([left, right]: &[Vec<f32>; 2]) -> Vec<u32> {
    left.iter().chain(right).map(|sample| sample.to_bits()).collect()
}

#[test]
fn one_output_has_the_bits_of_a_synth_without_others() {
    for (output, seed) in [(0, 1), (1, 2), (9, 3), (16, 4)] {
        let (kit, events) = (kit(&[], |_| output), storm(seed));
        let all = split(&kit, &events, 480);
        let expected = plain(&kit, &events);
        assert!(expected[0].iter().any(|sample| sample.abs() > 0.01));
        for (index, sides) in all.iter().enumerate() {
            match index == usize::from(output) {
                true => assert!(bits(sides) == bits(&expected), "output {output}"),
                false => assert!(is_silent(sides), "output {index} while {output} plays"),
            }
        }
    }
}

/// Each output adds up its voices in the order of all voices, and the outputs are added here in theirs. The difference is rounding, also
/// with effects: the main output has what they make of the sum, less what the others carry.
#[test]
fn all_outputs_add_up_to_one_in_any_blocks() {
    add_up(|effects| &[1, 37, FRAMES][effects..=effects]);
}

#[test]
#[ignore = "takes seconds"]
fn all_outputs_add_up_to_one_in_blocks_of_each_length() {
    add_up(|_| &[1, 37, FRAMES]);
}

/// For no effects, a plate and others: in blocks of these lengths.
fn add_up(blocks: impl Fn(usize) -> &'static [usize]) {
    let plate = [(Param::Space, 1.0), (Param::SpaceMix, 40.0)];
    let driven = [(Param::Drive, 12.0), (Param::TremoloDepth, 50.0), (Param::StereoWidth, 140.0)];
    for (case, effects) in [&[][..], &plate, &driven].into_iter().enumerate() {
        let seed = case as u64;
        let (kit, events) = (kit(effects, spread), storm(seed));
        let all = split(&kit, &events, 480);
        let expected = plain(&kit, &events);
        let peak = all.iter().flatten().flatten().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        let silent = all.iter().filter(|sides| is_silent(sides)).count();
        assert!(silent <= 2, "storm {seed}: {silent} outputs without a note");
        for (side, expected) in expected.iter().enumerate() {
            for (frame, expected) in expected.iter().enumerate() {
                let sum: f64 = all.iter().map(|sides| f64::from(sides[side][frame])).sum();
                let error = (sum - f64::from(*expected)).abs();
                assert!(error <= 4e-6 * f64::from(peak.max(1.0)), "storm {seed}, frame {frame}: {error:e}");
            }
        }
        for &block in blocks(case) {
            let other = split(&kit, &events, block);
            assert!(all.iter().zip(&other).all(|(a, b)| bits(a) == bits(b)), "storm {seed}, blocks of {block}");
        }
    }
}

/// The return of the space is on the main output alone: the others have the bits that they have without it.
#[test]
fn the_space_returns_on_the_main_output() {
    let events = storm(7);
    let dry = split(&kit(&[], spread), &events, 480);
    let wet = split(&kit(&[(Param::Space, 1.0), (Param::SpaceMix, 40.0)], spread), &events, 480);
    assert!(bits(&dry[0]) != bits(&wet[0]));
    assert!(dry.iter().zip(&wet).skip(1).all(|(dry, wet)| bits(dry) == bits(wet)));
}

#[test]
fn the_channels_of_one_sound_go_to_the_outputs_of_their_numbers() {
    let kit = Kit::of_patch(&Preset::find("Wine Glass").unwrap().patch.clone().with(Param::Space, 0.0));
    for channel in 0..16 {
        let note = Event { channel, ..Event::note_on(5, 60, 0.8) };
        let all = split(&kit, &[note], 480);
        let sounding: Vec<usize> = (0..=OUTPUTS).filter(|output| !is_silent(&all[*output])).collect();
        assert_eq!(sounding, [if channel == 0 { 0 } else { usize::from(channel) + 1 }]);
    }
    // The members of an MPE zone are one part.
    let zone = [(101, 0.0), (100, 6.0 / 127.0), (6, 15.0 / 127.0)];
    let zone = zone.map(|(controller, value)| event(0, EventKind::Control { controller, value }));
    let notes = [zone.to_vec(), vec![Event { channel: 4, ..Event::note_on(5, 60, 0.8) }]].concat();
    let all = split(&kit, &notes, 480);
    assert!(!is_silent(&all[0]) && all[1..].iter().all(is_silent));
}

#[test]
fn notes_of_an_output_that_is_not_there_are_on_the_main_one() {
    let (kit, events) = (kit(&[], |_| 5), storm(5));
    let expected = plain(&kit, &events);
    let [mut left, mut right] = [(); 2].map(|()| vec![f32::NAN; FRAMES]);
    synth(&kit).process_with_outputs(&events, &[], &mut left, &mut right, &mut Outputs::default());
    assert!(bits(&[left, right]) == bits(&expected));
}
