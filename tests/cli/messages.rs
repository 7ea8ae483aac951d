//! Messages about common mistakes say what is wrong, and what would be right.

use crate::Sandbox;

#[test]
fn options_say_what_would_be_right() {
    let sandbox = Sandbox::new();
    for (args, message) in [
        ("--note 60 --set decay=0,5 -o x.wav", "‘0,5’ is not a number in s: expected 0.5, with a decimal point"),
        ("--note 60 --set decay=2s,gain=-3 -o x.wav", "expected one parameter, as in --set decay=2s --set gain=-3"),
        ("--note 60 --set brightness=3 -o x.wav", "there is no parameter ‘brightness’; the nearest is ‘tilt’"),
        ("--note 60 --set decay=long -o x.wav", "‘long’ is not a number in s: expected from 5 ms to 60 s"),
        ("--note 60 --seed abc -o x.wav", "‘abc’ is not a whole number: expected 0 to 18446744073709551615"),
        ("--note 60 --velocity 0.5 -o x.wav", "‘0.5’ is not a whole number: expected 1 to 127"),
        ("--note 60 --block 4k -o x.wav", "‘4k’ is not a whole number: expected 1 to 65536"),
        ("--note 60 --threads all -o x.wav", "‘all’ is not a whole number: expected 1 to 256"),
        ("--note 440 -o x.wav", "note ‘440’ is out of range: expected a note name"),
        ("--note 440 -o x.wav", "for 440 Hz, write 440Hz"),
        ("--note C11 -o x.wav", "note ‘C11’ is out of range: expected C-1 to G9"),
        ("--note 60 --normalize -1 -o x.wav", "expected peak=DBFS or lufs=LUFS, as in peak=-1"),
        ("--note 60 --normalize -14LUFS -o x.wav", "expected peak=DBFS or lufs=LUFS, as in lufs=-14"),
        ("--note 60 --gain-db -3,5 -o x.wav", "‘-3,5’ is not a number: expected -3.5, with a decimal point"),
        ("--note 60 --length 0,5 -o x.wav", "‘0,5’ is not a number: expected 0.5, with a decimal point"),
        ("--note 60 --rate CD -o x.wav", "‘CD’ is not a number: expected 1000 to 768000 Hz"),
        ("--note 60 -p Kick -o x.wav", "there is no short '-p'; there is '--pattern' and '--preset'"),
        ("--note 60 -n 61 -o x.wav", "there is no short '-n'; there is '--note' and '--normalize'"),
        ("--note 60", "name the file to write, as in '-o out.wav'"),
        ("--note 60 -o", "name the file to write, as in '-o out.wav'"),
        ("song.mid out.wav", "to write to it, put '-o' before it: '-o out.wav'"),
        ("--note 60 --dether -o x.wav", "a similar argument exists: '--dither'"),
    ] {
        sandbox.fails(&format!("render {args}"), 2, message);
    }
}

#[test]
fn a_file_that_is_no_preset_is_said_to_be_none() {
    let sandbox = Sandbox::new();
    sandbox.write("sound.wav", "RIFF");
    for name in ["sound.wav", "./sound.wav"] {
        let message = format!("preset: ‘{name}’ is no preset file: expected a name that ends in .toml");
        sandbox.fails(&format!("render --note C4 --preset {name} -o x.wav"), 1, &message);
    }
}

#[test]
fn presets_are_suggested_by_their_words() {
    let sandbox = Sandbox::new();
    for (name, message) in [
        ("Bell", "there is no factory preset or kit ‘Bell’; the nearest is ‘"),
        ("glass", "Glass"),
        ("kcik", "the nearest is ‘Kick’"),
        ("zzzz", "‘sprung presets list’ shows them all"),
    ] {
        sandbox.fails(&format!("render --note 60 --preset {name} -o x.wav"), 1, message);
    }
}

#[test]
fn rates_are_read_with_their_units() {
    let sandbox = Sandbox::new();
    for (rate, expected) in [("44.1k", 44_100), ("48kHz", 48_000), ("44100Hz", 44_100), ("8000", 8_000)] {
        sandbox.succeeds(&format!("render --note 60 --length 0.01 --tail none --rate {rate} --force -o x.wav"));
        assert_eq!(sandbox.wav("x.wav").spec.sample_rate, expected, "{rate}");
        sandbox.succeeds(&format!("lab listen . --methods rk4 --seconds 0.01 --rate {rate} --force"));
        assert_eq!(sandbox.wav("rk4.wav").spec.sample_rate, expected, "{rate}");
    }
    // A negative quantity is accepted with its unit, too.
    sandbox.succeeds("render --note 60 --length 0.01 --tail none --gain-db -6dB --force -o x.wav");
}

