//! Bad input causes one message and a non-zero exit code, leaves nothing behind, and never panics.

use crate::{Sandbox, end, exists, note_on, song};
use sprung::internals::random;

#[test]
fn midi_files() {
    let sandbox = Sandbox::new();
    let good = song(&[note_on(0, 0, 60), note_on(960, 0, 61), end(9)]);
    let mut huge = good.clone();
    huge.resize(65 << 20, 0);
    let mut claims_too_much = good.clone();
    claims_too_much[18..22].fill(0xff);
    let noise: Vec<u8> = (0..5000).map(|n| random::bits(0, n) as u8).collect();
    let endless = song(&vec![note_on(0x0fff_ffff, 0, 60); 40]);
    for (name, bytes, message) in [
        (
            "truncated",
            good[..good.len() - 3].to_vec(),
            "track 1, bar 1, beat 3 (tick 960, byte 31): the file is cut off",
        ),
        ("headless", good[..10].to_vec(), "not a whole MIDI file: it breaks off in its header"),
        ("empty", vec![], "an empty file: expected a Standard MIDI File"),
        ("huge", huge, "too large for a MIDI file: expected at most 64 MiB"),
        ("claims", claims_too_much, "the file is cut off: 12 of the track's 4294967295 bytes are there"),
        ("noise", noise.clone(), "not a MIDI file: expected a Standard MIDI File"),
        (
            "framed",
            [b"MThd\0\0\0\x06\0\x01\0\x01\0\x60MTrk\0\0\x13\x8d\x83\x60\x90\x3c\x40".to_vec(), noise].concat(),
            "track 1, bar 2, beat 2 (tick 480, byte 27): expected a data byte of at most 0x7f",
        ),
        ("endless", endless, "bytes do not fit"),
    ] {
        sandbox.write("in.mid", bytes);
        sandbox.fails("render in.mid --rate 768000 --bits 32f -o out.wav", 1, message);
        if name != "endless" {
            sandbox.fails("render in.mid -o out.wav", 1, "in.mid: ");
        }
    }
    sandbox.fails("render none.mid -o out.wav", 1, "none.mid: ");
    sandbox.fails("render . -o out.wav", 1, ".: ");
    let output = sandbox.sprung("render - -o out.wav").write_stdin("no song").assert().code(1).get_output().clone();
    assert!(String::from_utf8_lossy(&output.stderr).contains("stdin: a text file: expected a Standard MIDI File"));
}

#[test]
fn presets() {
    let sandbox = Sandbox::new();
    for (body, message) in [
        ("format = 2", "format 2 is of a newer version: this one reads format = 1"),
        ("name = \"a\"", "there is no ‘format’"),
        ("format = 1\nname = \"a\"\n[params]\ngain = nan", "params.gain: NaN is out of range: expected from -60 dB"),
        ("format = 1\nname = \"a\"\n[params]\ngain = 99", "params.gain: 99 is out of range"),
        ("format = 1\nname = \"a\"\n[params]\ndeacy = 1", "unknown key ‘params.deacy’; the nearest is ‘decay’"),
        ("format = ", "bad.toml:1:"),
    ] {
        sandbox.write("bad.toml", body);
        sandbox.fails("render --note 60 --preset bad.toml -o out.wav", 1, message);
        sandbox.fails("presets show bad.toml", 1, "bad.toml:");
    }
    sandbox.write("bad.toml", [0xff, 0xfe]);
    sandbox.fails("render --note 60 --preset bad.toml -o out.wav", 1, "expected UTF-8");
    sandbox.write("bad.toml", vec![b'#'; (16 << 20) + 1]);
    sandbox.fails("render --note 60 --preset bad.toml -o out.wav", 1, "expected at most 16 MiB");
    sandbox.fails("render --note 60 --preset none.toml -o out.wav", 1, "none.toml: ");
    sandbox.fails("render --note 60 --preset kcik -o out.wav", 1, "the nearest is ‘Kick’");
    sandbox.fails("presets show kcik", 1, "the nearest is ‘Kick’");
}

