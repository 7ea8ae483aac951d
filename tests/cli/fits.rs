//! `sprung fit`, and figures of sounds.

use crate::{Sandbox, signals};
use sprung::io::sound_file::read;
use std::f64::consts::TAU;

/// A third of a second of a strike with three modes of the ratios of a bar, at 44.1 kHz.
fn bar(fundamental: f64, gain: f64) -> Vec<f32> {
    let mode = |n: usize, ratio: f64, amplitude: f64, t60: f64| {
        let t = n as f64 / 44_100.0;
        gain * amplitude * libm::exp(-6.9 * t / t60) * libm::sin(TAU * fundamental * ratio * t)
    };
    let sample = |n| mode(n, 1.0, 0.4, 0.3) + mode(n, 2.756, 0.2, 0.15) + mode(n, 5.404, 0.1, 0.08);
    (0..14_700).map(|n| sample(n) as f32).collect()
}

fn wav(samples: &[f32]) -> Vec<u8> {
    signals::wav(samples, 44_100, 1)
}

#[test]
fn a_recording_becomes_a_preset_that_plays() {
    let sandbox = Sandbox::new();
    sandbox.write("bar.wav", wav(&bar(440.0, 1.0)));
    let said = String::from_utf8(sandbox.succeeds("fit bar.wav -o bar.toml --report bar.html --modes 12")).unwrap();
    assert!(said.starts_with("Key estimated as A4 (440.00 Hz)"), "{said}");
    let preset = String::from_utf8(sandbox.read("bar.toml")).unwrap();
    assert!(preset.contains("name = \"bar\"") && preset.contains("Fitted to bar.wav."), "{preset}");
    let page = String::from_utf8(sandbox.read("bar.html")).unwrap();
    assert_eq!((page.matches("data:audio/wav").count(), page.matches("data:image/png").count()), (2, 2));
    assert!(!page.contains("{{") && !page.contains("http"), "the page needs nothing from elsewhere");
    let rows = page.split("<th scope=\"row\">").skip(1).map(|row| row.split('<').next().unwrap().parse().unwrap());
    let frequencies: Vec<f64> = rows.collect();
    assert!(frequencies.len() >= 3 && frequencies.is_sorted(), "{frequencies:?}");
    let fit = sandbox.sprung("fit bar.wav -o wrong.toml --report wrong.html --modes 12 --note G4").assert().success();
    let said = String::from_utf8(fit.get_output().stderr.clone()).unwrap();
    let warning = "bar.wav: it sounds like A4 and not like G4, its key: expected A4";
    let page = String::from_utf8(sandbox.read("wrong.html")).unwrap();
    assert!(said.contains(warning) && page.contains(warning), "{said}");
    sandbox.succeeds("presets check bar.toml");
    sandbox.succeeds("render --preset bar.toml --note A4 --length 0.5 --tail none --rate 44100 -o again.wav");
    let again = read(std::fs::File::open(sandbox.path("again.wav")).unwrap(), "again.wav").unwrap();
    let peak = again.channels[0].iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    assert!((0.3..0.8).contains(&peak), "{peak}");
    sandbox.fails("fit bar.wav -o bar.toml", 1, "bar.toml: the file exists; add --force to overwrite it");
    sandbox.fails("fit bar.wav -o bar.wav --force", 1, "--output: bar.wav: expected a name that ends in .toml");
}

