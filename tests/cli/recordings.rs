//! `sprung analyze` and `sprung diff`.

use crate::{Sandbox, signals};
use std::f64::consts::TAU;

/// A mono WAV of floats.
fn wav(samples: &[f32], sample_rate: u32) -> Vec<u8> {
    signals::wav(samples, sample_rate, 1)
}

/// Half a second of a mode of 440 Hz and a T60 of 0.5 s.
fn strike(gain: f64) -> Vec<f32> {
    let sample = |n: u32| {
        let t = f64::from(n) / 44_100.0;
        (gain * libm::exp(-6.907_755 * t / 0.5) * libm::cos(TAU * 440.0 * t)) as f32
    };
    (0..22_050).map(sample).collect()
}

#[test]
fn a_strike_is_taken_apart_into_its_modes() {
    let sandbox = Sandbox::new();
    sandbox.write("a.wav", wav(&strike(0.5), 44_100));
    let json: serde_json::Value = serde_json::from_slice(&sandbox.succeeds("analyze a.wav --json")).unwrap();
    let modes = json["modes"].as_array().unwrap();
    assert_eq!(modes.len(), 1, "{json}");
    let number = |key: &str| modes[0][key].as_f64().unwrap();
    assert!((number("frequency") - 440.0).abs() < 1e-3 && (number("t60") - 0.5).abs() < 1e-4, "{json}");
    assert!((number("level_db") + 6.02).abs() < 0.01, "{json}");
    let csv = String::from_utf8(sandbox.succeeds("analyze a.wav --csv --figure modes.png")).unwrap();
    assert!(csv.lines().count() == 2 && csv.starts_with("hit,onset_s,frequency_hz"), "{csv}");
    assert!(sandbox.read("modes.png").starts_with(b"\x89PNG"));
    let text = String::from_utf8(sandbox.succeeds("analyze a.wav")).unwrap();
    assert!(text.contains("s of it: 1 mode, ") && text.contains("  440.000 Hz    0.5000 ± "), "{text}");
    let hits: serde_json::Value = serde_json::from_slice(&sandbox.succeeds("analyze a.wav --hits --json")).unwrap();
    assert_eq!(hits["hits"].as_array().unwrap().len(), 1);
    sandbox.fails("analyze a.wav --figure modes.png", 1, "modes.png: the file exists; add --force to overwrite it");
}

#[test]
fn what_makes_a_decoder_panic_is_an_error_of_its_file() {
    let sandbox = Sandbox::new();
    sandbox.write("a.ogg", include_bytes!("../sounds/wrong-codebook.ogg"));
    let output = sandbox.sprung("analyze a.ogg").assert().code(1).get_output().clone();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(told, "sprung: error: a.ogg: no decoder can read this, so it is damaged: expected Ogg\n");
}

#[test]
fn a_rate_that_no_sound_has_is_refused_at_once() {
    let sandbox = Sandbox::new();
    sandbox.write("a.wav", wav(&strike(0.5), 44_100));
    for rate in [1_u32, 4_000_000_000] {
        let mut bytes = wav(&strike(0.5), 44_100);
        bytes[24..28].copy_from_slice(&rate.to_le_bytes());
        sandbox.write("b.wav", bytes);
        let message = format!("b.wav: its sample rate of {rate} is out of range: expected 1000 to 768000 Hz");
        for (command, code) in [
            ("analyze b.wav", 1),
            ("diff a.wav b.wav", 2),
            ("diff b.wav a.wav", 2),
            ("fit b.wav -o b.toml", 1),
            ("render --note 60 --set input_level=0 --input b.wav -o x.wav", 1),
        ] {
            sandbox.fails(command, code, &message);
        }
    }
}

/// Whether a text is JSON. All numbers in it are then finite, because JSON has no NaN and no infinity.
fn is_json(text: &[u8]) -> bool {
    serde_json::from_slice::<serde_json::Value>(text).is_ok()
}

