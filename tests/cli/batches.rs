//! `sprung batch`: files, manifest, resuming after a kill, shards, and errors in jobs.

use crate::{Sandbox, Wav, end, midi, song};
use midly::MidiMessage;
use midly::num::u7;
use serde_json::Value;
use sha2::{Digest, Sha256};
use sprung::preset::Preset;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// Short sounds, since debug builds render them.
const JOBS: &str = r#"{"preset": "Kick", "note": "C2", "length": 0.1, "tail": "none", "repeat": 20, "decay": {"log_uniform": ["50 ms", 2]}, "velocity": {"uniform": [40, 127]}}

{"note": {"choice": [["C4", "E4"], "A4"]}, "length": "50 ms", "tail": 0.05, "rate": 8000, "bits": 16, "set": {"tune": {"normal": [0, 2]}}, "seed": 5}
{"preset": "Marimba", "note": {"integer": [48, 72]}, "length": 0.1, "tail": "none", "mono": true, "repeat": 4}
"#;
const COUNT: usize = 25;

/// Every file below a folder, with its contents.
pub(crate) fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                all.insert(path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap());
            }
        }
    }
    all
}

fn lines(sandbox: &Sandbox, manifest: &str) -> Vec<Value> {
    let text = String::from_utf8(sandbox.read(manifest)).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

pub(crate) fn start(sandbox: &Sandbox, args: &str) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sprung"));
    command.current_dir(sandbox.path("")).args(args.split_whitespace()).stderr(Stdio::null());
    command.spawn().unwrap()
}

