//! Notes as CLAP hosts send them: each ends once; addressed by id, key, channel or wildcards; choked; stray.

use crate::host::reference::{assert_clean, assert_sound};
use crate::host::{Address, Ended, Instance, Player, Sent, Timed};
use crate::patches::load;
use sprung::params::Param;
use sprung::patch::Patch;
use std::collections::BTreeMap;

const RATE: f64 = 48_000.0;

fn patch() -> Patch {
    Patch::default().with(Param::Decay, 0.3).with(Param::Release, 0.05)
}

fn player(patch: &Patch) -> Player {
    let mut instance = Instance::new();
    load(&mut instance, patch);
    instance.play(RATE, 512)
}

fn ended(patch: &Patch, song: &[Timed], frames: usize) -> Vec<Ended> {
    let rendered = player(patch).render(song, frames, || 480);
    assert_clean("notes", &rendered.channels);
    rendered.ended
}

/// How often each note was reported as ended.
fn counts(ended: &[Ended]) -> BTreeMap<Address, usize> {
    ended.iter().fold(BTreeMap::new(), |mut counts, end| {
        *counts.entry(end.note).or_default() += 1;
        counts
    })
}

pub(crate) fn a_note_ends_when_its_sound_does() {
    let note = Address::note(3, 60, 17);
    for (frame, release) in [(0, None), (101, Some(4_000)), (479, Some(480)), (480, Some(4_801))] {
        let mut song = vec![Sent::On(note, 0.8).at(frame)];
        song.extend(release.map(|release| Sent::Off(note, 0.5).at(release)));
        let rendered = player(&patch()).render(&song, 96_000, || 480);
        assert_sound("one note", &rendered.channels);
        let [end] = rendered.ended[..] else { panic!("{:?}", rendered.ended) };
        assert_eq!(end.note, note);
        let last = rendered.channels[0].iter().rposition(|sample| *sample != 0.0).unwrap() as u64;
        // The engine frees a voice at the control tick after its last sample, and the plugin reports it within the
        // block.
        assert!((last..last + 64 + 480).contains(&end.frame), "ended at {}, last sample at {last}", end.frame);
    }
}

pub(crate) fn every_note_ends_once_also_when_stolen_or_struck_again() {
    for (what, patch) in [
        ("poly", patch().with(Param::Voices, 4.0)),
        ("mono", patch().with(Param::Mode, 1.0)),
        ("legato", patch().with(Param::Mode, 2.0)),
        ("choke group", patch().with(Param::Choke, 1.0)),
    ] {
        let mut song = Vec::new();
        let notes: Vec<Address> =
            (0..40).map(|n| Address::note((n % 3) as i16, 50 + (n % 7) as i16, 100 + n)).collect();
        for (note, at) in notes.iter().zip((0..).step_by(331)) {
            song.push(Sent::On(*note, 0.7).at(at));
            song.push(Sent::Off(*note, 0.5).at(at + 700));
        }
        song.sort_by_key(|timed| timed.frame);
        let counts = counts(&ended(&patch, &song, 96_000));
        for note in &notes {
            assert_eq!(counts.get(note), Some(&1), "{what}: {note:?}");
        }
        assert_eq!(counts.len(), notes.len(), "{what}: no others end");
    }
}

/// In mono, one of the held keys sounds. After a change to poly, the others have no voice, and still end exactly once.
pub(crate) fn held_notes_end_once_when_mono_becomes_poly() {
    let notes = [Address::note(0, 60, 1), Address::note(0, 64, 2), Address::note(0, 67, 3)];
    let mode = Instance::new().id(Param::Mode);
    for solo in [1.0, 2.0] {
        let patch = patch().with(Param::Mode, solo);
        for at in [4_800, 4_801, 5_000] {
            for are_released in [true, false] {
                let mut song: Vec<Timed> =
                    notes.iter().zip((10..).step_by(1_000)).map(|(note, at)| Sent::On(*note, 0.8).at(at)).collect();
                song.push(Sent::Value(mode, 0.0).at(at));
                song.extend(notes.iter().filter(|_| are_released).map(|note| Sent::Off(*note, 0.5).at(9_000)));
                let counts = counts(&ended(&patch, &song, 96_000));
                let what = format!("from mode {solo} at {at}, released: {are_released}");
                assert_eq!(counts, notes.map(|note| (note, 1)).into(), "{what}");
            }
        }
    }
}

pub(crate) fn a_stolen_note_ends_when_it_is_stolen() {
    let patch = patch().with(Param::Voices, 1.0).with(Param::Decay, 20.0);
    let (first, second) = (Address::note(0, 60, 1), Address::note(0, 67, 2));
    let song = [Sent::On(first, 1.0).at(10), Sent::On(second, 1.0).at(5_000)];
    let ended = ended(&patch, &song, 9_600);
    let [end] = ended[..] else { panic!("{ended:?}") };
    assert_eq!(end.note, first);
    assert!((5_000..5_000 + 4_800).contains(&end.frame), "{end:?}");
}

