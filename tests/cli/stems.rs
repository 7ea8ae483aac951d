//! Stems of songs: they are there, as long as the song, and add up to its mix.

use crate::{Sandbox, end, midi, note_on, song};
use midly::MidiMessage;
use midly::num::u7;
use std::fs;

/// A song on three channels: a marimba, a channel that changes from an organ to a kit and back, and drums with hats that choke each
/// other.
fn write_song(sandbox: &Sandbox) {
    let program = |channel, number: u8| midi(0, channel, MidiMessage::ProgramChange { program: number.into() });
    let bank = |value: u8| midi(0, 3, MidiMessage::Controller { controller: u7::new(0), value: u7::new(value) });
    let off = |delta, channel, key: u8| midi(delta, channel, MidiMessage::NoteOff { key: key.into(), vel: 64.into() });
    sandbox.write(
        "song.mid",
        song(&[
            program(0, 12),
            program(3, 16),
            note_on(0, 0, 60),
            note_on(0, 3, 48),
            note_on(0, 9, 36),
            note_on(100, 9, 42),
            note_on(100, 9, 46),
            off(10, 3, 48),
            bank(120),
            program(3, 0),
            note_on(90, 3, 38),
            note_on(50, 9, 42),
            note_on(0, 9, 36),
            note_on(0, 0, 67),
            bank(0),
            program(3, 16),
            note_on(100, 3, 50),
            off(100, 3, 50),
            end(50),
        ]),
    );
}

