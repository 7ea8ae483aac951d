//! MIDI files that violate the standard, and program changes together with `--preset`.

use crate::{Sandbox, end, midi, note_on, song};
use midly::num::u7;
use midly::{MidiMessage, TrackEvent};

/// Runs the command, which must succeed, and returns its stderr.
fn said(sandbox: &Sandbox, args: &str) -> String {
    let output = sandbox.sprung(args).assert().success().get_output().clone();
    String::from_utf8(output.stderr).unwrap()
}

/// A MIDI file with one track of these bytes, 96 ticks per beat.
fn raw(track: &[u8]) -> Vec<u8> {
    let length = (track.len() as u32).to_be_bytes();
    [b"MThd\0\0\0\x06\0\0\0\x01\0\x60MTrk", &length[..], track].concat()
}

#[test]
fn lenient_reading_plays_what_strict_reading_refuses() {
    let sandbox = Sandbox::new();
    let good = [0, 0x90, 60, 100, 0x60, 0x90, 64, 100, 0, 0xff, 0x2f, 0];
    let running = [0, 0x90, 60, 100, 0, 0xff, 3, 1, b'x', 0x60, 64, 100, 0, 0xff, 0x2f, 0];
    let offset = [&[0, 0xff, 0x54, 5, 99, 99, 99, 99, 99][..], &good].concat();
    let whole = raw(&good);
    let rmid = [b"RIFF\0\0\0\0RMIDdata", &(whole.len() as u32).to_le_bytes()[..], &whole].concat();
    // Volume 127 is what a channel has.
    let beyond = [&[0, 0xb0, 7, 200][..], &good].concat();
    let cable = [&[0, 0xf8][..], &good].concat();
    let long = [&[0x80, 0x80, 0x80, 0x80][..], &good].concat();
    let kind = [&whole[..9], &[9], &whole[10..]].concat();
    let base = "--bits 32f --force -o";
    sandbox.write("good.mid", &whole);
    sandbox.succeeds(&format!("render good.mid --lenient {base} good.wav"));
    for (name, bytes, message) in [
        ("running", raw(&running), "track 1, bar 1, beat 2 (tick 96, byte 31): an event has no status byte"),
        ("offset", raw(&offset), "track 1, bar 1, beat 1 (tick 0, byte 22): the SMPTE offset is no time of day"),
        (
            "short",
            whole[..whole.len() - 1].to_vec(),
            "track 1, bar 1, beat 2 (tick 96, byte 33): the file is cut off: 11 of the track's 12 bytes are there",
        ),
        ("rmid", rmid, "an RMID file of size 0"),
        ("beyond", raw(&beyond), "track 1, bar 1, beat 1 (tick 0, byte 22): "),
        ("cable", raw(&cable), "track 1, bar 1, beat 1 (tick 0, byte 22): "),
        ("long", raw(&long), "track 1, bar 1, beat 1 (tick 0, byte 22): "),
        ("kind", kind, "a MIDI file of type 9: expected type 0, 1 or 2"),
    ] {
        sandbox.write("in.mid", bytes);
        sandbox.fails("render in.mid -o out.wav", 1, &format!("in.mid: {message}"));
        sandbox.fails("render in.mid -o out.wav", 1, "; add --lenient to read it nevertheless");
        let warnings = said(&sandbox, &format!("render in.mid --lenient {base} again.wav"));
        assert!(warnings.contains(&format!("sprung: warning: in.mid: {message}")), "{name}: {warnings}");
        assert!(sandbox.read("again.wav") == sandbox.read("good.wav"), "{name}");
    }
    // A fault that cannot be repaired is still an error.
    sandbox.write("in.mid", &whole[..12]);
    sandbox.fails("render in.mid --lenient -o out.wav", 1, "not a whole MIDI file: it breaks off in its header");
}

#[test]
fn a_song_without_notes_is_told() {
    let sandbox = Sandbox::new();
    sandbox.write("in.mid", song(&[end(1)]));
    assert!(said(&sandbox, "render in.mid -o out.wav").contains("warning: there are no notes to play"));
    sandbox.write("in.mid", song(&[note_on(0, 0, 60), end(960)]));
    let part = said(&sandbox, "render in.mid --from 0.2s --to 9s -o part.wav");
    assert!(part.contains("warning: --to: the song ends before 9.000 s, at "), "{part}");
    assert!(part.contains("warning: no note begins from 0.200 s to "), "{part}");
}

