//! `sprung play` on ALSA's file plugin: the samples of the device and of the recording, and errors.

use super::sandbox::{Running, Sandbox, song, sprung, text, wait_until};
use std::fs::File;
use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::thread::JoinHandle;
use std::time::Duration;

/// Factor by which the reader is faster than real time.
const HASTE: u32 = 4;

/// Maximum number of bytes that a reader accepts: a minute of stereo floats.
const MOST: usize = 60 * 48_000 * 8;

const FRAME: usize = 8;

/// A sound device that is a named pipe, with a reader that reads as fast as a quick sound card would. Nothing is
/// written to a disk.
struct Device {
    sandbox: Sandbox,
    /// The bytes it has read, available when all writers have closed the pipe.
    reader: JoinHandle<Vec<u8>>,
}

impl Device {
    /// A device that accepts floats and integers, or integers only, with ALSA's `linear` plugin.
    fn new(integers: bool) -> Self {
        let sandbox = Sandbox::new();
        let pipe = sandbox.path("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let file = format!("type file\n slave.pcm {{ type null }}\n file \"{}\"\n format \"raw\"", pipe.display());
        let hint = "hint { show on\n description \"A pipe\" }";
        let config = if integers {
            format!(
                "pcm.pipe {{ {file} }}\npcm.default {{ type linear\n slave {{ pcm \"pipe\"\n format S32_LE }}\n {hint} }}"
            )
        } else {
            format!("pcm.default {{ {file}\n {hint} }}")
        };
        sandbox.write("asound.conf", config);
        let reader = std::thread::spawn(move || read_at_a_pace(pipe));
        Self { sandbox, reader }
    }

    /// Starts `sprung` with limits on file size and running time; stderr goes to the file `stderr`.
    fn start(&self, arguments: &str) -> Running {
        self.start_in("ulimit -f 200000", arguments)
    }

    fn start_in(&self, shell: &str, arguments: &str) -> Running {
        let program = sprung(arguments);
        let child = Command::new("sh")
            .arg("-c")
            .arg(format!("{shell}; exec timeout -k 5 60 \"$0\" \"$@\""))
            .arg(program.get_program())
            .args(program.get_args())
            .current_dir(self.sandbox.folder())
            .env("ALSA_CONFIG_PATH", self.sandbox.path("asound.conf"))
            .stdin(Stdio::null())
            .stderr(File::create(self.sandbox.path("stderr")).unwrap())
            .spawn();
        Running(child.unwrap())
    }

    fn stderr(&self) -> String {
        text(&self.sandbox.path("stderr"))
    }
}

