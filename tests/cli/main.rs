//! The command `sprung` as a program: its files, messages and exit codes.

mod bad_input;
mod batches;
mod batches_at_scale;
#[cfg(unix)]
mod completion;
#[allow(dead_code, reason = "the engine's tests use more of it")]
#[path = "../engine/damped_sine.rs"]
mod damped_sine;
mod fits;
mod inputs;
#[cfg(unix)]
mod interrupts;
mod lab;
mod listings;
mod messages;
mod mpe;
mod outputs;
mod passages;
#[cfg(unix)]
mod recipes;
mod recordings;
mod samples;
mod signals;
mod songs;
mod sound;
mod stems;
mod tuning;

use assert_cmd::Command;
use midly::num::{u4, u7, u15, u28};
use midly::{Format, Header, MetaMessage, MidiMessage, Smf, Timing, TrackEvent, TrackEventKind};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A program that starts another one with default signal handling. A test suite that runs in the background or under
/// `nohup` ignores some signals, and its children inherit this.
pub(crate) const DEFAULT_SIGNALS: [&str; 2] = ["env", "--default-signal=HUP,INT,TERM"];

/// A temporary folder in which the command runs.
pub(crate) struct Sandbox(TempDir);

impl Sandbox {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        std::fs::write(self.path(name), contents).unwrap();
        self.path(name)
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    pub(crate) fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// `sprung` with these arguments, which are split at spaces.
    pub(crate) fn sprung(&self, args: &str) -> Command {
        let mut command = Command::cargo_bin("sprung").unwrap();
        // Tests must not see the user's own sounds, wherever the system keeps them.
        command.envs(["XDG_DATA_HOME", "APPDATA", "HOME"].map(|name| (name, self.path("data"))));
        command.current_dir(self.0.path()).args(args.split_whitespace());
        command
    }

    /// Runs the command, which must succeed, and returns its stdout.
    pub(crate) fn succeeds(&self, args: &str) -> Vec<u8> {
        self.sprung(args).assert().success().get_output().stdout.clone()
    }

    /// Runs the command, which must print one message, exit with this code, and neither create nor remove a file.
    pub(crate) fn fails(&self, args: &str, code: i32, message: &str) {
        let before = self.files();
        let output = self.sprung(args).assert().code(code).get_output().clone();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert!(stderr.contains(message), "{args}: expected ‘{message}’ in: {stderr}");
        assert_eq!(stderr.matches("error: ").count(), 1, "{args}: {stderr}");
        assert!(!stderr.contains("panicked"), "{args}: {stderr}");
        assert_eq!(String::from_utf8_lossy(&output.stdout), "", "{args}");
        assert_eq!(self.files(), before, "{args}");
    }

    /// The format and the stored samples of a WAV file.
    pub(crate) fn wav(&self, name: &str) -> Wav {
        Wav::read(&self.read(name))
    }
}

pub(crate) struct Wav {
    pub(crate) spec: hound::WavSpec,
    pub(crate) frames: u32,
    /// Interleaved samples; integers are scaled to ±1.
    pub(crate) samples: Vec<f64>,
}

impl Wav {
    pub(crate) fn read(bytes: &[u8]) -> Self {
        let reader = hound::WavReader::new(bytes).unwrap();
        let (spec, frames) = (reader.spec(), reader.duration());
        let samples = match spec.sample_format {
            hound::SampleFormat::Float => reader.into_samples::<f32>().map(|sample| sample.unwrap().into()).collect(),
            hound::SampleFormat::Int => {
                let full_scale = f64::from(1u32 << (spec.bits_per_sample - 1));
                reader.into_samples::<i32>().map(|sample| f64::from(sample.unwrap()) / full_scale).collect()
            }
        };
        Self { spec, frames, samples }
    }

    pub(crate) fn peak(&self) -> f64 {
        self.samples.iter().fold(0.0, |peak, sample| peak.max(sample.abs()))
    }
}

pub(crate) fn note_on(delta: u32, channel: u8, key: u8) -> TrackEvent<'static> {
    midi(delta, channel, MidiMessage::NoteOn { key: u7::new(key), vel: u7::new(100) })
}

pub(crate) fn midi(delta: u32, channel: u8, message: MidiMessage) -> TrackEvent<'static> {
    TrackEvent { delta: u28::new(delta), kind: TrackEventKind::Midi { channel: u4::new(channel), message } }
}

pub(crate) fn end(delta: u32) -> TrackEvent<'static> {
    TrackEvent { delta: u28::new(delta), kind: TrackEventKind::Meta(MetaMessage::EndOfTrack) }
}

/// A MIDI file with one track and 480 ticks per quarter note, 960 per second.
pub(crate) fn song(events: &[TrackEvent<'static>]) -> Vec<u8> {
    let header = Header::new(Format::SingleTrack, Timing::Metrical(u15::new(480)));
    let mut bytes = Vec::new();
    Smf { header, tracks: vec![events.to_vec()] }.write(&mut bytes).unwrap();
    bytes
}

pub(crate) fn exists(path: &str) -> bool {
    Path::new(path).exists()
}