#[test]
fn whatever_sounds_is_described_without_numbers_that_are_none() {
    let sandbox = Sandbox::new();
    let hum = |n: usize| 0.01 * libm::sin(TAU * 50.0 * n as f64 / 44_100.0) as f32;
    // Pulses of a voice that glides.
    let voice =
        |n: usize| libm::exp(30.0 * libm::sin(TAU * (120.0 + 1e-4 * n as f64) * n as f64 / 44_100.0) - 31.0) as f32;
    let strike = strike(0.5);
    let sounds: [(&str, Vec<f32>, u16, &str); 7] = [
        ("noise", signals::noise(11_025), 1, "explain little of it"),
        ("late", [vec![0.0; 9_000], strike.clone()].concat(), 1, ""),
        ("stereo", strike.iter().flat_map(|sample| [*sample, -0.5 * sample]).collect(), 2, ""),
        (
            "clipped",
            strike.iter().map(|sample| (4.0 * sample).clamp(-1.0, 1.0)).collect(),
            1,
            "the sound is clipped in ",
        ),
        ("offset", strike.iter().map(|sample| 0.2 + sample).collect(), 1, ""),
        ("hum", strike.iter().enumerate().map(|(n, sample)| sample + hum(n)).collect(), 1, "a tone of 50.0"),
        ("voice", (0..11_025).map(voice).collect(), 1, ""),
    ];
    for (name, samples, channels, warning) in sounds {
        sandbox.write(&format!("{name}.wav"), signals::wav(&samples, 44_100, channels));
        let json = sandbox.succeeds(&format!("analyze {name}.wav --modes 16 --hits --json"));
        assert!(is_json(&json), "{name}: {}", String::from_utf8_lossy(&json));
        for kind in ["", "--csv"] {
            let args = format!("analyze {name}.wav --modes 16 {kind}");
            let output = sandbox.sprung(&args).assert().success().get_output().clone();
            let [text, told] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
            assert!(!text.contains("NaN") && !text.contains("inf"), "{name}: {text}");
            assert!(told.contains(warning), "{name}: {told}");
        }
    }
}

#[test]
fn ten_minutes_are_looked_at_as_far_as_the_first_strike_goes() {
    let sandbox = Sandbox::new();
    let mut samples = strike(0.5);
    samples.resize(600 * 8_000, 0.0);
    sandbox.write("long.wav", wav(&samples, 8_000));
    let json: serde_json::Value = serde_json::from_slice(&sandbox.succeeds("analyze long.wav --json")).unwrap();
    assert!(json["seconds"].as_f64().unwrap() < 13.0 && json["modes"].as_array().unwrap().len() == 1, "{json}");
}

