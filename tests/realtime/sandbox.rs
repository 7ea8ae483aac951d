//! The environment in which `sprung` runs: its directory, its processes, and a song to play.

use midly::num::{u4, u7, u15, u28};
use midly::{Format, Header, MetaMessage, MidiMessage, Smf, Timing, TrackEvent, TrackEventKind};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A directory that is removed when the test ends.
pub(crate) struct Sandbox(tempfile::TempDir);

impl Sandbox {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn folder(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder().join(name)
    }

    pub(crate) fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        std::fs::write(self.path(name), contents).unwrap();
        self.path(name)
    }

    /// Runs `sprung` here, and returns its stderr.
    pub(crate) fn succeeds(&self, arguments: &str) -> String {
        let output = sprung(arguments).current_dir(self.folder()).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{arguments}: {stderr}");
        stderr
    }

    /// The samples of a WAV file with floats.
    pub(crate) fn floats(&self, name: &str) -> Vec<f32> {
        let reader = hound::WavReader::open(self.path(name)).unwrap();
        reader.into_samples().map(|sample| sample.unwrap()).collect()
    }
}

/// The command with default signal handling: a test suite that runs in the background or under `nohup` ignores some
/// signals, and its children inherit this.
pub(crate) fn sprung(arguments: &str) -> Command {
    let mut command = Command::new("env");
    command.args(["--default-signal=HUP,INT,TERM", env!("CARGO_BIN_EXE_sprung")]);
    command.args(arguments.split_whitespace()).stdin(Stdio::null()).stdout(Stdio::null());
    command
}

/// A process started by a test, which is killed when dropped.
pub(crate) struct Running(pub(crate) Child);

impl Running {
    /// Waits for its end and returns its exit code.
    pub(crate) fn wait(mut self) -> Option<i32> {
        self.0.wait().unwrap().code()
    }

    /// Interrupts it as Ctrl-C does, and waits for its end.
    pub(crate) fn interrupt(self) -> Option<i32> {
        signal(&self.0, "-INT");
        self.wait()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Sends a signal to a process started by this test.
pub(crate) fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

/// Waits until a condition is true, for at most half a minute.
#[track_caller]
pub(crate) fn wait_until(what: &str, mut so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !so() {
        assert!(start.elapsed() < Duration::from_secs(30), "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// The present text of a file to which another process writes.
pub(crate) fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_default()
}

/// A MIDI file of notes `(tick, length, key)` on channel 1, 960 ticks per second.
pub(crate) fn song(notes: &[(u32, u32, u8)]) -> Vec<u8> {
    let mut events: Vec<(u32, MidiMessage)> = Vec::new();
    for &(tick, length, key) in notes {
        let key = u7::new(key);
        events.push((tick, MidiMessage::NoteOn { key, vel: u7::new(100) }));
        events.push((tick + length, MidiMessage::NoteOff { key, vel: u7::new(64) }));
    }
    events.sort_by_key(|(tick, _)| *tick);
    let mut now = 0;
    let mut track: Vec<TrackEvent> = Vec::new();
    for (tick, message) in events {
        let kind = TrackEventKind::Midi { channel: u4::new(0), message };
        track.push(TrackEvent { delta: u28::new(tick - now), kind });
        now = tick;
    }
    track.push(TrackEvent { delta: u28::new(0), kind: TrackEventKind::Meta(MetaMessage::EndOfTrack) });
    let header = Header::new(Format::SingleTrack, Timing::Metrical(u15::new(480)));
    let mut bytes = Vec::new();
    Smf { header, tracks: vec![track] }.write(&mut bytes).unwrap();
    bytes
}
