//! State: everything is restored, and if nothing has changed, the same bytes are saved.

use crate::host::reference::{At, assert_same_bits, render};
use crate::host::{Address, Instance, Player, Sent, Timed};
use crate::patches::{drums, load, own_part, patch_in, patches, state, state_of_kit, state_of_text};
use crate::process::{Stops, wait_until};
use crate::thorough;
use clack_host::prelude::EventBuffer;
use sprung::engine::{EventKind, NoteId};
use sprung::internals::random::{key, uniform};
use sprung::params::PARAMS;
use sprung::patch::Patch;
use sprung::preset::{Playable, Preset};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

pub(crate) const RATE: f64 = 48_000.0;
pub(crate) const FRAMES: usize = 9_600;

pub(crate) fn strike() -> (Vec<Timed>, Vec<At>) {
    let (note, velocity) = (Address::note(0, 57, 1), 0.8_f32);
    (
        vec![Sent::On(note, velocity.into()).at(3)],
        vec![At(3, 0, EventKind::NoteOn { key: 57, detune: 0.0, velocity, id: NoteId::new(1) })],
    )
}

/// Sets every knob to some position, as automation or a user would.
fn scramble(instance: &mut Instance, seed: u64) {
    let stream = key(seed, 0);
    let changes: Vec<Timed> = instance
        .parameters()
        .iter()
        .zip(0..)
        .map(|(parameter, n)| {
            let position = f64::from(uniform(stream, n) + 1.0) / 2.0;
            let value = if parameter.max > 1.0 { (position * parameter.max).round() } else { position };
            Sent::Value(parameter.id, value).at(0)
        })
        .collect();
    instance.flush(&changes);
}

pub(crate) fn values(instance: &mut Instance) -> Vec<f64> {
    let parameters = instance.parameters();
    parameters.iter().map(|parameter| instance.value(parameter.id).unwrap()).collect()
}

pub(crate) fn what_is_saved_comes_back_to_the_byte() {
    for seed in (0..).take(thorough::of(4, 20)) {
        let mut first = Instance::new();
        scramble(&mut first, seed);
        let (saved, set) = (first.save(), values(&mut first));
        assert_eq!(first.save(), saved, "saved twice");
        let mut second = Instance::new();
        second.rescans();
        assert!(second.load(&saved));
        assert!(second.rescans() > 0, "the host is told to ask for the values");
        assert_eq!(values(&mut second), set, "values in scramble {seed}");
        assert_eq!(second.save(), saved, "scramble {seed}");
        assert!(second.load(&saved), "loaded again");
        assert_eq!(second.save(), saved, "scramble {seed}, loaded twice");
    }
}

/// A flush without processing, processing, and loading before and after activation all give the same state.
pub(crate) fn every_way_to_set_values_leaves_the_same_state() {
    for seed in 0..4 {
        let mut flushed = Instance::new();
        scramble(&mut flushed, seed);
        let expected = flushed.save();
        let parameters = flushed.parameters();
        let song: Vec<Timed> = parameters
            .iter()
            .map(|parameter| Sent::Value(parameter.id, flushed.value(parameter.id).unwrap()).at(31))
            .collect();
        let mut player = Instance::new().play(RATE, 64);
        player.render(&song, 64, || 64);
        assert_eq!(player.instance.save(), expected, "set while processing");
        let mut player = Instance::new().play(RATE, 64);
        player.render(&[], 64, || 64);
        assert!(player.instance.load(&expected));
        assert_eq!(player.instance.save(), expected, "loaded while active, before the next block");
        player.render(&[], 64, || 64);
        assert_eq!(player.stop().save(), expected, "loaded while active");
    }
}

pub(crate) fn modulation_is_not_saved() {
    let mut instance = Instance::new();
    let before = instance.save();
    let parameters = instance.parameters();
    let song: Vec<Timed> = parameters
        .iter()
        .map(|parameter| Sent::Modulate(parameter.id, Address::id(-1), 0.25 * parameter.max).at(0))
        .collect();
    let mut player = instance.play(RATE, 64);
    player.render(&song, 64, || 64);
    assert_eq!(player.instance.save(), before);
}

/// Modulation holds knobs at the ends of their ranges, but a loaded state still sets the knobs themselves.
pub(crate) fn a_state_loaded_while_all_is_modulated_is_what_is_saved() {
    let parameters = Instance::new().parameters();
    for amount in [1.0, -1.0] {
        let song: Vec<Timed> =
            parameters.iter().map(|p| Sent::Modulate(p.id, Address::id(-1), amount * p.max).at(0)).collect();
        let mut player = Instance::new().play(RATE, 64);
        player.render(&song, 64, || 64);
        for (name, patch) in patches() {
            let what = format!("{name}, modulated by {amount}");
            assert!(player.instance.load(&state(&patch)));
            assert!(patch_in(&player.instance.save()) == patch, "{what}");
            player.render(&[], 64, || 64);
            assert!(patch_in(&player.instance.save()) == patch, "{what}, a block later");
        }
    }
}