#[test]
fn what_is_compared_is_said() {
    let sandbox = Sandbox::new();
    let sound = strike(0.5);
    sandbox.write("a.wav", wav(&sound, 44_100));
    sandbox
        .write("twice.wav", signals::wav(&sound.iter().flat_map(|sample| [*sample; 2]).collect::<Vec<_>>(), 44_100, 2));
    sandbox.write("short.wav", wav(&sound[..11_025], 44_100));
    let run = |args: &str| {
        let output = sandbox.sprung(args).write_stdin("").assert().get_output().clone();
        (output.status.code(), String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
    };
    let (code, text, _) = run("diff a.wav twice.wav");
    assert_eq!(code, Some(1));
    assert_eq!(
        text,
        "1 channel → 2: the mono sound is compared with each channel\n\
         different, but the same samples: 22050 frames, every sample\n"
    );
    let mut broken = sound.clone();
    broken[1000] = f32::NAN;
    sandbox.write("broken.wav", wav(&broken, 44_100));
    let (code, _, warning) = run("diff a.wav broken.wav");
    assert_eq!(code, Some(1));
    assert!(warning.contains("broken.wav: frame 1000 ") && warning.contains(" is not a number: expected"), "{warning}");
    let (code, text, _) = run("diff a.wav short.wav");
    let lengths =
        "length 0.500 s → 0.250 s (22050 → 11025 frames): what is beyond the shorter one is compared with silence";
    assert!(code == Some(1) && text.starts_with(lengths), "{text}");
    let (code, _, stderr) = run("diff - -");
    assert!(code == Some(2) && stderr.contains("stdin: both sounds are read from it: expected a file"), "{stderr}");
}

#[test]
fn files_are_compared() {
    let sandbox = Sandbox::new();
    let sound = strike(0.5);
    sandbox.write("a.wav", wav(&sound, 44_100));
    sandbox.write("same.wav", wav(&sound, 44_100));
    sandbox.write("half.wav", wav(&strike(0.25), 44_100));
    let mut near = sound.clone();
    near[100] += 1e-5;
    sandbox.write("near.wav", wav(&near, 44_100));
    sandbox.write("faster.wav", wav(&sound, 48_000));
    let run = |args: &str| {
        let output = sandbox.sprung(args).assert().get_output().clone();
        (output.status.code(), String::from_utf8(output.stdout).unwrap())
    };
    assert_eq!(run("diff a.wav same.wav"), (Some(0), "the same: 22050 frames, every sample\n".to_owned()));
    let (code, text) = run("diff a.wav half.wav");
    assert!(code == Some(1) && text.contains("the same sound, in place, at -6.02 dB"), "{text}");
    let distance = text.lines().find_map(|line| line.split_once(" dB apart in 48 mel bands over time"));
    let distance: f64 = distance.expect("the distance is told").0.parse().unwrap();
    assert!((5.0..6.1).contains(&distance), "{text}");
    sandbox.write("hardly.wav", wav(&strike(0.50005), 44_100));
    let (_, text) = run("diff a.wav hardly.wav");
    assert!(text.contains("the same sound, in place, at +0.00087 dB") && text.contains("0.00 dB apart"), "{text}");
    let (code, text) = run("diff a.wav near.wav");
    assert!(code == Some(1) && text.contains("first differing frame 100, worst error -100.0 dBFS"), "{text}");
    assert_eq!(run("diff a.wav near.wav --tolerance-db -99").0, Some(0));
    assert_eq!(run("diff a.wav near.wav --tolerance-db -101").0, Some(1));
    let (code, text) = run("diff a.wav faster.wav");
    assert!(code == Some(1) && text.contains("sample rate 44100 Hz → 48000 Hz: compared at 44100 Hz"), "{text}");
    let (_, json) = run("diff a.wav half.wav --json --figure d.svg");
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(
        (&json["same"], &json["first_frame"], &json["alignment"]["shift_frames"]),
        (&false.into(), &0.into(), &0.into())
    );
    assert!((json["mel_distance_db"].as_f64().unwrap() - distance).abs() < 0.01, "{json}");
    assert!(sandbox.read("d.svg").starts_with(b"<svg"));
}

#[test]
fn what_is_no_recording_is_refused() {
    let sandbox = Sandbox::new();
    sandbox.write("a.wav", wav(&strike(0.5), 44_100));
    sandbox.write("nan.wav", wav(&[0.0, f32::NAN], 44_100));
    sandbox.write("silent.wav", wav(&[0.0; 10_000], 44_100));
    sandbox.write("empty.wav", wav(&[], 44_100));
    sandbox.write("text.wav", "a text");
    for (args, code, message) in [
        ("analyze nan.wav", 1, "nan.wav: frame 1 (0.000 s) of channel 1 is not a number: expected finite samples"),
        ("analyze silent.wav", 1, "silent.wav: it is silent, or a constant: expected a strike above −100 dBFS"),
        ("analyze empty.wav", 1, "empty.wav: there is no sound in the file: expected at least one frame"),
        ("analyze text.wav", 1, "text.wav: this is not a sound file: expected WAV, AIFF, FLAC, Ogg Vorbis or MP3"),
        ("analyze none.wav", 1, "none.wav: "),
        ("analyze a.wav --figure a.gif", 1, "--figure: a.gif: expected a name that ends in .png or .svg"),
        ("analyze a.wav --json --csv", 2, "cannot be used with"),
        ("diff a.wav text.wav", 2, "text.wav: this is not a sound file"),
        ("diff a.wav none.wav", 2, "none.wav: "),
        ("diff a.wav", 2, "<ACTUAL>"),
        ("diff a.wav a.wav --tolerance-db 3", 2, "3 is out of range: expected -300 to 0 dBFS"),
    ] {
        sandbox.fails(args, code, message);
    }
}
