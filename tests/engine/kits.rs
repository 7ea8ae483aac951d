//! Kits: keys that play sounds of their own, choke each other, and are replaced while they ring.

use crate::events::event;
use sprung::Error;
use sprung::engine::{Ensemble, Event, EventKind, Synth};
use sprung::params::{PARAMS, Param};
use sprung::patch::Patch;
use sprung::preset::{KitPreset, Playable, Preset};
use sprung::sound::{KEYS, Kit, Pad, Sound, Tuning};
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

const RATE: f64 = 48_000.0;

type Sides = [Vec<u32>; 2];

fn synth(kit: &Arc<Kit>) -> Synth {
    let mut synth = Synth::new(RATE, 1);
    synth.set_kit(kit);
    synth
}

fn play(synth: &mut Synth, events: &[Event], frames: usize) -> Sides {
    let (mut left, mut right) = (vec![0.0; frames], vec![0.0; frames]);
    synth.process(events, &mut left, &mut right);
    [left, right].map(|side| side.into_iter().map(f32::to_bits).collect())
}

fn sounds(sides: &Sides) -> bool {
    sides.iter().flatten().any(|bits| f32::from_bits(*bits).abs() > 1e-3)
}

fn kit(patches: &[Patch], pads: Vec<Option<Pad>>) -> Arc<Kit> {
    let sounds = patches.iter().map(|patch| Arc::new(Sound::new(patch.clone()))).collect();
    Arc::new(Kit::new("kit".to_owned(), sounds, pads))
}

/// The pads of a kit that has these pads on these keys and no others.
fn on_keys(pads: &[(usize, Pad)]) -> Vec<Option<Pad>> {
    (0..KEYS).map(|key| pads.iter().find(|(of, _)| *of == key).map(|(_, pad)| pad.clone())).collect()
}

fn factory(name: &str) -> Patch {
    Preset::find(name).unwrap().patch.clone()
}

fn drums() -> KitPreset {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/kits/acoustic-kit.toml");
    let mut open = |path: &Path| File::open(path).map_err(|source| Error::io(path.display().to_string(), source));
    match Playable::read(&path, &mut open).unwrap() {
        Playable::Kit(kit) => kit,
        Playable::Preset(_) => panic!("a kit"),
    }
}

#[test]
fn each_of_128_keys_plays_its_own_sound_at_its_own_pitch_bit_for_bit() {
    // Effects behind the voices are those of the whole kit.
    let behind = || PARAMS.iter().filter(|info| info.param.is_behind_voices());
    let is_plain = |preset: &&Preset| behind().all(|info| preset.patch.get(info.param) == info.default);
    let presets: Vec<&Preset> = Preset::factory().iter().filter(is_plain).collect();
    assert!(presets.len() >= KEYS);
    let patches: Vec<Patch> = (0..KEYS).map(|key| presets[key].patch.clone().with(Param::Limiter, 0.0)).collect();
    let pitch = |key: usize| (key * 37 % 128) as f64;
    let pads = (0..KEYS).map(|key| Some(Pad { pitch: Some(pitch(key)), ..Pad::of(key) })).collect();
    let mut all = synth(&kit(&patches, pads));
    let mut silent = 0;
    for (key, patch) in patches.iter().enumerate() {
        let strike = |key: u8| [Event::note_on(7, key, 0.8), Event::note_off(300, key), Event::note_on(400, key, 0.5)];
        let expected = play(&mut synth(&Kit::of_patch(patch)), &strike(pitch(key) as u8), 960);
        all.reset();
        assert!(play(&mut all, &strike(key as u8), 960) == expected, "key {key}");
        silent += usize::from(!sounds(&expected));
    }
    assert!(silent < 8, "{silent} keys are silent");
}