pub(super) fn read_at_a_pace(pipe: PathBuf) -> Vec<u8> {
    let mut pipe = File::open(pipe).unwrap();
    let pace = Duration::from_millis(5);
    let mut taken = Vec::new();
    let mut portion = vec![0; FRAME * 240 * HASTE as usize];
    loop {
        let len = pipe.read(&mut portion).unwrap();
        if len == 0 || taken.len() > MOST {
            return taken;
        }
        taken.extend(&portion[..len]);
        std::thread::sleep(pace);
    }
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.chunks_exact(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect()
}

fn integers(bytes: &[u8]) -> Vec<i32> {
    bytes.chunks_exact(4).map(|bytes| i32::from_le_bytes(bytes.try_into().unwrap())).collect()
}

/// A MIDI file of some bars, with chords, quick repetitions and a rest.
fn tune() -> Vec<u8> {
    let scale = (0..24).map(|n| (n * 40, 100, 48 + (n * 7 % 25) as u8));
    let chord = [60, 64, 67].map(|key| (1100, 400, key));
    song(&scale.chain(chord).collect::<Vec<_>>())
}

#[track_caller]
fn assert_same_bits(found: &[f32], expected: &[f32]) {
    assert!(found.len() >= expected.len(), "{} samples where {} were expected", found.len(), expected.len());
    let differing = found.iter().zip(expected).position(|(a, b)| a.to_bits() != b.to_bits());
    assert_eq!(differing, None, "the first sample that differs");
    assert!(found[expected.len()..].iter().all(|sample| *sample == 0.0), "silence after the end");
}

#[test]
fn a_song_reaches_the_device_and_the_recording_with_the_bits_of_render() {
    for buffer in ["64", "1000"] {
        let device = Device::new(false);
        device.sandbox.write("tune.mid", tune());
        device.sandbox.succeeds("render tune.mid --preset kick --set decay=0.4 --seed 3 --bits 32f -o expected.wav");
        let arguments = format!(
            "play tune.mid --preset kick --set decay=0.4 --seed 3 --buffer {buffer} --midi-in none --record take.wav"
        );
        assert_eq!(device.start(&arguments).wait(), Some(0), "{}", device.stderr());
        let (expected, recorded) = (device.sandbox.floats("expected.wav"), device.sandbox.floats("take.wav"));
        let stderr = device.stderr();
        assert!(stderr.contains(&format!("in blocks of {buffer} frames, heard ")), "{stderr}");
        assert!(stderr.contains(" ms after their keys: 0 xruns"), "{stderr}");
        let captured = floats(&device.reader.join().unwrap());
        assert!(expected.iter().any(|sample| sample.abs() > 0.1), "it sounds");
        assert_same_bits(&captured, &expected);
        assert_same_bits(&recorded, &expected);
        // ALSA's plugin writes in portions of its own size and may not write the last one.
        assert!(recorded.len() >= captured.len(), "{} recorded, {} captured", recorded.len(), captured.len());
    }
}

#[test]
fn integers_are_the_rounded_floats() {
    let device = Device::new(true);
    device.sandbox.write("tune.mid", tune());
    device.sandbox.succeeds("render tune.mid --bits 32f -o expected.wav");
    let code = device.start("play tune.mid --headless --midi-in none").wait();
    assert!(code == Some(0) && device.stderr().contains("2 × i32"), "{}", device.stderr());
    let captured = integers(&device.reader.join().unwrap());
    let expected = device.sandbox.floats("expected.wav");
    assert!(captured.len() >= expected.len());
    let step = |sample: f32| (f64::from(sample) * 2_147_483_648.0).round_ties_even() as i32;
    let differing = captured.iter().zip(&expected).position(|(found, sample)| *found != step(*sample));
    assert_eq!(differing, None, "the first sample that differs");
}

#[test]
fn an_interrupt_releases_the_notes_and_completes_the_recording() {
    let device = Device::new(false);
    device.sandbox.write("long.mid", song(&[(0, 100_000, 60), (480, 100_000, 67)]));
    let arguments = "play long.mid --midi-in none --record take.wav --set decay=\"60s\" --set release=\"200ms\"";
    let child = device.start(&arguments.replace('"', ""));
    std::thread::sleep(Duration::from_millis(1000));
    wait_until("it plays", || device.stderr().contains("playing on"));
    assert_eq!(child.interrupt(), Some(0), "{}", device.stderr());
    let recorded = device.sandbox.floats("take.wav");
    let peak = |samples: &[f32]| samples.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    assert!(peak(&recorded) > 0.05);
    assert!(peak(&recorded[recorded.len() - 8..]) < 1e-4, "the notes were let go");
    assert_same_bits(&recorded, &floats(&device.reader.join().unwrap()));
}

#[test]
fn a_full_disk_ends_the_recording_and_keeps_it() {
    let device = Device::new(false);
    device.sandbox.write("tune.mid", tune());
    device.sandbox.succeeds("render tune.mid --bits 32f -o expected.wav");
    // A file size limit has the same effect as a full disk: 256 KiB.
    let child =
        device.start_in("trap '' XFSZ; ulimit -f 512", "play tune.mid --midi-in none --record take.wav --headless");
    assert_eq!(child.wait(), Some(1), "{}", device.stderr());
    let stderr = device.stderr();
    assert!(stderr.contains("recording has stopped") && stderr.contains("take.wav: File too large"), "{stderr}");
    let (expected, recorded) = (device.sandbox.floats("expected.wav"), device.sandbox.floats("take.wav"));
    assert!(recorded.len() > 50_000 && recorded.len() < expected.len(), "{} samples kept", recorded.len());
    assert_same_bits(&expected[..recorded.len()], &recorded);
    assert_same_bits(&floats(&device.reader.join().unwrap()), &expected);
}

#[test]
fn what_cannot_be_played_on_says_what_can() {
    let sandbox = Sandbox::new();
    let slave = "slave { pcm { type null }\n rate 44100\n channels 2\n format S16_LE }";
    sandbox.write(
        "asound.conf",
        format!("pcm.fixed {{ type hw\n card 0\n hint {{ show on\n description \"No card\" }} }}\npcm.some {{ type plug\n {slave}\n hint {{ show on\n description \"Some\" }} }}"),
    );
    for (arguments, code, expected) in [
        ("play", 1, "there is no sound device to play on: ALSA has none"),
        ("play --device sone", 1, "--device: ALSA has no device ‘sone’, or several; the nearest is ‘some’; ‘--list’"),
        ("play --device fixed", 1, "--device: ‘fixed’ cannot be used: "),
        ("play --host tape", 1, "--host: there is no ‘tape’ here: expected "),
        ("play --rate 700", 2, "700 is out of range: expected 1000 to 768000 Hz"),
        ("play --record /dev/null --device some", 1, "--record: /dev/null is a pipe or device: expected a file"),
        ("play none.mid", 1, "none.mid: No such file"),
        ("play --device some --preset kcik", 1, "the nearest is ‘Kick’"),
    ] {
        let output = sprung(arguments).env("ALSA_CONFIG_PATH", sandbox.path("asound.conf")).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments}: {stderr}");
        assert!(stderr.contains(expected) && !stderr.contains("ALSA lib"), "{arguments}: {stderr}");
    }
    let list = sprung("play --list")
        .env("ALSA_CONFIG_PATH", sandbox.path("asound.conf"))
        .stdout(Stdio::piped())
        .output()
        .unwrap();
    let list = String::from_utf8(list.stdout).unwrap();
    assert!(list.contains("--host alsa\n") && list.contains("  --device \"some\"  Some\n"), "{list}");
    assert!(list.contains("MIDI\n"), "{list}");
}