/// A state that is loaded while audio runs is used exactly by the next note.
pub(crate) fn a_state_loaded_while_processing_is_heard_exactly() {
    for (name, patch) in patches() {
        let mut player = Instance::new().play(RATE, 480);
        player.render(&[Sent::On(Address::note(0, 60, 1), 0.5).at(0)], 960, || 480);
        load(&mut player.instance, &patch);
        player.render(&[], 480, || 480);
        assert_eq!(patch_in(&player.instance.save()), patch, "{name}");
        player.audio.reset();
        let (sent, events) = strike();
        let found = player.render(&sent, FRAMES, || 480).channels;
        assert_same_bits(name, &found, &render(&patch, RATE, &events, FRAMES));
    }
}

/// Setting a parameter to its present position keeps its exact value.
pub(crate) fn touching_a_knob_keeps_the_exact_value() {
    for (name, patch) in patches() {
        let mut instance = Instance::new();
        load(&mut instance, &patch);
        let parameters = instance.parameters();
        let same: Vec<Timed> =
            parameters.iter().map(|p| Sent::Value(p.id, instance.value(p.id).unwrap()).at(0)).collect();
        instance.flush(&same);
        assert_eq!(patch_in(&instance.save()), patch, "{name}");
    }
}

pub(crate) fn streams_may_deliver_a_byte_at_a_time() {
    let mut source = Instance::new();
    scramble(&mut source, 3);
    let saved = source.save();
    for piece in [1, 2, 7, 8, 9, 17, 4096] {
        let mut instance = Instance::new();
        assert!(instance.load_in_pieces(&saved, piece), "{piece} bytes at a time");
        assert_eq!(instance.save(), saved, "{piece} bytes at a time");
    }
}

/// A project with a kit is restored byte for byte, also with a changed knob.
pub(crate) fn a_kit_comes_back_with_its_presets() {
    let mut first = Instance::new();
    assert!(first.load(&state_of_kit(&drums())));
    let saved = first.save();
    let Playable::Kit(kit) = drums() else { panic!("a kit") };
    assert_eq!(own_part(&saved)["kit"].as_str(), Some(kit.to_whole_toml().as_str()));
    scramble(&mut first, 7);
    for saved in [saved, first.save()] {
        let mut second = Instance::new();
        assert!(second.load(&saved));
        assert_eq!(second.save(), saved);
    }
}

/// States of every released version still load as the same patch.
pub(crate) fn states_of_all_versions_load() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/states");
    let mut versions = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "json") {
            continue;
        }
        versions += 1;
        let json = std::fs::read(&path).unwrap();
        let bytes = [&(json.len() as u64).to_le_bytes()[..], &json].concat();
        let preset = std::fs::read_to_string(path.with_extension("toml")).expect("each lies beside its preset");
        let expected = Preset::parse(&preset, "the preset").unwrap().patch;
        let mut instance = Instance::new();
        assert!(instance.load(&bytes), "{}", path.display());
        assert_eq!(patch_in(&instance.save()), expected, "{}", path.display());
        assert_ne!(expected, Patch::default(), "{}: it would not show if nothing was loaded", path.display());
    }
    assert!(versions > 0, "{}: no states", folder.display());
}

/// A parameter that an older version did not have is set to its default, whatever its value was before.
pub(crate) fn parameters_that_a_state_lacks_have_their_defaults() {
    let mut instance = Instance::new();
    scramble(&mut instance, 1);
    assert!(instance.load(&state_of_text("format = 1\nname = \"Old\"\n\n[params]\ndecay = 2.5\n")));
    let patch = patch_in(&instance.save());
    for info in PARAMS {
        let expected = if info.id == "decay" { 2.5 } else { info.default };
        assert_eq!(patch.get(info.param), expected, "{}", info.id);
    }
}

/// Saves and loads on another thread than the one that plays.
pub(crate) fn two_states_in_turn_while_audio_runs_are_never_mixed() {
    let patches = patches();
    let states = [state(&patches[0].1), state(&patches[1].1)];
    let Player { mut instance, mut audio } = Instance::new().play(RATE, 64);
    let (stop, played) = (AtomicBool::new(false), AtomicU32::new(0));
    let audio = std::thread::scope(|scope| {
        let stops = Stops(&stop);
        let playing = scope.spawn(|| {
            let mut events = EventBuffer::new();
            while !stop.load(Ordering::Relaxed) {
                let block = played.load(Ordering::Relaxed);
                events.clear();
                Sent::On(Address::note(0, 60, (block % 1_000) as i32), 0.5).push(0, &mut events);
                audio.process(&events, 64);
                played.store(block + 1, Ordering::Relaxed);
            }
            audio
        });
        // Loads happen before, during and after blocks: several between two blocks, and several blocks between two
        // loads.
        for round in (0..).take(thorough::of(200, 1_000)) {
            let until = played.load(Ordering::Relaxed) + round % 3;
            wait_until("a block", || playing.is_finished() || played.load(Ordering::Relaxed) >= until);
            let (name, expected) = &patches[round as usize % 2];
            assert!(instance.load(&states[round as usize % 2]), "round {round}, {name}");
            assert!(patch_in(&instance.save()) == *expected, "round {round}: not {name} alone");
        }
        drop(stops);
        playing.join().unwrap()
    });
    // The state that was loaded last is the one that sounds in the end.
    let mut player = Player { instance, audio };
    player.render(&[], 64, || 64);
    player.audio.reset();
    let (sent, events) = strike();
    let found = player.render(&sent, FRAMES, || 64).channels;
    assert_same_bits("the last state", &found, &render(&patches[1].1, RATE, &events, FRAMES));
}