#[test]
fn options() {
    let sandbox = Sandbox::new();
    for (args, message) in [
        ("--note 200", "note ‘200’ is out of range: expected a note name (C#4), a key from 0 to 127"),
        ("--note H2", "‘H2’ is not a note"),
        ("--note -1", "note ‘-1’ is out of range"),
        ("--note nan", "‘nan’ is not a note"),
        ("--note C4,,E4", "‘’ is not a note"),
        ("--note 60 --rate 0", "0 is out of range: expected 1000 to 768000 Hz"),
        ("--note 60 --rate 768001", "768001 is out of range: expected 1000 to 768000 Hz"),
        ("--note 60 --rate -1", "-1 is out of range: expected 1000 to 768000 Hz"),
        ("--note 60 --velocity 0", "0 is out of range: expected 1 to 127"),
        ("--note 60 --velocity 128", "128 is out of range: expected 1 to 127"),
        ("--note 60 --length -1", "-1 is out of range: expected 0 to 86400 s"),
        ("--note 60 --length inf", "expected 0 to 86400 s"),
        ("--note 60 --tail soon", "expected 0 to 86400 s, auto or none"),
        ("--note 60 --tail -1", "expected 0 to 86400 s, auto or none"),
        ("--note 60 --block 0", "0 is out of range: expected 1 to 65536"),
        ("--note 60 --block 65537", "65537 is out of range: expected 1 to 65536"),
        ("--note 60 --threads 0", "0 is out of range: expected 1 to 256"),
        ("--note 60 --bits 8", "expected 16, 24 or 32f"),
        ("--note 60 --gain-db nan", "expected -120 to 120 dB"),
        ("--note 60 --normalize rms=1", "expected peak=DBFS or lufs=LUFS"),
        ("--note 60 --normalize peak=1", "1 is out of range: expected -120 to 0 dBFS"),
        ("--note 60 --normalize peak=-1 --gain-db 3", "cannot be used with"),
        ("--note 60 --set gain=99", "gain: 99 is out of range: expected from -60 dB to 12 dB"),
        ("--note 60 --set deacy=1", "the nearest is ‘decay’"),
        ("--note 60 --set gain=NaN", "‘NaN’ is not a number in dB"),
        ("--note 60 --seed -1", "-1 is out of range: expected 0 to 18446744073709551615"),
        ("song.mid --note 60", "cannot be used with"),
        ("song.mid --velocity 3", "cannot be used with"),
        ("song.mid --length 3", "cannot be used with"),
        ("", "<SONG|--note <NOTE>>"),
    ] {
        sandbox.fails(&format!("render {args} -o out.wav"), 2, message);
    }
    sandbox.fails("render --note 60", 2, "--output");
    sandbox.fails("render --note 60 --bits 32f --dither -o out.wav", 1, "expected --bits 16 or 24");
}

#[test]
fn outputs() {
    let sandbox = Sandbox::new();
    sandbox.fails("render --note 60 -o none/out.wav", 1, "none/out.wav: ");
    sandbox.fails("render --note 60 -o .", 1, ".: ");
    let message = "out.mp3: only WAV and FLAC can be written, not .mp3: expected .wav or .flac";
    sandbox.fails("render --note 60 -o out.mp3", 1, message);
    if exists("/sys/kernel") {
        sandbox.fails("render --note 60 -o /sys/out.wav", 1, "/sys/out.wav: no file can be made in the folder /sys: ");
    }
    sandbox.write("file", "");
    sandbox.fails("render --note 60 -o file/out.wav", 1, "file/out.wav: ");
    sandbox.write("old.wav", "keep me");
    sandbox.fails("render --note 60 -o old.wav", 1, "old.wav: the file exists; add --force");
    assert_eq!(sandbox.read("old.wav"), b"keep me");
    // A failure after the work has begun does not change an old file either.
    sandbox.fails(
        "render --note 60 --length 0.1 --normalize lufs=-14 --set decay=0.005 --force -o old.wav",
        1,
        "normalize: ",
    );
    assert_eq!(sandbox.read("old.wav"), b"keep me");
    sandbox.fails("render --note 60 -o nowhere/x.wav", 1, "nowhere/x.wav: there is no folder nowhere");
    if exists("/dev/full") {
        sandbox.fails("render --note 60 -o /dev/full", 1, "/dev/full: No space left on device");
        sandbox.fails("render --note 60 --length 0.01 --tail none --json -o /dev/full", 1, "/dev/full: No space");
    }
}