#[test]
fn a_kit_of_one_is_its_patch_bit_for_bit() {
    let events: Vec<Event> = (0..40_u32)
        .flat_map(|n| {
            let param = &PARAMS[(n as usize * 31) % PARAMS.len()];
            let at = |kind| event(n * 100, kind);
            [
                Event::note_on(n * 100, 40 + (n * 7 % 40) as u8, 0.7),
                at(EventKind::Param { param: param.param, value: param.denormalise(f64::from(n) / 40.0) }),
                at(EventKind::Modulate { id: None, param: param.param, offset: 0.01 * n as f32 }),
                at(EventKind::PitchBend(0.02 * n as f32)),
                Event::note_off(n * 100 + 50, 40 + (n * 7 % 40) as u8),
            ]
        })
        .collect();
    for name in ["Kick", "Snare", "Wine Glass", "Swell", "Sine Lead"] {
        let patch = factory(name);
        let mut by_patch = Synth::new(RATE, 1);
        by_patch.set_patch(&patch);
        let expected = play(&mut by_patch, &events, 4800);
        let single = kit(std::slice::from_ref(&patch), vec![Some(Pad::of(0)); KEYS]);
        assert!(sounds(&expected) && play(&mut synth(&single), &events, 4800) == expected, "{name}");
        // A second sound changes nothing as long as the parameters are the same.
        let poly = patch.with(Param::Mode, 0.0).with(Param::Voices, 64.0);
        let plain: Vec<Event> = events.iter().copied().filter(|event| !is_param(event)).collect();
        let several = kit(&[poly.clone(), factory("Gong")], vec![Some(Pad::of(0)); KEYS]);
        let expected = play(&mut synth(&Kit::of_patch(&poly)), &plain, 4800);
        assert!(play(&mut synth(&several), &plain, 4800) == expected, "{name} of several");
    }
}

fn is_param(event: &Event) -> bool {
    matches!(event.kind, EventKind::Param { .. } | EventKind::Modulate { .. })
}

#[test]
fn a_parameter_moves_each_sound_by_the_same_knob_travel() {
    let patches = [factory("Kick").with(Param::Gain, -12.0), factory("Clave").with(Param::Gain, -3.0)];
    let pads = on_keys(&[(36, Pad::of(0)), (37, Pad::of(1))]);
    let gain = Param::Gain.info();
    let set = |value| event(0, EventKind::Param { param: Param::Gain, value });
    for (key, patch) in (36..).zip(&patches) {
        let mut moved = patch.clone();
        let travel = gain.normalise(-20.0) - gain.normalise(gain.default);
        moved.set(Param::Gain, gain.denormalise(gain.normalise(patch.get(Param::Gain)) + travel));
        let mut kit = synth(&kit(&patches, pads.clone()));
        play(&mut kit, &[set(-20.0)], 4800);
        let mut alone = synth(&Kit::of_patch(&moved));
        play(&mut alone, &[], 4800);
        assert!(
            play(&mut kit, &[Event::note_on(0, key, 1.0)], 960)
                == play(&mut alone, &[Event::note_on(0, key, 1.0)], 960),
            "key {key}"
        );
        play(&mut kit, &[set(gain.default), event(0, EventKind::Silence { notes: Default::default() })], 9600);
        let mut alone = synth(&Kit::of_patch(patch));
        play(
            &mut alone,
            &[Event::note_on(0, key, 1.0), event(0, EventKind::Silence { notes: Default::default() })],
            14_400 + 960,
        );
        let [mut back, mut expected] =
            [&mut kit, &mut alone].map(|synth| play(synth, &[Event::note_on(0, key, 1.0)], 960));
        // Later notes of the seed have different noise, so only the level is compared, which is not random.
        let peak = |sides: &mut Sides| sides[0].iter().map(|bits| f32::from_bits(*bits).abs()).fold(0.0, f32::max);
        let (back, expected) = (peak(&mut back), peak(&mut expected));
        assert!((back / expected - 1.0).abs() < 0.05, "key {key}: {back} {expected}");
    }
    let mut kit = synth(&kit(&patches, pads));
    kit.handle(&event(0, EventKind::Param { param: Param::Voices, value: 1.0 }));
    play(&mut kit, &[Event::note_on(0, 36, 1.0), Event::note_on(10, 37, 1.0)], 100);
    assert_eq!(kit.voices_used(), 1, "the number of voices is the kit's");
}

