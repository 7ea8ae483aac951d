//! The calls that the manager makes to its voices, logged by fake voices.

mod fake;

use super::*;
use crate::engine::note::{NoteId, Notes};
use crate::sound::tuning::Pitch;
use fake::{FakeInstrument, FakeVoice, Log};

enum Do {
    On(u8, f32),
    /// Key and choke group.
    OnChoke(u8, u8),
    OnPatch(u8, u32),
    /// The instrument changes its patch.
    Patch(u32),
    /// Key, choke group and patch.
    OnChokePatch(u8, u8, u32),
    Off(u8),
    OffId(u8, i32),
    Sustain(bool),
    Sostenuto(bool),
    NotesOff,
    SoundOff,
    Over(u8),
}
use Do::*;

/// Plays a script and returns the calls that the voices received.
fn play(polyphony: usize, mode: PlayMode, script: &[Do]) -> Vec<String> {
    play_with(polyphony, mode, Priority::Last, 1, script).0
}

/// As [`play`]; also returns the keys of the ended notes, in order of their ends.
fn play_with(
    polyphony: usize,
    mode: PlayMode,
    priority: Priority,
    unison: usize,
    script: &[Do],
) -> (Vec<String>, Vec<u8>) {
    let log = Log::default();
    let voice = || FakeVoice::new(&log);
    let capacity = Footprint { voices: 200, cells: 400 };
    let mut manager = VoiceManager::new(VoicePool::full(capacity, voice, || ()));
    let mut instrument = FakeInstrument { patch: 0, unison };
    manager.configure(polyphony, mode, priority, 0);
    for (serial, action) in script.iter().enumerate() {
        let is_legato = manager.has_key_down();
        let on = |key, velocity, choke, patch| Note {
            channel: 0,
            key,
            pitch: Pitch::Semitones(key.into()),
            detune: 0.0,
            velocity,
            soft: false,
            output: 0,
            brightness: 0.0,
            id: NoteId::new(i32::from(key) + 1000),
            serial: serial as u64,
            patch,
            body: patch,
            choke,
            gain: 1.0,
            pan: 0.0,
            is_legato,
            glide: None,
            contact: None,
        };
        if let OnPatch(_, patch) | OnChokePatch(_, _, patch) | Patch(patch) = *action {
            instrument.patch = patch;
            manager.configure(polyphony, mode, priority, patch);
        }
        let patch = instrument.patch;
        match *action {
            Patch(_) => {}
            On(key, velocity) => _ = manager.note_on(&instrument, on(key, velocity, 0, patch)),
            OnChoke(key, group) => _ = manager.note_on(&instrument, on(key, 1.0, group, patch)),
            OnChokePatch(key, group, _) => _ = manager.note_on(&instrument, on(key, 1.0, group, patch)),
            OnPatch(key, _) => _ = manager.note_on(&instrument, on(key, 1.0, 0, patch)),
            Off(key) => manager.note_off(&instrument, Notes::on(0, key), 0.25),
            OffId(key, id) => manager.note_off(&instrument, Notes { id: NoteId::new(id), ..Notes::on(0, key) }, 0.25),
            Sustain(down) => manager.sustain(0, f32::from(down)),
            Sostenuto(down) => manager.sostenuto(0, down),
            NotesOff => manager.all_notes_off(0),
            SoundOff => manager.all_sound_off(0),
            Over(key) => {
                let voices = manager.active().filter(|(note, _)| note.key == key);
                voices.for_each(|(_, voice)| voice.over = true);
                manager.free_finished();
            }
        }
    }
    (log.take(), manager.ended().iter().map(|note| note.key).collect())
}

#[track_caller]
fn check(polyphony: usize, mode: PlayMode, script: &[Do], expected: &[&str]) {
    assert_eq!(play(polyphony, mode, script), expected);
}

#[test]
fn a_second_strike_on_a_sounding_key_joins_it() {
    let script = [On(60, 1.0), On(60, 1.0), Off(60), On(60, 1.0), Over(60), On(60, 1.0)];
    let expected = ["start 60", "restrike 60 as 60", "release 60 at 0.25", "restrike 60 as 60", "start 60"];
    check(16, PlayMode::Poly, &script, &expected);
}

#[test]
fn notes_of_another_patch_do_not_share_a_voice() {
    check(16, PlayMode::Poly, &[OnPatch(60, 0), OnPatch(60, 1)], &["start 60", "start 60"]);
    check(16, PlayMode::Mono, &[OnPatch(60, 0), OnPatch(62, 1)], &["start 60", "fade 60", "start 62"]);
}

