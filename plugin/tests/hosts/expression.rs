//! Changes of single notes by a host: modulation per voice, note expressions, MPE per channel; and the tempo.

use crate::automation::{compare, compare_one, on, patch, player};
use crate::host::reference::At;
use crate::host::{Address, Instance, Sent};
use crate::parameters::is_stepped;
use clack_host::events::event_types::NoteExpressionType as Kind;
use sprung::engine::{EventKind, Expression, NoteId, Notes};
use sprung::params::{Change, PARAMS, Param};
use sprung::patch::routes::Source;

pub(crate) fn modulation_moves_one_voice_or_all() {
    let mut player = player();
    for info in PARAMS.iter().filter(|info| matches!(info.change, Change::Smoothed(_))) {
        let id = player.instance.id(info.param);
        // Hosts count amounts like values: for a stepped parameter, in steps.
        let travel = if is_stepped(info) { f64::from(info.max - info.min) } else { 1.0 };
        let amount = |note: i32, frame: u64, offset: f32| {
            let kind = EventKind::Modulate { id: NoteId::new(note), param: info.param, offset };
            (Sent::Modulate(id, Address::id(note), f64::from(offset) * travel).at(frame), At(frame, 0, kind))
        };
        let song = [
            on(0, 0, 60, 1, 0.9),
            on(1, 0, 64, 2, 0.8),
            amount(1, 500, 0.125),
            amount(2, 801, -0.25),
            amount(1, 2_001, -0.0625),
            amount(99, 2_500, 0.5),
            on(5_000, 0, 67, 3, 0.6),
            amount(3, 5_001, 0.125),
        ];
        compare_one(&mut player, info.param, &format!("voices' {}", info.id), &patch(), &song);
        // The wrapper adds modulation of the whole instrument to the knob's position, in single precision.
        let position = info.normalise(patch().get(info.param)) as f32;
        let everyone = |frame: u64, offset: f32| {
            let offset_there = (position + offset).clamp(0.0, 1.0) - position;
            let kind = EventKind::Modulate { id: None, param: info.param, offset: offset_there };
            (Sent::Modulate(id, Address::id(-1), f64::from(offset) * travel).at(frame), At(frame, 0, kind))
        };
        let all = [on(0, 0, 60, 1, 0.9), everyone(700, 0.125), on(900, 0, 64, 2, 0.8), everyone(3_000, 0.0)];
        compare_one(&mut player, info.param, &format!("everyone's {}", info.id), &patch(), &all);
    }
}

/// Hosts without note ids, and modulators of keys and channels.
pub(crate) fn modulation_moves_the_notes_of_a_key_or_a_channel() {
    let mut instance = Instance::new();
    for param in [Param::Tune, Param::Decay, Param::Gain] {
        let id = instance.id(param);
        let by = |frame: u64, channel: i16, key: i16, offset: f32| {
            let given = |number: i16| u8::try_from(number).ok();
            let notes = Notes { id: None, channel: given(channel), key: given(key) };
            let kind = EventKind::ModulateNotes { notes, param, offset };
            (Sent::Modulate(id, Address::key(channel, key), f64::from(offset)).at(frame), At(frame, 0, kind))
        };
        let song = [
            on(0, 0, 60, 1, 0.9),
            on(1, 3, 64, 2, 0.8),
            on(2, 3, 60, -1, 0.7),
            by(500, -1, 60, 0.125),
            by(500, 3, -1, -0.0625),
            by(2_001, 3, 60, 0.0625),
            by(2_001, 0, 61, 0.5),
            on(5_000, 0, 60, 3, 0.6),
            by(5_001, 0, 60, 0.25),
        ];
        let moved = compare(&format!("{param:?} by key"), &patch(), &song);
        let unmoved: Vec<_> =
            song.into_iter().filter(|(_, At(_, _, kind))| matches!(kind, EventKind::NoteOn { .. })).collect();
        assert!(moved != compare("without", &patch(), &unmoved), "{param:?} is heard");
    }
}