#[test]
fn pads_have_their_gain_and_position() {
    let patch = Patch::default().with(Param::Limiter, 0.0);
    let pads = on_keys(&[
        (60, Pad::of(0)),
        (61, Pad { pitch: Some(60.0), gain_db: -6.0, ..Pad::of(0) }),
        (62, Pad { pitch: Some(60.0), pan: -1.0, ..Pad::of(0) }),
    ]);
    let kit = kit(&[patch], pads);
    let peaks = |key| {
        let sides = play(&mut synth(&kit), &[Event::note_on(0, key, 1.0)], 960);
        sides.map(|side| side.into_iter().map(|bits| f32::from_bits(bits).abs()).fold(0.0, f32::max))
    };
    let [plain, quiet, left] = [60, 61, 62].map(peaks);
    assert!((quiet[0] / plain[0] - 0.501_187).abs() < 1e-4, "{quiet:?}");
    assert!((left[0] / plain[0] - std::f32::consts::SQRT_2).abs() < 1e-4 && left[1] == 0.0, "{left:?}");
}

#[test]
fn a_key_without_a_pad_is_silent_and_its_note_ends_at_once() {
    let kit = kit(&[factory("Kick"), factory("Snare")], on_keys(&[(36, Pad::of(0)), (38, Pad::of(1))]));
    let mut synth = synth(&kit);
    assert!(!sounds(&play(&mut synth, &[Event::note_on(0, 37, 1.0)], 480)));
    assert_eq!(synth.ended().iter().map(|note| note.key).collect::<Vec<_>>(), [37]);
    assert!(synth.is_silent());
}

#[test]
fn a_sound_s_own_tuning_goes_before_that_of_the_instrument() {
    let tuning = Tuning::from_scala("\n2\n500.\n2/1", None).unwrap();
    let own = Tuning::from_scala("\n12\n50.\n100.\n200.\n300.\n400.\n500.\n600.\n700.\n800.\n900.\n1000.\n2/1", None)
        .unwrap();
    let patch = Patch::default();
    let sounds = vec![Arc::new(Sound::new(patch.clone()).tuned(Some(own))), Arc::new(Sound::new(patch.clone()))];
    let mixed = Arc::new(Kit::new(String::new(), sounds, on_keys(&[(61, Pad::of(0)), (62, Pad::of(1))])));
    let alone = |tuning: &Tuning, key| {
        let mut synth = synth(&Kit::of_patch(&patch));
        synth.set_tuning(tuning);
        play(&mut synth, &[Event::note_on(0, key, 1.0)], 960)
    };
    for (key, expected) in [(61, alone(&own, 61)), (62, alone(&tuning, 62))] {
        let mut synth = synth(&mixed);
        synth.set_tuning(&tuning);
        assert!(play(&mut synth, &[Event::note_on(0, key, 1.0)], 960) == expected, "key {key}");
    }
}

#[test]
fn pads_of_a_group_choke_each_other_across_keys_sounds_and_channels() {
    let long = Patch::default().with(Param::Decay, 5.0).with(Param::NoteOff, 1.0);
    let grouped = long.clone().with(Param::Choke, 3.0);
    let pad = |sound, choke| Pad { choke, ..Pad::of(sound) };
    let pads = on_keys(&[
        (50, pad(0, Some(3))),
        (51, pad(1, None)),
        (52, pad(1, Some(0))),
        (53, pad(0, None)),
        (54, pad(1, Some(4))),
    ]);
    let kit = kit(&[long, grouped], pads);
    for (first, second, chokes) in [
        (50, 51, true),
        (51, 50, true),
        (50, 52, false),
        (52, 51, false),
        (53, 50, false),
        (50, 54, false),
        (50, 55, false),
    ] {
        for channel in [0, 9] {
            let mut ensemble = Ensemble::of_kits(RATE, 1, &kit, vec![]);
            let events = [Event::note_on(0, first, 1.0), Event { channel, ..Event::note_on(2000, second, 1.0) }];
            let (mut left, mut right) = (vec![0.0; 9600], vec![0.0; 9600]);
            ensemble.process(&events, &mut left, &mut right);
            let voices = ensemble.snapshot().voices;
            let expected = 1 + u32::from(!chokes) - u32::from(second == 55);
            assert_eq!(voices, expected, "{first} then {second} on channel {channel}");
        }
    }
}