/// The names of the files in a folder, in order.
fn names(sandbox: &Sandbox, folder: &str) -> Vec<String> {
    let entries = fs::read_dir(sandbox.path(folder)).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The largest difference between the sum of all stems in a folder and a mix of the same length.
fn most_missing(sandbox: &Sandbox, folder: &str, mix: &str) -> f64 {
    let mix = sandbox.wav(mix);
    let mut rest = mix.samples.clone();
    for name in names(sandbox, folder) {
        let stem = sandbox.wav(&format!("{folder}/{name}"));
        assert_eq!((stem.frames, stem.spec.channels), (mix.frames, mix.spec.channels), "{name}");
        rest.iter_mut().zip(&stem.samples).for_each(|(rest, sample)| *rest -= sample);
    }
    assert!(mix.peak() > 0.1);
    rest.iter().fold(0.0, |most, rest| most.max(rest.abs()))
}

#[test]
fn stems_add_up_to_the_mix_before_the_limiter() {
    let sandbox = Sandbox::new();
    write_song(&sandbox);
    for (number, (args, expected)) in [
        (
            "",
            &[
                "01-marimba.wav",
                "04-038-snare.wav",
                "04-effects.wav",
                "10-036-kick.wav",
                "10-042-closed-hat-open-hat.wav",
                "10-effects.wav",
                "space.wav",
            ][..],
        ),
        ("--mono --tail 0.5 --block 100 --mix-gain-db -3", &[]),
        ("--programs none --preset Marimba", &["01-marimba.wav", "04-marimba.wav", "10-marimba.wav"]),
        ("--from 0.2", &[]),
    ]
    .into_iter()
    .enumerate()
    {
        let folder = format!("stems{number}");
        sandbox.succeeds(&format!("render song.mid {args} --bits 32f --stems {folder}"));
        sandbox.succeeds(&format!("render song.mid {args} --bits 32f --set limiter=off --force -o mix.wav"));
        if !expected.is_empty() {
            assert_eq!(names(&sandbox, &folder), expected, "{args}");
        }
        let missing = most_missing(&sandbox, &folder, "mix.wav");
        assert!(missing < 1e-6, "{args}: {} dBFS are missing", 20.0 * libm::log10(missing));
    }
}

#[test]
fn what_a_kit_s_effects_add_is_a_stem() {
    let sandbox = Sandbox::new();
    write_song(&sandbox);
    let mut render =
        sandbox.sprung("render song.mid --programs none --solo 10 --bits 32f --set drive=12 --stems stems");
    render.args(["--channel", "10=Tight Kit"]).assert().success();
    let mut render = sandbox.sprung("render song.mid --programs none --solo 10 --bits 32f --set drive=12 -o mix.wav");
    render.args(["--channel", "10=Tight Kit", "--set", "limiter=off"]).assert().success();
    assert!(names(&sandbox, "stems").contains(&"10-effects.wav".to_owned()));
    let missing = most_missing(&sandbox, "stems", "mix.wav");
    assert!(missing < 1e-6, "{} dBFS are missing", 20.0 * libm::log10(missing));
}

#[test]
fn a_drum_is_heard_in_its_own_stem_only() {
    let sandbox = Sandbox::new();
    write_song(&sandbox);
    sandbox.succeeds("render song.mid --tail 0.1 --bits 32f --stems stems");
    sandbox.write("kick.mid", song(&[note_on(0, 9, 36), note_on(340, 9, 36), end(250)]));
    sandbox.succeeds("render kick.mid --tail 0.1 --bits 32f --stems alone");
    let [stem, alone] = ["stems", "alone"].map(|folder| sandbox.wav(&format!("{folder}/10-036-kick.wav")));
    // The first strike has the same random numbers in both songs, up to the second.
    let same = stem.samples.iter().zip(&alone.samples).take(2 * 340 * 50).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(same && alone.peak() > 0.1);
}

#[test]
fn stems_of_flac_have_the_same_samples() {
    let sandbox = Sandbox::new();
    write_song(&sandbox);
    sandbox.succeeds("render song.mid --tail 0.1 --stems wav");
    sandbox.succeeds("render song.mid --tail 0.1 --stems flac --format flac");
    for name in names(&sandbox, "wav") {
        let flac = fs::File::open(sandbox.path(&format!("flac/{}", name.replace(".wav", ".flac")))).unwrap();
        let flac = sprung::io::sound_file::read(flac, "flac").unwrap();
        let wav = fs::File::open(sandbox.path(&format!("wav/{name}"))).unwrap();
        assert!(sprung::io::sound_file::read(wav, "wav").unwrap().channels == flac.channels, "{name}");
    }
}

#[test]
fn what_is_inaudible_after_the_gain_is_no_stem() {
    let sandbox = Sandbox::new();
    write_song(&sandbox);
    sandbox.succeeds("render song.mid --tail 0.1 --bits 32f --stems stems");
    assert!(names(&sandbox, "stems").contains(&"space.wav".to_owned()));
    sandbox.succeeds("render song.mid --tail 0.1 --bits 32f --gain-db -120 --stems soft");
    assert!(!names(&sandbox, "soft").contains(&"space.wav".to_owned()));
    // With --force, no file of an earlier run stays as it was.
    sandbox.succeeds("render song.mid --tail 0.1 --bits 32f --gain-db -120 --stems stems --force");
    assert!(names(&sandbox, "stems").iter().all(|name| sandbox.wav(&format!("stems/{name}")).peak() < 1e-5));
}

#[test]
fn stems_of_another_run_are_never_mixed_in_unseen() {
    let sandbox = Sandbox::new();
    write_song(&sandbox);
    sandbox.succeeds("render song.mid --solo 1 --stems stems");
    let old = names(&sandbox, "stems");
    assert_eq!(old, ["01-marimba.wav", "space.wav"]);
    sandbox.write("stems/notes.wav", "no stem");
    let message = "stems has stems of another run (01-marimba.wav and 1 more)";
    let refused = format!("--stems: {message}: expected another folder, or --force");
    sandbox.fails("render song.mid --solo 10 --programs none --preset init --stems stems", 1, &refused);
    sandbox.fails("render song.mid --solo 1 --format flac --stems stems", 1, &refused);
    let forced = "render song.mid --solo 10 --programs none --preset init --stems stems --force";
    let output = sandbox.sprung(forced).assert().success().get_output().clone();
    let said = String::from_utf8(output.stderr).unwrap();
    let told = format!("warning: {message}: they stay there, and are no part of this mix");
    assert!(said.contains(&told), "{said}");
    assert_eq!(names(&sandbox, "stems"), ["01-marimba.wav", "10-init.wav", "notes.wav", "space.wav"]);
}

#[test]
fn no_stem_is_left_by_an_error() {
    let sandbox = Sandbox::new();
    write_song(&sandbox);
    sandbox.fails("render song.mid --stems new --rate 192k --format flac", 1, "--rate: 192000 Hz is too high for FLAC");
    sandbox.fails("render song.mid --stems new --normalize peak=-1", 2, "cannot be used with");
    fs::create_dir(sandbox.path("old")).unwrap();
    sandbox.write("old/space.wav", "mine");
    sandbox.fails("render song.mid --stems old", 1, "space.wav");
    assert_eq!(
        (names(&sandbox, "old"), sandbox.read("old/space.wav")),
        (vec!["space.wav".to_owned()], b"mine".to_vec())
    );
    fs::copy(sandbox.path("song.mid"), sandbox.path("old/space.wav")).unwrap();
    sandbox.fails("render old/space.wav --stems old --force", 1, "this is the input");
}