pub(crate) fn expressions_reach_their_notes() {
    let note = |channel: u8, key: u8, id: i32| {
        (
            Address::note(channel.into(), key.into(), id),
            Notes { id: NoteId::new(id), channel: Some(channel), key: Some(key) },
        )
    };
    let whole = (Address::id(-1), Notes::default());
    let by_key = (Address::key(-1, 64), Notes { key: Some(64), ..Notes::default() });
    for (kind, expression, values) in [
        (Kind::Tuning, Expression::Tuning, [7.0, -0.5, 12.25]),
        (Kind::Volume, Expression::Volume, [0.5, 2.0, 0.0]),
        (Kind::Pan, Expression::Pan, [0.25, 1.0, 0.5]),
        (Kind::Pressure, Expression::Pressure, [0.5, 1.0, 0.0]),
        (Kind::Brightness, Expression::Brightness, [0.75, 0.0, 0.5]),
        (Kind::Vibrato, Expression::Vibrato, [0.5, 1.0, 0.0]),
        (Kind::Expression, Expression::Swell, [0.5, 0.25, 1.0]),
    ] {
        let express = |(address, notes): (Address, Notes), frame: u64, value: f64| {
            // CLAP's pan is from 0 to 1.
            let given = if kind == Kind::Pan { value as f32 * 2.0 - 1.0 } else { value as f32 };
            let event = EventKind::Express { notes, expression, value: given };
            (Sent::Express(address, kind, value).at(frame), At(frame, 0, event))
        };
        let song = [
            on(0, 0, 60, 1, 0.9),
            on(0, 1, 64, 2, 0.8),
            express(note(0, 60, 1), 0, values[0]),
            express(note(1, 64, 2), 1_003, values[1]),
            express(by_key, 2_001, values[2]),
            express(note(5, 60, 1), 2_500, values[1]),
            on(3_000, 0, 67, 3, 0.6),
            express(whole, 4_001, values[0]),
        ];
        let patch = patch().with_route(0, Source::Pressure, Param::Vibrato, 6.67).with_route(
            1,
            Source::Pressure,
            Param::Damper,
            30.0,
        );
        compare(&format!("{kind:?}"), &patch, &song);
    }
}

/// MPE as MIDI: one channel per note, each with its own bend, pressure and timbre. The main channel affects all notes.
pub(crate) fn mpe_is_heard_by_channel() {
    let midi = |frame: u64, data: [u8; 3]| {
        let (channel, kind) = sprung::engine::midi::parse_message(&data).unwrap();
        (Sent::Midi(data).at(frame), At(frame, channel, kind))
    };
    // The MPE configuration message: from now on, the first channel controls the other fifteen.
    let mut song = vec![midi(0, [0xB0, 101, 0]), midi(0, [0xB0, 100, 6]), midi(0, [0xB0, 6, 15])];
    for (channel, key) in [(1_u8, 60_u8), (2, 64), (3, 67)] {
        let at = u64::from(channel) * 100;
        song.extend([
            midi(at, [0xB0 | channel, 101, 0]),
            midi(at, [0xB0 | channel, 100, 0]),
            midi(at, [0xB0 | channel, 6, 48]),
            midi(at, [0xE0 | channel, 0, 64]),
            midi(at, [0x90 | channel, key, 100]),
            midi(at + 1_000, [0xE0 | channel, 7 * channel, 64 + channel]),
            midi(at + 1_001, [0xD0 | channel, 30 * channel, 0]),
            midi(at + 2_000, [0xB0 | channel, 74, 20 * channel]),
            midi(at + 5_000, [0x80 | channel, key, 70]),
        ]);
    }
    let patch = patch().with_route(0, Source::Pressure, Param::Vibrato, 7.5);
    let (bend, pedal) = (midi(3_333, [0xE0, 0, 70]), midi(4_444, [0xB0, 64, 127]));
    let [members, bent, held, both] = [vec![], vec![bend], vec![pedal], vec![bend, pedal]].map(|main| {
        let mut song = [&song[..], &main].concat();
        song.sort_by_key(|(sent, _)| sent.frame);
        compare("MPE", &patch, &song)
    });
    assert!(bent != members, "the main channel's bend moves all notes");
    assert!(held != members, "the main channel's pedal holds all notes");
    assert!(both != bent && both != held, "bend and pedal");
}

/// A vibrato in time with the song: another tempo sounds different, from its frame on.
pub(crate) fn the_tempo_is_handed_on() {
    let patch = patch().with(Param::Vibrato, 80.0).with(Param::VibratoSync, 4.0);
    let sound = |first: f64, second: f64| {
        let tempo =
            |frame: u64, tempo: f64| (Sent::Tempo(tempo).at(frame), At(frame, 0, EventKind::Tempo(tempo as f32)));
        let song = [tempo(0, first), on(3, 0, 60, 1, 0.9), tempo(3_001, second), on(4_000, 0, 64, 2, 0.9)];
        compare(&format!("{first} and {second} beats a minute"), &patch, &song)
    };
    let steady = sound(140.5, 140.5);
    assert!(sound(90.0, 140.5)[0][..3_000] != steady[0][..3_000], "the first tempo is heard");
    let slower = sound(140.5, 30.25);
    assert!(slower[0][..3_000] == steady[0][..3_000], "nothing changes before the second tempo");
    assert!(slower[0][3_000..] != steady[0][3_000..], "the second tempo is heard");
}