#[test]
fn parts_of_a_song_are_played_faster_or_higher() {
    let sandbox = Sandbox::new();
    let drum = note_on(0, 9, 40);
    let write = |name: &str, key: u8, gap: u32, notes: &[TrackEvent<'static>]| {
        let off = midi(gap, 0, MidiMessage::NoteOff { key: key.into(), vel: 0.into() });
        sandbox.write(name, song(&[&[note_on(0, 0, key)], notes, &[off, end(gap)]].concat()));
    };
    write("whole.mid", 60, 480, &[note_on(0, 2, 50), drum]);
    write("lead.mid", 60, 480, &[]);
    write("fast.mid", 60, 240, &[]);
    write("high.mid", 67, 480, &[drum]);
    let render = |args: &str| {
        sandbox.succeeds(&format!("render {args} --bits 32f --force -o out.wav"));
        sandbox.read("out.wav")
    };
    assert!(render("whole.mid --solo 1") == render("lead.mid"));
    assert!(render("whole.mid --mute 3,10") == render("lead.mid"));
    assert!(render("whole.mid --solo 1,3 --mute 3 --tempo 2") == render("fast.mid"));
    assert!(render("whole.mid --mute 3 --transpose 7") == render("high.mid"));
    let told = said(&sandbox, "render whole.mid --transpose 60 --solo 1,3 --tail none --force -o out.wav");
    assert!(!told.contains("beyond"), "{told}");
    write("top.mid", 100, 480, &[]);
    let told = said(&sandbox, "render top.mid --transpose 28 --tail none --force -o out.wav");
    assert!(told.contains("--transpose 28 takes 1 note beyond the keyboard: left out"), "{told}");
    for (args, message) in [
        ("--tempo 0", "0.1 to 10"),
        ("--transpose 0.5", "‘0.5’: expected whole semitones, -60 to 60"),
        ("--solo 17", "17 is out of range: expected 1 to 16"),
    ] {
        sandbox.fails(&format!("render lead.mid {args} -o no.wav"), 2, message);
    }
}

#[test]
fn what_is_no_midi_file_is_called_what_it_is() {
    let sandbox = Sandbox::new();
    sandbox.succeeds("render --note 60 --length 0.1 --tail none -o sound.wav");
    sandbox.fails(
        "render sound.wav -o out.wav",
        1,
        "sound.wav: a WAV sound file: expected a Standard MIDI File (.mid)",
    );
    let preset = sandbox.succeeds("presets show Kick");
    sandbox.write("kick.toml", preset);
    sandbox.fails("render kick.toml -o out.wav", 1, "kick.toml: a text file: expected a Standard MIDI File (.mid)");
    let mut patterns = song(&[note_on(0, 0, 60), end(1)]);
    patterns[9] = 2;
    sandbox.write("patterns.mid", patterns);
    let message = "patterns.mid: a MIDI file of type 2, whose tracks are patterns: expected --pattern 1 to 1";
    sandbox.fails("render patterns.mid --lenient -o out.wav", 1, message);
    sandbox.fails("render patterns.mid --pattern 2 -o out.wav", 1, message);
}

#[test]
fn program_changes_are_told_and_can_be_left_out() {
    let sandbox = Sandbox::new();
    let program = |channel, number: u8| midi(0, channel, MidiMessage::ProgramChange { program: number.into() });
    let (first, rest) = ([note_on(0, 0, 60), note_on(0, 5, 40)], [note_on(48, 0, 64), note_on(48, 5, 43), end(480)]);
    sandbox.write("plain.mid", song(&[&first[..], &rest].concat()));
    sandbox.write("changes.mid", song(&[&first[..], &[program(5, 30), program(0, 37), program(3, 2)], &rest].concat()));
    let base = "--bits 32f --force -o";
    let plain = said(&sandbox, &format!("render plain.mid --preset Kalimba {base} plain.wav"));
    assert!(!plain.contains("warning"), "{plain}");
    let told = said(&sandbox, &format!("render changes.mid --preset Kalimba {base} changes.wav"));
    let expected = "sprung: warning: 2 of 4 notes, on 2 channels, do not play on --preset because of program changes; \
                    --programs none plays them on it\n";
    assert!(told.starts_with(expected), "{told}");
    assert!(sandbox.read("changes.wav") != sandbox.read("plain.wav"));
    let ignored = said(&sandbox, &format!("render changes.mid --preset Kalimba --programs none {base} changes.wav"));
    assert!(!ignored.contains("warning"), "{ignored}");
    said(&sandbox, &format!("render plain.mid --preset Kalimba --programs none {base} plain.wav"));
    assert!(sandbox.read("changes.wav") == sandbox.read("plain.wav"));
    // Without --preset there is no warning, because no single sound was requested for all programs.
    for args in ["changes.mid", "changes.mid --programs none"] {
        let told = said(&sandbox, &format!("render {args} {base} out.wav"));
        assert!(!told.contains("warning"), "{told}");
    }
}