#[test]
fn two_strikes_of_a_key_in_one_tick_have_a_label_each() {
    let sandbox = Sandbox::new();
    let strike = |velocity: u8| midi(0, 0, MidiMessage::NoteOn { key: u7::new(69), vel: u7::new(velocity) });
    let off = midi(480, 0, MidiMessage::NoteOff { key: u7::new(69), vel: u7::new(64) });
    sandbox.write("two.mid", song(&[strike(127), strike(20), off, end(0)]));
    sandbox.write("jobs.jsonl", r#"{"song": "two.mid", "preset": "init", "programs": "none"}"#);
    sandbox.succeeds("batch jobs.jsonl --out all");
    let line = &lines(&sandbox, "all/manifest.jsonl")[0];
    let notes = line["notes"].as_array().unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    assert_eq!(notes.iter().map(|note| number(&note["onset"])).collect::<Vec<_>>(), [0.0, 0.0], "{line}");
    let [hard, soft] = [127.0, 20.0].map(|velocity: f64| velocity / 127.0);
    assert!((number(&notes[0]["velocity"]) - hard).abs() < 1e-6 && (number(&notes[1]["velocity"]) - soft).abs() < 1e-6);
    // The force is the square of the velocity.
    let [first, second] = [0, 1].map(|note: usize| number(&notes[note]["modes"][0]["level_db"]));
    assert!((first - second + 40.0 * libm::log10(soft)).abs() < 0.01, "{first} dB, {second} dB");
}

#[test]
fn a_manifest_says_what_every_file_is() {
    let sandbox = Sandbox::new();
    sandbox.write("jobs.jsonl", JOBS);
    sandbox.succeeds("batch jobs.jsonl --out all --seed 3");
    let lines = lines(&sandbox, "all/manifest.jsonl");
    assert_eq!(lines.len(), COUNT);
    assert_eq!(files(&sandbox.path("all")).len(), COUNT + 1, "nothing else is there");
    for (number, line) in lines.iter().enumerate() {
        let bytes = sandbox.read(&format!("all/{}", line["file"].as_str().unwrap()));
        let hash: String = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!((line["number"].as_u64(), line["sha256"].as_str()), (Some(number as u64), Some(&*hash)));
        let wav = Wav::read(&bytes);
        assert_eq!(line["frames"].as_u64(), Some(wav.frames.into()));
        let peak = sprung::units::db_from_gain(wav.peak());
        assert!((line["peak_dbfs"].as_f64().unwrap() - peak).abs() < 0.01, "{line}");
        let modes = line["notes"][0]["modes"].as_array().unwrap();
        assert!(!modes.is_empty() && modes.iter().all(|mode| mode["frequency"].as_f64().unwrap() > 0.0), "{line}");
    }
    let decays: Vec<f64> = lines[..20].iter().map(|line| line["job"]["decay"].as_f64().unwrap()).collect();
    assert!(decays.iter().all(|decay| (0.05..=2.0).contains(decay)), "{decays:?}");
    assert!(decays.windows(2).any(|pair| pair[0] != pair[1]), "{decays:?}");
    assert_eq!(lines[20]["seed"], 5);
    assert!(lines.iter().all(|line| line["version"] == env!("CARGO_PKG_VERSION")));
    // The patch's decay is the T60 of the mode that sets the pitch.
    for (line, decay) in lines.iter().zip(decays) {
        let modes = line["notes"][0]["modes"].as_array().unwrap();
        let is_decay = |mode: &Value| (mode["t60"].as_f64().unwrap() / decay - 1.0).abs() < 1e-6;
        assert_eq!(modes.iter().filter(|mode| is_decay(mode)).count(), 1, "{line}");
    }
}

#[test]
fn a_job_is_what_render_makes_of_it() {
    let sandbox = Sandbox::new();
    sandbox.write("jobs.jsonl", JOBS);
    sandbox.succeeds("batch jobs.jsonl --out all");
    let line = &lines(&sandbox, "all/manifest.jsonl")[7];
    let [decay, velocity] = ["decay", "velocity"].map(|key| line["job"][key].to_string());
    let seed = line["seed"].to_string();
    sandbox.succeeds(&format!(
        "render --preset Kick --note C2 --length 0.1 --tail none --set decay={decay} --velocity {velocity} --seed {seed} -o one.wav"
    ));
    assert!(sandbox.read("one.wav") == sandbox.read("all/0000/0000007.wav"));
}

#[test]
fn what_is_there_is_neither_replaced_nor_read_while_it_is_written() {
    let sandbox = Sandbox::new();
    let job = r#"{"note": "C2", "length": 0.01, "tail": "none"}"#;
    sandbox.write("jobs.jsonl", job);
    fs::create_dir_all(sandbox.path("sounds/0000")).unwrap();
    sandbox.write("sounds/0000/0000000.wav", "mine");
    let message = "0000000.wav: the file exists: add --resume if it is of this batch, or choose another folder";
    sandbox.fails("batch jobs.jsonl --out sounds", 1, message);
    assert_eq!(sandbox.read("sounds/0000/0000000.wav"), b"mine");
    // A job's input may not be a file that another job writes, whether or not that file exists already.
    for (out, input) in [
        ("sounds", "sounds/0000/0000000.wav"),
        ("sounds", "./sounds/../sounds/0000/0000007.wav"),
        (".", "0000/0000000.wav"),
    ] {
        sandbox.write("jobs.jsonl", format!("{job}\n{}", job.replace('{', &format!("{{\"input\": \"{input}\", "))));
        let message = format!("jobs.jsonl:2: input: ‘{input}’ is a file that this batch writes");
        sandbox.fails(&format!("batch jobs.jsonl --out {out} --resume"), 1, &message);
    }
    assert_eq!(sandbox.read("sounds/0000/0000000.wav"), b"mine");
}

#[test]
fn what_only_a_kit_names_is_not_replaced() {
    let sandbox = Sandbox::new();
    fs::create_dir(sandbox.path("0000")).unwrap();
    let preset = Preset::find("Kick").unwrap().to_toml();
    for name in ["0000/0000000.wav", "0000/mine.wav"] {
        sandbox.write(name, &preset);
    }
    let plain = r#""note": "C2", "length": 0.01, "tail": "none"}"#;
    let kit = |file: &str| format!("kit = 1\nname = \"k\"\nkeys = [{{ key = 36, sound = '{file}' }}]");
    sandbox.write("list.toml", "programs = 1\nname = \"l\"\nsounds = [\"./kit.toml\"]");
    for option in [r#""preset": "kit.toml""#, r#""channel": {"10": "kit.toml"}"#, r#""programs": "list.toml""#] {
        let key = if option.contains("channel") { "channel.10" } else { option.split('"').nth(1).unwrap() };
        sandbox.write("jobs.jsonl", format!("{{{plain}\n{{{option}, {plain}"));
        sandbox.write("kit.toml", kit("0000/0000000.wav"));
        let file = sandbox.path("0000/0000000.wav").canonicalize().unwrap();
        let message = format!("jobs.jsonl:2: {key}: ‘{}’ is a file that this batch writes", file.display());
        sandbox.fails("batch jobs.jsonl --out . --resume", 1, &message);
        assert_eq!(sandbox.read("0000/0000000.wav"), preset.as_bytes());
    }
    // A kit may read another file in the same folder.
    sandbox.write("kit.toml", kit("0000/mine.wav"));
    sandbox.write("jobs.jsonl", format!(r#"{{"preset": "kit.toml", {plain}"#));
    fs::remove_file(sandbox.path("0000/0000000.wav")).unwrap();
    sandbox.succeeds("batch jobs.jsonl --out . --resume");
    assert_eq!(sandbox.read("0000/mine.wav"), preset.as_bytes());
}

#[test]
fn only_manifests_are_taken_for_manifests() {
    let sandbox = Sandbox::new();
    let job = r#"{"note": "C2", "length": 0.01, "tail": "none"}"#;
    // A file of jobs may have a name that begins like a manifest's.
    for name in ["manifest-of-jobs.jsonl", "manifesto.jsonl", "manifest-1-of-.jsonl"] {
        sandbox.write(name, job);
        sandbox.succeeds(&format!("batch {name} --out . --resume"));
    }
    // The last line has no line feed, so resuming the file as a manifest would cut that line off.
    fs::create_dir(sandbox.path("out")).unwrap();
    for name in ["out/manifest.jsonl", "out/manifest-2-of-3.jsonl"] {
        sandbox.write(name, job);
        for args in ["", " --resume", " --resume --shard 2/3"] {
            sandbox.fails(&format!("batch {name} --out out{args}"), 1, "this batch writes this file itself");
            assert_eq!(sandbox.read(name), job.as_bytes());
        }
    }
    fs::hard_link(sandbox.path("out/manifest.jsonl"), sandbox.path("jobs.jsonl")).unwrap();
    sandbox.fails("batch jobs.jsonl --out out --resume", 1, "jobs.jsonl: this batch writes this file itself");
    assert_eq!(sandbox.read("jobs.jsonl"), job.as_bytes());
}

#[test]
fn killed_anywhere_and_gone_on_with_it_is_the_same() {
    let sandbox = Sandbox::new();
    sandbox.write("jobs.jsonl", JOBS);
    sandbox.succeeds("batch jobs.jsonl --out whole");
    let whole = files(&sandbox.path("whole"));
    let mut broken_off = 0;
    let made = || {
        let lines = fs::read(sandbox.path("parts/manifest.jsonl")).unwrap_or_default();
        lines.iter().filter(|byte| **byte == b'\n').count()
    };
    // Each run is killed when the manifest has this many lines.
    for lines in [1, 3, 8, 16] {
        let mut child = start(&sandbox, "batch jobs.jsonl --out parts --resume");
        while made() < lines && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        broken_off += usize::from((1..COUNT).contains(&made()));
    }
    assert!(broken_off > 0, "it was never killed in the middle");
    // The manifest ends within a line, one sound file is incomplete, and one is missing.
    sandbox.succeeds("batch jobs.jsonl --out parts --resume");
    let manifest = sandbox.read("parts/manifest.jsonl");
    sandbox.write("parts/manifest.jsonl", &manifest[..manifest.len() / 2]);
    fs::write(sandbox.path("parts/0000/0000001.wav"), "half").unwrap();
    fs::remove_file(sandbox.path("parts/0000/0000000.wav")).unwrap();
    sandbox.succeeds("batch jobs.jsonl --out parts --resume");
    assert!(files(&sandbox.path("parts")) == whole);
    // With nothing left to do, nothing changes.
    sandbox.succeeds("batch jobs.jsonl --out parts --resume --jobs 1");
    assert!(files(&sandbox.path("parts")) == whole);
}

#[test]
fn four_shards_are_the_whole() {
    let sandbox = Sandbox::new();
    sandbox.write("jobs.jsonl", JOBS);
    sandbox.succeeds("batch jobs.jsonl --out whole --jobs 3");
    for shard in [3, 1, 4, 2] {
        sandbox.succeeds(&format!("batch jobs.jsonl --out parts --shard {shard}/4"));
    }
    let kinds = |name: &str| -> Vec<String> {
        fs::read_dir(sandbox.path(name))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect()
    };
    assert!(!kinds("parts").contains(&"manifest.jsonl".to_owned()));
    // The shards' sounds are used as they are: none is rendered again.
    let output = sandbox.sprung("batch jobs.jsonl --out parts --resume").assert().success().get_output().clone();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("0 sounds") && told.contains("25 found finished"), "{told}");
    let mut parts = files(&sandbox.path("parts"));
    parts.retain(|path, _| !path.to_string_lossy().contains("-of-"));
    assert!(parts == files(&sandbox.path("whole")));
}

#[test]
fn another_version_does_not_go_on() {
    let sandbox = Sandbox::new();
    sandbox.write("jobs.jsonl", r#"{"note": "C2", "length": 0.01, "tail": "none", "repeat": 2}"#);
    sandbox.succeeds("batch jobs.jsonl --out sounds");
    let manifest = String::from_utf8(sandbox.read("sounds/manifest.jsonl")).unwrap();
    let own = format!("\"version\":\"{}\"", env!("CARGO_PKG_VERSION"));
    let other = manifest.replace(&own, "\"version\":\"0.0.7\"");
    assert_ne!(manifest, other);
    sandbox.write("sounds/manifest.jsonl", &other);
    let message = "manifest.jsonl: version 0.0.7 has made job 0, and this is version";
    sandbox.fails("batch jobs.jsonl --out sounds --resume", 1, message);
    sandbox.fails("batch jobs.jsonl --out sounds --resume --shard 1/2", 1, "or choose a new folder");
    assert_eq!(sandbox.read("sounds/manifest.jsonl"), other.as_bytes());
}

#[test]
fn a_shard_that_was_cut_off_within_a_character_is_gone_on_with() {
    let sandbox = Sandbox::new();
    let kick = sandbox.succeeds("presets show Kick");
    sandbox.write("‘kick’.toml", kick);
    let job = r#"{"preset": "‘kick’.toml", "note": "C2", "length": 0.01, "tail": "none", "repeat": 8}"#;
    sandbox.write("jobs.jsonl", job);
    sandbox.succeeds("batch jobs.jsonl --out whole");
    sandbox.succeeds("batch jobs.jsonl --out parts --shard 1/4");
    let name = "parts/manifest-1-of-4.jsonl";
    let manifest = sandbox.read(name);
    let last = manifest.windows(3).rposition(|bytes| bytes == "‘".as_bytes()).unwrap();
    sandbox.write(name, &manifest[..last + 1]);
    sandbox.succeeds("batch jobs.jsonl --out parts --resume");
    assert!(sandbox.read("parts/manifest.jsonl") == sandbox.read("whole/manifest.jsonl"));
}

#[test]
fn a_flac_has_the_samples_of_the_wav() {
    let sandbox = Sandbox::new();
    sandbox.write("jobs.jsonl", JOBS);
    sandbox.succeeds("batch jobs.jsonl --out wav");
    sandbox.succeeds("batch jobs.jsonl --out flac --format flac");
    for number in [0, 19, 20, 24] {
        let path = |format: &str| sandbox.path(&format!("{format}/0000/{number:07}.{format}"));
        let [wav, flac] = ["wav", "flac"].map(|format| {
            let file = fs::File::open(path(format)).unwrap();
            sprung::io::sound_file::read(file, format).unwrap()
        });
        assert_eq!(wav.sample_rate, flac.sample_rate);
        assert!(wav.channels == flac.channels && wav.channels[0].iter().any(|sample| *sample != 0.0), "{number}");
    }
    let [wav, flac] = ["wav", "flac"].map(|format| lines(&sandbox, &format!("{format}/manifest.jsonl")));
    assert!(wav.iter().zip(&flac).all(|(wav, flac)| wav["notes"] == flac["notes"] && wav["job"] == flac["job"]));
}

#[test]
fn wrong_jobs_are_named_by_line_and_key() {
    let sandbox = Sandbox::new();
    // A byte order mark is no part of a job.
    sandbox.write("marked.jsonl", "\u{feff}{\"note\": \"C2\", \"length\": 0.01}\n");
    sandbox.succeeds("batch marked.jsonl --out marked");
    for (line, message) in [
        ("{", "jobs.jsonl:2: line: no JSON: "),
        ("[1]", "jobs.jsonl:2: line: expected an object, as in"),
        (r#"{"preset": "Kick"}"#, "jobs.jsonl:2: note: expected either a song or notes"),
        (r#"{"note": "H9"}"#, "jobs.jsonl:2: note: "),
        (
            r#"{"note": "C2", "velocty": 3}"#,
            "jobs.jsonl:2: velocty: there is no option or parameter ‘velocty’; the nearest is ‘velocity’",
        ),
        (
            r#"{"note": "C2", "decay": 1, "set": {"decay": 2}}"#,
            "jobs.jsonl:2: set.decay: ‘decay’ is in the line as well: expected it once",
        ),
        (
            r#"{"note": "C2", "length": 1, "note": "C3"}"#,
            "jobs.jsonl:2: note: one object has it twice: expected it once",
        ),
        (
            r#"{"note": "C2", "set": {"decay": 1, "decay": 2}}"#,
            "jobs.jsonl:2: decay: one object has it twice: expected it once",
        ),
        (r#"{"note": "C2", "decay": "2 m"}"#, "jobs.jsonl:2: decay: ‘2 m’ is not a number in s"),
        (
            r#"{"note": "C2", "set": {"deacy": 1}}"#,
            "jobs.jsonl:2: set.deacy: there is no parameter ‘deacy’; the nearest is ‘decay’",
        ),
        (r#"{"note": "C2", "decay": {"uniform": [0, 2]}}"#, "jobs.jsonl:2: decay: 0 is out of range"),
        (r#"{"note": "C2", "decay": {"uniform": [2, 1]}}"#, "jobs.jsonl:2: decay: 2 is above 1"),
        (r#"{"note": "C2", "decay": {"gauss": [2, 1]}}"#, "jobs.jsonl:2: decay: ‘gauss’ is no way to draw"),
        (r#"{"note": "C2", "gain": {"log_uniform": [-3, 1]}}"#, "jobs.jsonl:2: gain: log_uniform from -3"),
        (r#"{"note": "C2", "preset": {"uniform": [1, 2]}}"#, "jobs.jsonl:2: preset: it is no number: expected choice"),
        (
            r#"{"note": "C2", "velocity": {"uniform": [0, 127]}}"#,
            "jobs.jsonl:2: velocity: 0 is out of range: expected 1 to 127",
        ),
        (r#"{"note": "C2", "repeat": 0}"#, "jobs.jsonl:2: repeat: expected a whole number from 1"),
        (r#"{"song": "-"}"#, "jobs.jsonl:2: song: expected a file"),
        (r#"{"note": "C2", "dither": true, "bits": "32f"}"#, "jobs.jsonl:2: dither: floats are not rounded"),
        // Every possible choice is checked, not only the last one.
        (r#"{"song": {"choice": ["-", "a.mid"]}}"#, "jobs.jsonl:2: song: expected a file"),
        (
            r#"{"note": "C2", "dither": {"choice": [true, false]}, "bits": {"choice": ["32f", 16]}}"#,
            "jobs.jsonl:2: dither: floats are not rounded",
        ),
        (
            r#"{"note": "C2", "gain_db": {"uniform": [-3, 0]}, "normalize": {"choice": ["peak=-1"]}}"#,
            "jobs.jsonl:2: normalize: expected it without",
        ),
        (
            r#"{"note": "C2", "gain_db": {"normal": [0, 1]}, "normalize": "peak=-1"}"#,
            "jobs.jsonl:2: normalize: expected it without",
        ),
        (r#"{"note": "C2", "keymap": "a.kbm"}"#, "jobs.jsonl:2: keymap: expected --scale"),
        (
            r#"{"note": {"choice": [60.5, 60]}, "scale": {"choice": ["a.scl", "b.scl"]}}"#,
            "jobs.jsonl:2: note: ‘60.5’ is no key",
        ),
    ] {
        sandbox.write("jobs.jsonl", format!("{{\"note\": \"C2\", \"length\": 0.01, \"tail\": \"none\"}}\n{line}\n"));
        sandbox.fails("batch jobs.jsonl --out sounds", 1, message);
    }
    for (line, message) in [
        (r#"{"note": "C2", "bits": {"choice": ["32f", 24]}}"#, "jobs.jsonl:2: bits: FLAC has no floats"),
        (r#"{"note": "C2", "rate": {"uniform": [8000, 96001]}}"#, "jobs.jsonl:2: rate: 96001 Hz is too high for FLAC"),
        (
            r#"{"note": "C2", "rate": {"choice": ["192k", "48k"]}}"#,
            "jobs.jsonl:2: rate: 192000 Hz is too high for FLAC",
        ),
    ] {
        sandbox.write("jobs.jsonl", format!("{{\"note\": \"C2\", \"length\": 0.01, \"tail\": \"none\"}}\n{line}\n"));
        sandbox.fails("batch jobs.jsonl --out sounds --format flac", 1, message);
    }
    #[cfg(unix)]
    {
        let pipe = sandbox.sprung("batch /dev/stdin --out sounds").write_stdin("{\"note\": \"C2\"}").assert().code(1);
        let told = String::from_utf8(pipe.get_output().stderr.clone()).unwrap();
        assert!(told.contains("/dev/stdin: jobs are read twice") && told.contains("expected a file"), "{told}");
        assert!(!sandbox.path("sounds").exists());
    }
    sandbox.fails("batch none.jsonl --out sounds", 1, "none.jsonl: ");
    sandbox.fails("batch jobs.jsonl --out sounds --shard 5/4", 2, "there is no part 5 of 4: expected 1/4 to 4/4");
}

#[test]
fn a_batch_that_failed_before_its_first_sound_can_be_mended() {
    let sandbox = Sandbox::new();
    let job = r#"{"note": "C2", "length": 0.01, "tail": "none", "preset": "Kcik"}"#;
    sandbox.write("jobs.jsonl", job);
    sandbox.sprung("batch jobs.jsonl --out sounds").assert().code(1);
    sandbox.write("jobs.jsonl", job.replace("Kcik", "Kick"));
    sandbox.succeeds("batch jobs.jsonl --out sounds");
    assert_eq!(lines(&sandbox, "sounds/manifest.jsonl").len(), 1);
}

#[test]
fn what_cannot_be_loaded_ends_the_batch_and_leaves_what_is_finished() {
    let sandbox = Sandbox::new();
    let first = r#"{"note": "C2", "length": 0.01, "tail": "none"}"#;
    sandbox.write("jobs.jsonl", format!("{first}\n{{\"note\": \"C2\", \"preset\": \"Kcik\"}}\n"));
    let output = sandbox.sprung("batch jobs.jsonl --out sounds --jobs 1").assert().code(1).get_output().clone();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("jobs.jsonl:2: ") && told.contains("‘Kick’"), "{told}");
    assert_eq!(lines(&sandbox, "sounds/manifest.jsonl").len(), 1);
    let again = "manifest.jsonl: a batch is there already: add --resume to go on with it";
    sandbox.fails("batch jobs.jsonl --out sounds", 1, again);
    sandbox.write("jobs.jsonl", format!("{first}\n{first}\n"));
    sandbox.succeeds("batch jobs.jsonl --out sounds --resume");
    assert_eq!(lines(&sandbox, "sounds/manifest.jsonl").len(), 2);
    // Other jobs do not resume this batch.
    sandbox.write("jobs.jsonl", first.replace("C2", "C3"));
    sandbox.fails("batch jobs.jsonl --out sounds --resume", 1, "2 jobs are finished there, of 1");
    sandbox.write("jobs.jsonl", format!("{0}\n{0}\n", first.replace("C2", "C3")));
    sandbox.fails("batch jobs.jsonl --out sounds --resume --jobs 1", 1, "job 0 is another there than in jobs.jsonl:1");
}