pub(crate) fn notes_are_found_by_id_key_channel_or_not_at_all() {
    // A decay of 16 s rings on unless the note is released, so a note that ends within 2 s was found by its address.
    let patch = patch().with(Param::Decay, 16.0);
    let notes = [Address::note(0, 60, 1), Address::note(0, 64, 2), Address::note(1, 60, 3), Address::note(1, 67, 4)];
    let any = |channel, key, id| Address { channel, key, id };
    for (wanted, found) in [
        (any(-1, -1, 3), vec![3]),
        (any(0, 60, 1), vec![1]),
        (any(0, 60, -1), vec![1]),
        (any(-1, 60, -1), vec![1, 3]),
        (any(1, -1, -1), vec![3, 4]),
        (any(-1, -1, -1), vec![1, 2, 3, 4]),
        (any(0, 60, 2), vec![]),
        (any(5, -1, -1), vec![]),
        (any(-1, -1, 99), vec![]),
    ] {
        for by in [Sent::Off(wanted, 0.5), Sent::Choke(wanted)] {
            let mut song: Vec<Timed> = notes.iter().map(|note| Sent::On(*note, 0.9).at(5)).collect();
            song.push(by.at(4_000));
            let mut ids: Vec<i32> = ended(&patch, &song, 96_000).iter().map(|end| end.note.id).collect();
            ids.sort_unstable();
            assert_eq!(ids, found, "{by:?}");
        }
    }
}

pub(crate) fn a_choke_silences_within_a_fade() {
    let patch = patch().with(Param::Decay, 20.0).with(Param::Release, 20.0);
    let note = Address::note(0, 60, 1);
    let rendered = player(&patch).render(&[Sent::On(note, 1.0).at(0), Sent::Choke(note).at(4_800)], 9_600, || 480);
    assert_sound("a note that is choked", &rendered.channels);
    let after = &rendered.channels[0][4_800 + 960..];
    assert!(after.iter().all(|sample| *sample == 0.0), "20 ms after a choke nothing sounds");
    assert_eq!(rendered.ended.len(), 1);
}

/// Note-off without note-on, two note-ons, on and off at one frame, expressions for notes that do not exist.
pub(crate) fn stray_events_do_no_harm() {
    use clack_host::events::event_types::NoteExpressionType as Kind;
    let mut song = vec![
        Sent::Off(Address::note(0, 60, 5), 0.5).at(0),
        Sent::Choke(Address::note(0, 60, 5)).at(0),
        Sent::Express(Address::note(0, 60, 5), Kind::Tuning, 3.0).at(0),
        Sent::On(Address::note(0, 60, 6), 0.5).at(100),
        Sent::On(Address::note(0, 60, 6), 0.5).at(100),
        Sent::Off(Address::note(0, 60, 6), 0.5).at(100),
        Sent::Off(Address::note(0, 60, 6), 0.5).at(100),
        Sent::Midi2([0x4090_3C00, 0xFFFF_0000, 0, 0]).at(101),
        Sent::Midi([0xF8, 0, 0]).at(101),
        Sent::Midi([0x00, 0x3C, 0x40]).at(101),
        Sent::On(Address { channel: -1, key: 62, id: 7 }, 0.5).at(102),
        Sent::On(Address { channel: 0, key: -1, id: 8 }, 0.5).at(102),
        Sent::On(Address { channel: 99, key: 300, id: -7 }, 0.5).at(102),
    ];
    for velocity in [0.0, -1.0, 2.0, f64::NAN, f64::INFINITY] {
        song.push(Sent::On(Address::note(2, 70, 9), velocity).at(200));
        song.push(Sent::Off(Address::note(2, 70, 9), velocity).at(300));
        for kind in [Kind::Tuning, Kind::Volume, Kind::Pan, Kind::Pressure, Kind::Brightness, Kind::Vibrato] {
            song.push(Sent::Express(Address::id(-1), kind, velocity * 1e9).at(310));
        }
    }
    song.sort_by_key(|timed| timed.frame);
    let rendered = player(&patch()).render(&song, 48_000, || 64);
    assert_sound("stray events", &rendered.channels);
    assert!(rendered.channels.iter().flatten().all(|sample| sample.abs() < 8.0));
}

/// A block with more notes than the event queue holds sounds the same as small blocks.
pub(crate) fn a_flood_of_events_loses_none() {
    let song: Vec<Timed> = (0..12_000_u64)
        .map(|n| {
            let note = Address::note((n % 16) as i16, 30 + (n / 2 % 60) as i16, n as i32 / 2);
            let sent = if n % 2 == 0 { Sent::On(note, 0.3) } else { Sent::Off(note, 0.5) };
            sent.at(n / 30)
        })
        .collect();
    let whole = player(&patch()).render(&song, 4_800, || 480);
    let parts = player(&patch()).render(&song, 4_800, || 1);
    assert_sound("a flood", &whole.channels);
    crate::host::reference::assert_same_bits("a flood", &whole.channels, &parts.channels);
    assert_eq!(counts(&whole.ended), counts(&parts.ended));
}