/// Notes on several keys and channels that ring on for long.
fn chord() -> Vec<Event> {
    (0..12).map(|n| Event { channel: (n % 3) as u8, ..Event::note_on(10 + 20 * n, 40 + 5 * n as u8, 0.8) }).collect()
}

fn swapped_kits() -> [Arc<Kit>; 3] {
    let first = kit(
        &[factory("Vibraphone"), factory("Wine Glass").with(Param::Vibrato, 30.0)],
        (0..KEYS).map(|key| Some(Pad::of(key % 2))).collect(),
    );
    // A change of the effects behind the voices would also change notes that still ring, so the drums have none here.
    let drums = KitPreset { params: vec![], ..drums().clone() }.kit();
    [first, drums, Preset::find("Church Bell").unwrap().kit()]
}

#[test]
fn what_rings_is_not_touched_by_another_kit() {
    let kits = swapped_kits();
    for (program, number) in kits.iter().zip(0_u8..) {
        let render = |events: &[Event]| {
            let mut ensemble = Ensemble::of_kits(RATE, 1, &kits[0], kits.to_vec());
            let (mut left, mut right) = (vec![0.0; 9600], vec![0.0; 9600]);
            ensemble.process(&chord(), &mut left, &mut right);
            ensemble.process(events, &mut left, &mut right);
            (left, right)
        };
        let untouched = render(&[]);
        assert!(untouched.0.iter().any(|sample| sample.abs() > 0.01));
        let changes: Vec<Event> = (0..300_u32)
            .map(|n| Event {
                channel: (n % 3) as u8,
                ..event(n * 31, EventKind::Program((number + (n % 2) as u8) % 3))
            })
            .collect();
        // The same bits: nothing is retuned and nothing clicks.
        assert!(render(&changes) == untouched, "to {}", program.name());
    }
}

#[test]
fn swaps_give_the_same_bits_in_any_blocks() {
    let kits = swapped_kits();
    let events: Vec<Event> = (0..200_u32)
        .flat_map(|n| {
            let (frame, channel) = (n * 47, (n % 4) as u8);
            let kind = EventKind::Program((n / 4 % 3) as u8);
            [
                Event { channel, ..event(frame, kind) },
                Event { channel, ..Event::note_on(frame, 35 + (n * 7 % 30) as u8, 0.6) },
                Event {
                    channel,
                    ..event(frame + 9, EventKind::Param { param: Param::Decay, value: 0.2 + 0.01 * n as f32 })
                },
            ]
        })
        .collect();
    let render = |block: usize| {
        let mut ensemble = Ensemble::of_kits(RATE, 1, &kits[0], kits.to_vec()).with_chunk(block.min(500));
        let (mut left, mut right) = (vec![0.0; 9600], vec![0.0; 9600]);
        for start in (0..9600).step_by(block) {
            let end = 9600.min(start + block);
            let here = events.iter().filter(|event| (start..end).contains(&(event.frame as usize)));
            let here: Vec<Event> = here.map(|event| Event { frame: event.frame - start as u32, ..*event }).collect();
            ensemble.process(&here, &mut left[start..end], &mut right[start..end]);
        }
        [left, right].map(|side| side.into_iter().map(f32::to_bits).collect::<Vec<u32>>())
    };
    let whole = render(9600);
    assert!(sounds(&whole));
    for block in [1, 7, 64, 480, 1000] {
        assert!(render(block) == whole, "blocks of {block}");
    }
}

#[test]
fn the_drums_all_sound_and_their_hats_choke_each_other() {
    let preset = drums();
    assert!(preset.pads.len() > 15);
    let kit = preset.kit();
    for (key, pad) in &preset.pads {
        let sides = play(&mut synth(&kit), &[Event::note_on(0, *key, 1.0)], 4800);
        assert!(sounds(&sides), "{}", pad.name);
    }
    let mut hats = synth(&kit);
    play(&mut hats, &[Event::note_on(0, 46, 1.0), Event::note_off(100, 46), Event::note_on(4800, 42, 1.0)], 9600);
    assert_eq!(hats.ended().iter().map(|note| note.key).collect::<Vec<_>>(), [46]);
}
