//! Scala files on the command line.

use crate::{Sandbox, end, note_on, song};
use midly::{TrackEvent, TrackEventKind};

const FIFTHS: &str = "Fifths\n1\n3/2\n";
const C_AND_G: &str = "! C and G at 256 Hz and up\n12\n0\n127\n60\n60\n256.0\n2\n0\nx\nx\nx\nx\nx\nx\n1\n";

fn sandbox() -> Sandbox {
    let sandbox = Sandbox::new();
    sandbox.write("fifths.scl", FIFTHS);
    sandbox.write("c-and-g.kbm", C_AND_G);
    sandbox
}

#[test]
fn keys_sound_at_the_scale_and_the_frequency_of_the_files() {
    let sandbox = sandbox();
    let base = "render --length 0.3 --tail none --set decay=5 --bits 32f";
    let render = |args: &str| {
        sandbox.succeeds(&format!("{base} {args} --force -o out.wav"));
        sandbox.wav("out.wav").samples
    };
    // Without a keyboard mapping, a scale starts at A4: key 70 is a fifth above 440 Hz, which is 660 Hz.
    assert!(render("--note 70 --scale fifths.scl").iter().any(|sample| sample.abs() > 0.1));
    for (key, args, frequency) in [
        (70, "", 660.0),
        (68, "--set tuning=442", 442.0 / 1.5),
        (67, "--keymap c-and-g.kbm", 384.0),
        (72, "--keymap c-and-g.kbm --set tuning=442", 576.0),
    ] {
        let samples = render(&format!("--note {key} --scale fifths.scl {args}"));
        let left: Vec<f64> = samples.chunks(2).map(|frame| frame[0]).collect();
        // Rising zero crossings, interpolated between two samples.
        let crossings: Vec<f64> = (1..left.len())
            .filter(|n| left[n - 1] < 0.0 && left[*n] >= 0.0)
            .map(|n| n as f64 - left[n] / (left[n] - left[n - 1]))
            .collect();
        let cycles = crossings.len() as f64 - 1.0;
        let found = 48_000.0 * cycles / (crossings[crossings.len() - 1] - crossings[0]);
        assert!((found / frequency - 1.0).abs() < 1e-4, "{key} {args}: {found} Hz");
    }
}

#[test]
fn unmapped_keys_are_silent() {
    let sandbox = sandbox();
    sandbox.write("song.mid", song(&[note_on(0, 0, 61), note_on(0, 9, 62), end(240)]));
    let args = "render song.mid --preset init --scale fifths.scl --keymap c-and-g.kbm --json -o out.wav";
    let report: serde_json::Value = serde_json::from_slice(&sandbox.succeeds(args)).unwrap();
    assert_eq!(report["voices_used"], 0);
    assert_eq!(sandbox.wav("out.wav").peak(), 0.0);
    let told = |args: &str| {
        let output = sandbox.sprung(args).assert().success().get_output().clone();
        String::from_utf8(output.stderr).unwrap()
    };
    let unmapped = told(&args.replace("--json", "--force"));
    assert!(unmapped.contains("2 of 2 notes are silent: the keymap leaves their keys out"), "{unmapped}");
    // Steps of a hundred octaves.
    sandbox.write("wide.scl", "wide\n1\n120000.0\n");
    let wide = told("render --note 0,69 --preset init --scale wide.scl --length 0.01 --force -o out.wav");
    assert!(wide.contains("warning: 1 of 2 notes are silent: the scale takes their keys out of range"), "{wide}");
}

#[test]
fn a_scale_goes_before_the_tunings_of_a_song() {
    let sandbox = sandbox();
    // Key 60 becomes 61, by MIDI Tuning Standard in real time.
    let message = TrackEventKind::SysEx(&[0x7f, 0x7f, 8, 2, 0, 1, 60, 61, 0, 0, 0xf7]);
    let tuning = TrackEvent { delta: 0.into(), kind: message };
    sandbox.write("tuned.mid", song(&[tuning, note_on(0, 0, 60), note_on(0, 0, 70), end(200)]));
    sandbox.write("plain.mid", song(&[note_on(0, 0, 60), note_on(0, 0, 70), end(200)]));
    let render = |args: &str| {
        let output = sandbox.sprung(&format!("render {args} --bits 32f --force -o out.wav")).assert().success();
        (sandbox.read("out.wav"), String::from_utf8(output.get_output().stderr.clone()).unwrap())
    };
    let told = "warning: --scale goes before the tunings by MIDI Tuning Standard in the song: they were left out";
    let (scaled, said) = render("tuned.mid --scale fifths.scl");
    assert!(said.contains(told), "{said}");
    let (plain, said) = render("plain.mid --scale fifths.scl");
    assert!(scaled == plain && !said.contains("warning"), "{said}");
    let (tuned, said) = render("tuned.mid");
    assert!(tuned != render("plain.mid").0 && !said.contains("warning"), "{said}");
}

#[test]
fn wrong_files_are_refused_by_name_and_line() {
    let sandbox = sandbox();
    sandbox.write("bad.scl", "Fifths\r\n1\r\n3:2\r\n");
    sandbox.write("latin.scl", b"Stra\xdfe\n2\n3/2\n\xbd");
    sandbox.write("bad.kbm", C_AND_G.replace("256.0", "C4"));
    sandbox.write("huge.scl", "!".repeat((1 << 20) + 1));
    for (args, message) in [
        ("--scale bad.scl", "bad.scl:3: ‘3:2’ is not a pitch: expected a ratio of whole numbers from 1 (3/2, 2)"),
        ("--scale latin.scl", "latin.scl:4: ‘½’ is not a pitch"),
        ("--scale fifths.scl --keymap bad.kbm", "bad.kbm:7: ‘C4’ is not a frequency: expected Hz above 0"),
        ("--scale c-and-g.kbm", "c-and-g.kbm:4: ‘127’ is a pitch too many: expected the 0 that line 3 says"),
        ("--scale fifths.scl --keymap fifths.scl", "fifths.scl:1: ‘Fifths’ is not the size of the map"),
        ("--scale huge.scl", "huge.scl: too large for a Scala file"),
        ("--scale none.scl", "none.scl: "),
        ("--scale .", ".: "),
    ] {
        sandbox.fails(&format!("render --note 60 {args} -o out.wav"), 1, message);
    }
    sandbox.fails("render --note 60 --keymap c-and-g.kbm -o out.wav", 2, "--scale <FILE.scl>");
}

#[test]
fn notes_between_the_keys_of_a_scale_are_refused() {
    let sandbox = sandbox();
    for (notes, message) in [
        ("440Hz", "--note: ‘440Hz’ is no key, and --scale tunes keys: expected keys (C#4, 60), each once"),
        ("C4,60.5", "--note: ‘60.5’ is no key"),
        ("C4,E4,60", "--note: ‘60’ is there twice"),
    ] {
        sandbox.fails(&format!("render --note {notes} --scale fifths.scl -o out.wav"), 1, message);
    }
}

#[test]
fn a_scale_is_an_input() {
    let sandbox = sandbox();
    for name in ["fifths.scl", "c-and-g.kbm"] {
        let args = format!("render --note 60 --scale fifths.scl --keymap c-and-g.kbm --force -o {name}");
        sandbox.fails(&args, 1, &format!("{name}: this is the input ‘{name}’: expected another file to write to"));
    }
    assert!(sandbox.read("fifths.scl") == FIFTHS.as_bytes() && sandbox.read("c-and-g.kbm") == C_AND_G.as_bytes());
}