#[test]
fn takes_make_a_preset_follow_velocity_and_key() {
    let sandbox = Sandbox::new();
    sandbox.write("soft.wav", wav(&bar(440.0, 0.25)));
    sandbox.write("hard.wav", wav(&bar(440.0, 1.0)));
    sandbox.succeeds("fit soft.wav@A4@50 hard.wav@A4@100 -o bar.toml --modes 6");
    let preset = String::from_utf8(sandbox.read("bar.toml")).unwrap();
    // Four times the level at twice the velocity is a square law, which is the default of a patch.
    assert!(!preset.contains("\nvelocity = "), "{preset}");
    let told = sandbox.read("bar.toml");
    sandbox.write("bar-v50.wav", sandbox.read("soft.wav"));
    sandbox.write("bar-v100.wav", sandbox.read("hard.wav"));
    let notes = |args: &str| {
        let output = sandbox.sprung(args).assert().success().get_output().stderr.clone();
        String::from_utf8(output).unwrap()
    };
    let said = notes("fit bar-v50.wav bar-v100.wav -o bar.toml --note A4 --modes 6 --force");
    assert!(said.contains("tell their velocities: 50, 100"), "{said}");
    let numbers =
        |toml: Vec<u8>| String::from_utf8(toml).unwrap().replace("soft", "bar-v50").replace("hard", "bar-v100");
    assert_eq!(numbers(sandbox.read("bar.toml")), numbers(told), "as if they were told");
    let said = notes("fit bar-v50.wav@A4@50 bar-v100.wav@A4@60 -o bar.toml --modes 6 --force");
    assert!(!said.contains("velocities"), "what is told counts: {said}");
    let said = String::from_utf8(sandbox.succeeds("fit hard.wav -o body.toml --body bar --note A4 --modes 6")).unwrap();
    assert!(said.contains("As a free bar: 3 of 3 modes are its own"), "{said}");
    assert!(String::from_utf8(sandbox.read("body.toml")).unwrap().contains("model = \"free_bar\""));
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let sandbox = Sandbox::new();
    sandbox.write("a.wav", wav(&bar(440.0, 1.0)));
    sandbox.write("nan.wav", wav(&[0.0, f32::NAN]));
    sandbox.write("silent.wav", wav(&[0.0; 10_000]));
    sandbox.write("short.wav", wav(&bar(440.0, 1.0)[..500]));
    for (args, code, message) in [
        (
            "fit nan.wav -o b.toml",
            1,
            "nan.wav: frame 1 (0.000 s) of channel 1 is not a number: expected finite samples",
        ),
        ("fit silent.wav -o b.toml", 1, "silent.wav: it is silent, or a constant: expected a strike above −80 dBFS"),
        ("fit short.wav -o b.toml", 1, "short.wav: it is shorter than 30 ms: expected a strike that rings"),
        ("fit none.wav -o b.toml", 1, "none.wav: "),
        ("fit a.wav -o b.txt", 1, "--output: b.txt: expected a name that ends in .toml"),
        ("fit a.wav -o b.toml --report b.txt", 1, "--report: b.txt: expected a name that ends in .html"),
        ("fit a.wav@H2 -o b.toml", 1, "a.wav: ‘H2’ is not a note: expected a note name (C#4)"),
        ("fit a.wav@C4 -o b.toml --note C4", 1, "its key is given twice: expected @KEY or --note"),
        ("fit a.wav -o b.toml --velocity 40,80", 1, "--velocity: 2 of them for 1 recording: expected one for each"),
        ("fit a.wav -o b.toml --body drum", 2, "invalid value 'drum'"),
        ("fit a.wav", 2, "--output"),
    ] {
        sandbox.fails(args, code, message);
    }
}

#[test]
fn sounds_that_do_not_decay_are_warned_of() {
    let sandbox = Sandbox::new();
    sandbox.write("steady.wav", wav(&signals::noise(11_025)));
    sandbox.write("loud.wav", wav(&bar(440.0, 6.0)));
    let hum = |(n, sample): (usize, f32)| sample + 0.003 * libm::sinf(TAU as f32 * 50.0 * n as f32 / 44_100.0);
    sandbox.write("hum.wav", wav(&bar(440.0, 1.0).into_iter().enumerate().map(hum).collect::<Vec<_>>()));
    for (file, warning) in [
        ("steady", "steady.wav: the sound does not decay: expected something that is struck"),
        ("loud", "loud.wav: it is fitted 1"),
        ("hum", "hum.wav: a tone of 50.00 Hz does not decay, and the preset plays it: expected no hum"),
    ] {
        let output = sandbox.sprung(&format!("fit {file}.wav -o {file}.toml --modes 16")).assert().success();
        let said = String::from_utf8(output.get_output().stderr.clone()).unwrap();
        assert!(said.contains(warning), "{said}");
        sandbox.succeeds(&format!("presets check {file}.toml"));
    }
    let preset = String::from_utf8(sandbox.read("loud.toml")).unwrap();
    let distance: f64 =
        preset.split(" dB from the recording").next().unwrap().rsplit(' ').next().unwrap().parse().unwrap();
    assert!(distance < 0.5, "{distance} dB");
}

#[test]
fn a_fit_needs_a_name_that_can_be_seen() {
    let sandbox = Sandbox::new();
    let blank = sandbox.sprung("fit bar.wav -o bar.toml").args(["--name", " "]).assert().failure().get_output().clone();
    let said = String::from_utf8(blank.stderr).unwrap();
    assert!(said.contains("--name") && said.contains("expected a name"), "{said}");
}

#[test]
fn sounds_are_drawn() {
    let sandbox = Sandbox::new();
    sandbox.succeeds("render --preset Marimba --note C4 --length 0.2 -o a.wav --figure a.svg");
    assert!(String::from_utf8(sandbox.read("a.svg")).unwrap().contains("T60 / s"));
    sandbox.succeeds("presets show Blip --figure blip.png");
    assert!(sandbox.read("blip.png").starts_with(b"\x89PNG"));
    sandbox.fails("presets show Blip --figure blip.png", 1, "blip.png: the file exists");
    sandbox.fails(
        "render --preset Blip --note C4 -o b.wav --figure b.gif",
        1,
        "expected a name that ends in .png or .svg",
    );
}