#[test]
fn stealing_takes_the_same_key_then_the_quietest_then_the_oldest() {
    check(
        2,
        PlayMode::Poly,
        &[On(60, 0.9), On(61, 0.2), On(62, 0.5)],
        &["start 60", "start 61", "fade 61", "start 62"],
    );
    check(
        2,
        PlayMode::Poly,
        &[On(60, 0.5), On(61, 0.5), On(62, 0.5)],
        &["start 60", "start 61", "fade 60", "start 62"],
    );
    check(
        2,
        PlayMode::Poly,
        &[OnPatch(60, 0), On(61, 0.1), OnPatch(60, 1)],
        &["start 60", "start 61", "fade 60", "start 60"],
    );
}

#[test]
fn more_steals_than_spare_voices_cut_the_oldest_and_go_on() {
    // There are 128 slots, so each note after the 128th cuts off a fading one.
    let script: Vec<_> = (0..200).map(|n| On(n % 128, 1.0)).collect();
    let told = play(1, PlayMode::Poly, &script);
    assert_eq!(told.iter().filter(|line| line.starts_with("start")).count(), 200);
}

#[test]
fn choke_groups_silence_their_own_and_no_others() {
    let script = [OnChoke(42, 1), OnChoke(38, 0), OnChoke(46, 1), OnChoke(46, 1), OnChoke(50, 2)];
    let expected = ["start 42", "start 38", "fade 42", "start 46", "restrike 46 as 46", "start 50"];
    check(16, PlayMode::Poly, &script, &expected);
    // The same key of another patch is another sound. An overlapping legato note continues the same sound.
    let told = play_choked(PlayMode::Poly, &[(46, 0), (46, 1)]);
    assert_eq!(told, ["start 46", "fade 46", "start 46"]);
    assert_eq!(play_choked(PlayMode::Legato, &[(46, 0), (48, 0)]), ["start 46", "retune 46 to 48"]);
}

/// Notes of one choke group, each with its key and patch.
fn play_choked(mode: PlayMode, notes: &[(u8, u32)]) -> Vec<String> {
    let script: Vec<Do> = notes.iter().map(|(key, patch)| OnChokePatch(*key, 1, *patch)).collect();
    play(16, mode, &script)
}

#[test]
fn the_sustain_pedal_holds_until_it_is_lifted() {
    let script = [On(60, 1.0), Sustain(true), Off(60), On(62, 1.0), Sustain(false), Off(62)];
    check(16, PlayMode::Poly, &script, &["start 60", "start 62", "release 60 at 0.5", "release 62 at 0.25"]);
}

#[test]
fn sostenuto_holds_only_the_keys_that_were_down() {
    let script = [On(60, 1.0), Sostenuto(true), On(62, 1.0), Off(60), Off(62), Sostenuto(false)];
    check(16, PlayMode::Poly, &script, &["start 60", "start 62", "release 62 at 0.25", "release 60 at 0.5"]);
    // A pedal that repeats its down message holds no further notes.
    let repeated = [Sostenuto(true), On(60, 1.0), Sostenuto(true), Off(60)];
    check(16, PlayMode::Poly, &repeated, &["start 60", "release 60 at 0.25"]);
    let both = [On(60, 1.0), Sostenuto(true), Sustain(true), Off(60), Sostenuto(false), Sustain(false)];
    check(16, PlayMode::Poly, &both, &["start 60", "release 60 at 0.5"]);
}

#[test]
fn note_ids_are_told_apart() {
    check(16, PlayMode::Poly, &[On(60, 1.0), OffId(60, 7), OffId(60, 1060)], &["start 60", "release 60 at 0.25"]);
}

#[test]
fn mono_strikes_each_key_and_returns_to_held_ones_without_striking() {
    let script = [On(60, 1.0), On(64, 1.0), Off(64), Off(60)];
    let expected = ["start 60", "restrike 60 as 64", "retune 64 to 60", "release 60 at 0.25"];
    check(16, PlayMode::Mono, &script, &expected);
    let inner = [On(60, 1.0), On(64, 1.0), Off(60), Off(64)];
    check(16, PlayMode::Mono, &inner, &["start 60", "restrike 60 as 64", "release 64 at 0.25"]);
}

#[test]
fn a_return_to_a_held_key_keeps_the_voice_in_its_patch() {
    let script = [OnPatch(57, 0), OnPatch(64, 1), Off(64), OnPatch(60, 1)];
    let expected = ["start 57", "fade 57", "start 64", "retune 64 to 57", "retune 57 to 60"];
    check(16, PlayMode::Legato, &script, &expected);
}

#[test]
fn a_return_after_a_change_of_patch_does_not_read_the_new_one() {
    for mode in [PlayMode::Mono, PlayMode::Legato] {
        let told = play(16, mode, &[OnPatch(60, 0), On(64, 1.0), Patch(1), Off(64), Off(60)]);
        assert_eq!(told[2..], ["retune 64 to 60 by itself", "release 60 at 0.25"], "{mode:?}");
    }
}