#[cfg(not(feature = "play"))]
#[test]
fn a_build_that_cannot_play_says_so() {
    let sandbox = Sandbox::new();
    for args in ["play", "play song.mid --preset Kick", "play --help", "play --list"] {
        sandbox.fails(args, 1, "play: this sprung was built without sound devices: expected one of ‘cargo install");
    }
    let help = String::from_utf8(sandbox.succeeds("--help")).unwrap();
    assert!(help.lines().all(|line| line.split_whitespace().next() != Some("play")), "{help}");
}

#[cfg(unix)]
#[test]
fn nothing_from_a_file_or_its_name_steers_the_terminal() {
    let sandbox = Sandbox::new();
    let (evil, shown) = ("\u{1b}[31m\u{202e}\u{9b}2J", "\\u001b[31m\\u202e\\u009b2J");
    let preset = "format = 1\nname = \"a\u{202e}b\"\ncomment = \"\\u001b[31m\u{9b}2J\"\n";
    let named = |ending: &str| format!("{evil}{ending}");
    sandbox.write(&named(".toml"), preset);
    sandbox.write(&named(".mid"), "MThd");
    sandbox.write(&named(".bad.toml"), "format = 1\nname = \"b\"\n\"\\u001b[31m\u{202e}\" = 1");
    let run = |args: &[&str]| {
        let mut command = sandbox.sprung("");
        let output = command.args(args).output().unwrap();
        let text = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        let unsafe_character = text.chars().find(|c| *c != '\n' && (c.is_control() || *c == '\u{202e}'));
        assert_eq!(unsafe_character, None, "{args:?}: {text:?}");
        text
    };
    let (toml, mid, bad) = (named(".toml"), named(".mid"), named(".bad.toml"));
    for (args, expected) in [
        (&["presets", "check", &toml][..], format!("{shown}.toml: ‘a\\u202eb’ is in order")),
        (&["presets", "check", &bad], format!("{shown}.bad.toml: unknown key ‘\\u001b[31m\\u202e’")),
        (&["presets", "show", &toml], "\\u001B[31m\\u009b2J".to_owned()),
        (&["render", &mid, "-o", "x.wav"], format!("{shown}.mid: not a whole MIDI file")),
        (&["render", "none.mid", &mid, "-o", "x.wav"], "\\u202e".to_owned()),
        (&["render", "--note", evil, "-o", "x.wav"], "is not a note".to_owned()),
        (&["render", "--note", "60", "--preset", evil, "-o", "x.wav"], format!("no factory preset or kit ‘{shown}’")),
        (&["render", "--note", "60", "--length", "0.01", "-o", &named(".wav")], format!("{shown}.wav: ")),
        (&["render", "--note", "60", "--length", "0.01", "--json", "--force", "-o", &named(".wav")], shown.to_owned()),
        (&["lab", "listen", evil, "--methods", "rk4", "--seconds", "0.01"], format!("{shown}/rk4.wav")),
    ] {
        let text = run(args);
        assert!(text.contains(&expected), "{args:?}: expected {expected} in {text}");
    }
    // The output is still a valid preset: the escapes lose nothing.
    let shown = run(&["presets", "show", &toml]);
    let (before, after) = (sprung::preset::Preset::parse(preset, "x"), sprung::preset::Preset::parse(&shown, "x"));
    assert_eq!(after.unwrap(), before.unwrap());
}

#[test]
fn an_input_that_drives_nothing_is_told() {
    let sandbox = Sandbox::new();
    sandbox.succeeds("render --note 60 --length 0.1 --tail none -o in.wav");
    let said = |args: &str| {
        let out = sandbox.sprung(&format!("render --note 60 --input in.wav --force -o x.wav {args}")).output().unwrap();
        String::from_utf8(out.stderr).unwrap()
    };
    let told = "warning: --input: no sound has an input_level, so it drives nothing: --set input_level=0 sets one";
    assert!(said("").contains(told), "{}", said(""));
    assert!(!said("--set input_level=-6").contains(told));
}