#[test]
fn controllers_are_learnt_listed_and_forgotten() {
    let sandbox = Sandbox::new();
    let run = |options: &str| {
        let mut command = sprung(&format!("play --list {options}"));
        let output = command.env("XDG_DATA_HOME", sandbox.folder()).stdout(Stdio::piped()).output().unwrap();
        let [stdout, stderr] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        let listed = stdout.split_once("Controllers of parameters\n").map(|(_, listed)| listed.to_owned());
        (listed.ok_or(output.status.code()), stderr)
    };
    assert_eq!(run(""), (Ok("  none\n".to_owned()), String::new()));
    let two = "  --learn decay=21\n  --learn space_mix=22\n";
    assert_eq!(run("--learn decay=21 --learn space_mix=22").0.as_deref(), Ok(two));
    assert_eq!(run("").0.as_deref(), Ok(two), "they are kept");
    assert_eq!(run("--forget decay --learn tilt=22").0.as_deref(), Ok("  --learn tilt=22\n"));
    for (options, expected) in [
        (
            "--learn tilt=32",
            "controller 32 selects banks, and cannot move a parameter: expected 1 to 119 without 6, 32",
        ),
        ("--learn tilt=128", "controller 128 is out of range: expected 0 to 127"),
        ("--learn tlit=1", "there is no parameter ‘tlit’; the nearest is ‘tilt’"),
        ("--learn tilt", "expected ID=CONTROLLER, as in decay=21"),
        ("--forget tlit", "the nearest is ‘tilt’"),
    ] {
        let (listed, stderr) = run(options);
        assert!(listed == Err(Some(2)) && stderr.contains(expected), "{options}: {stderr}");
    }
    let file = sandbox.path("sprung/controllers.toml");
    std::fs::write(&file, "tilt is 22\n").unwrap();
    let (listed, warning) = run("");
    assert!(listed.is_ok_and(|listed| listed == "  none\n") && warning.contains("controllers.toml"), "{warning}");
    assert_eq!(run("--learn tilt=23").0, Err(Some(1)));
    assert_eq!(text(&file), "tilt is 22\n", "not written over");
}