#[test]
fn legato_strikes_only_after_a_rest() {
    let script = [On(60, 1.0), On(64, 1.0), Off(60), Off(64), On(62, 1.0)];
    let expected = ["start 60", "retune 60 to 64", "release 64 at 0.25", "restrike 64 as 62"];
    check(16, PlayMode::Legato, &script, &expected);
}

#[test]
fn a_held_note_that_died_away_is_started_anew() {
    check(16, PlayMode::Mono, &[On(60, 1.0), Over(60), On(62, 1.0)], &["start 60", "start 62"]);
}

#[test]
fn all_notes_off_respects_the_pedal_and_all_sound_off_does_not() {
    let script = [On(60, 1.0), Sustain(true), NotesOff, Sustain(false)];
    check(16, PlayMode::Poly, &script, &["start 60", "release 60 at 0.5"]);
    let script = [On(60, 1.0), Sustain(true), Off(60), SoundOff, Sustain(false)];
    check(16, PlayMode::Poly, &script, &["start 60", "fade 60"]);
}

#[test]
fn unison_voices_are_one_note() {
    let script = [On(60, 0.5), On(60, 0.5), On(62, 0.9), On(64, 0.9), Over(60), Off(62), Over(62), OnChoke(64, 0)];
    let (told, ended) = play_with(2, PlayMode::Poly, Priority::Last, 3, &script);
    let expected = ["start 60", "restrike 60 as 60", "start 62", "fade 60", "start 64", "release 62 at 0.25"];
    let expected: Vec<_> = expected.iter().chain(&["restrike 64 as 64"]).flat_map(|line| [*line; 3]).collect();
    assert_eq!(told, expected);
    assert_eq!(ended, [60, 60, 62, 64], "a strike on a sounding key ends the note before; every note ends once");
}

#[test]
fn a_key_without_priority_waits_its_turn() {
    let script = [On(60, 1.0), On(64, 1.0), On(57, 1.0), Off(57), Off(60), Off(64)];
    let (told, ended) = play_with(16, PlayMode::Mono, Priority::Low, 1, &script);
    assert_eq!(told, ["start 60", "restrike 60 as 57", "retune 57 to 60", "retune 60 to 64", "release 64 at 0.25"]);
    assert_eq!(ended, [57, 60]);
    let (told, ended) = play_with(16, PlayMode::Legato, Priority::High, 1, &script);
    assert_eq!(told, ["start 60", "retune 60 to 64", "release 64 at 0.25"]);
    assert_eq!(ended, [57, 60], "keys that came up while they waited");
}

#[test]
fn a_key_without_priority_sounds_once_the_other_has_died_away() {
    let script = [On(60, 1.0), Over(60), On(64, 1.0), Sustain(true), Off(64), Off(60), On(65, 1.0)];
    let (told, _) = play_with(16, PlayMode::Mono, Priority::Low, 1, &script);
    assert_eq!(told, ["start 60", "start 64", "retune 64 to 60", "restrike 60 as 65"]);
}

/// Managers that share a pool of 16 voices, of which notes that do not fade may use 12.
#[test]
fn what_gives_way_is_the_quietest_of_all_managers() {
    let (log, capacity) = (Log::default(), Footprint { voices: 16, cells: 32 });
    let voice = || FakeVoice::new(&log);
    let instrument = FakeInstrument { patch: 0, unison: 2 };
    let mut managers = [(); 2].map(|()| VoiceManager::new(VoicePool::empty(capacity)));
    let mut shared = VoicePool::full(capacity, voice, || ());
    let need = FakeVoice::footprint(&instrument);
    let mut strike = |index: usize, key: u8, velocity: f32| {
        if !has_room(capacity, shared.free(), need) {
            make_room(&mut managers, |manager| manager, capacity, need);
            managers.iter_mut().for_each(|manager| {
                let free = manager.pool().free();
                manager.pool().lend(&mut shared, free);
            });
        }
        shared.lend(managers[index].pool(), need);
        managers[index].note_on(&instrument, Note { key, velocity, serial: u64::from(key), ..Note::NONE });
        log.take()
    };
    for key in 0..6 {
        assert_eq!(strike(usize::from(key % 2), key, 1.0 - 0.1 * f32::from(key)).len(), 2, "room for six notes");
    }
    assert_eq!(strike(0, 6, 1.0), ["fade 5", "fade 5", "start 6", "start 6"]);
    assert_eq!(strike(0, 7, 1.0), ["fade 4", "fade 4", "start 7", "start 7"]);
    assert_eq!(strike(1, 8, 1.0), ["fade 3", "fade 3", "start 8", "start 8"], "and the quietest that fades is cut off");
    assert_eq!(managers.iter_mut().map(|manager| manager.active().count()).sum::<usize>(), 16);
    assert_eq!(managers[1].ended().iter().map(|note| note.key).collect::<Vec<_>>(), [5]);
}