#[test]
fn a_song_that_leaves_keys_and_pedals_down_ends_nevertheless() {
    let sandbox = Sandbox::new();
    let pedal = |number: u8| midi(0, 0, MidiMessage::Controller { controller: u7::new(number), value: u7::new(127) });
    let off = midi(100, 0, MidiMessage::NoteOff { key: u7::new(60), vel: u7::new(64) });
    let organ = midi(0, 0, MidiMessage::ProgramChange { program: u7::new(16) });
    for (name, events) in [
        ("key", &[note_on(0, 0, 60)][..]),
        ("sustain", &[pedal(64), note_on(0, 0, 60), off]),
        ("sostenuto", &[note_on(0, 0, 60), pedal(66), off]),
    ] {
        sandbox.write("in.mid", song(&[&[organ][..], events, &[end(960)]].concat()));
        let report = sandbox.succeeds("render in.mid --set space=none --rate 8000 --force --json -o out.wav");
        let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
        // An organ sounds for minutes while its key is down, and is silent soon after it.
        let seconds = report["tail_seconds"].as_f64().unwrap();
        assert!(seconds < 3.0, "{name}: {seconds}");
    }
}

#[test]
fn general_midi_needs_no_option() {
    let sandbox = Sandbox::new();
    let program = |channel, number: u8| midi(0, channel, MidiMessage::ProgramChange { program: number.into() });
    let render = |name: &str, args: &str, events: &[TrackEvent<'static>]| {
        sandbox.write(&format!("{name}.mid"), song(&[events, &[end(480)]].concat()));
        let told = said(&sandbox, &format!("render {name}.mid {args} --bits 32f --force -o {name}.wav"));
        assert!(!told.contains("warning"), "{told}");
        sandbox.read(&format!("{name}.wav"))
    };
    // Program 13, a marimba, and drums on channel 10.
    let marimba = render("marimba", "", &[program(2, 12), note_on(0, 2, 60)]);
    let named = render("named", "--channel 3=Marimba", &[note_on(0, 2, 60)]);
    assert!(marimba == named);
    let drums = render("drums", "", &[note_on(0, 9, 36)]);
    let mut named = sandbox.sprung("render drums.mid --bits 32f --force -o kit.wav");
    named.args(["--channel", "10=Acoustic Kit"]).assert().success();
    assert!(drums == sandbox.read("kit.wav") && drums != marimba);
    sandbox.write("mine.toml", "programs = 1\nname = \"Mine\"\nsounds = [\"\", \"Marimba\"]");
    let mine = render("mine", "--programs mine.toml", &[program(2, 1), note_on(0, 2, 60)]);
    let dry = render("marimba", "--set space=none", &[program(2, 12), note_on(0, 2, 60)]);
    assert!(mine != dry && dry != marimba, "this list has neither headroom nor a space that channels share");
    sandbox.write("mine.toml", "programs = 1\nname = \"Mine\"\ngain = -6\nsounds = [\"\", \"Marimba\"]");
    let mine = render("mine", "--programs mine.toml", &[program(2, 1), note_on(0, 2, 60)]);
    assert!(mine == dry, "the same headroom");
    sandbox.write("mine.mid", song(&[program(2, 0), note_on(0, 2, 60), end(480)]));
    let told = said(&sandbox, "render mine.mid --programs mine.toml --force -o mine.wav");
    assert!(told.contains("program 1: ‘Mine’ has no sound for it; it plays what channels start with"), "{told}");
    sandbox.write("bad.toml", "programs = 1\nname = \"Bad\"\nsounds = [\"Marimbo\"]");
    sandbox.fails("render mine.mid --programs bad.toml --force -o mine.wav", 1, "the nearest is ‘Marimba’");
    sandbox.fails(
        "render mine.mid --programs gs --force -o mine.wav",
        1,
        "expected gm, none or a file ending in .toml",
    );
}
