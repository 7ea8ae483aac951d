//! `sprung play` without a sound card: on ALSA's file plugin, on JACK's dummy driver, and in a terminal.

mod alsa;
mod jack;
mod terminal;

use libtest_mimic::{Arguments, Trial};
use midly::num::{u4, u7, u15, u28};
use midly::{Format, Header, MetaMessage, MidiMessage, Smf, Timing, TrackEvent, TrackEventKind};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

/// A directory that goes when the test ends.
struct Sandbox(tempfile::TempDir);

impl Sandbox {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        std::fs::write(self.path(name), contents).unwrap();
        self.path(name)
    }

    /// Runs `sprung` here, and says what it wrote to stderr.
    fn succeeds(&self, arguments: &str) -> String {
        let output = sprung(arguments).current_dir(self.0.path()).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{arguments}: {stderr}");
        stderr
    }

    /// The samples of a WAV file of floats.
    fn floats(&self, name: &str) -> Vec<f32> {
        let reader = hound::WavReader::open(self.path(name)).unwrap();
        reader.into_samples().map(|sample| sample.unwrap()).collect()
    }
}

/// The command, with signals as they are by default: a suite that runs in the background or under `nohup` ignores some
/// of them, and its children inherit that.
fn sprung(arguments: &str) -> Command {
    let mut command = Command::new("env");
    command.args(["--default-signal=HUP,INT,TERM", env!("CARGO_BIN_EXE_sprung")]);
    command.args(arguments.split_whitespace()).stdin(Stdio::null()).stdout(Stdio::null());
    command
}

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let trial = |name: &str, needs: Option<&str>, test: fn()| {
        let missing = needs.filter(|program| !is_installed(program));
        if let Some(program) = missing {
            println!("{name} is ignored: it needs {program}, which ‘cargo xtask setup’ installs");
        }
        let run = move || {
            test();
            Ok(())
        };
        Trial::test(name, run).with_ignored_flag(missing.is_some())
    };
    let (jackd, tmux) = (Some("jackd"), Some("tmux"));
    let trials = vec![
        trial(
            "alsa::a_song_reaches_the_device",
            None,
            alsa::a_song_reaches_the_device_and_the_recording_with_the_bits_of_render,
        ),
        trial("alsa::integers_are_the_rounded_floats", None, alsa::integers_are_the_rounded_floats),
        trial(
            "alsa::an_interrupt_completes_the_recording",
            None,
            alsa::an_interrupt_releases_the_notes_and_completes_the_recording,
        ),
        trial("alsa::a_full_disk_keeps_the_recording", None, alsa::a_full_disk_ends_the_recording_and_keeps_it),
        trial("alsa::what_cannot_be_played_on_says_what_can", None, alsa::what_cannot_be_played_on_says_what_can),
        trial("jack::live_notes_are_in_time_and_in_tune", jackd, jack::live_notes_are_in_time_and_in_tune),
        trial("jack::a_server_that_ends_is_waited_for", jackd, jack::a_server_that_ends_is_waited_for),
        trial("jack::what_the_server_cannot_do_is_refused", jackd, jack::what_the_server_cannot_do_is_refused),
        trial(
            "terminal::the_view_plays_loads_turns_and_resizes",
            tmux,
            terminal::the_view_plays_loads_turns_and_resizes,
        ),
    ];
    libtest_mimic::run(&arguments, trials).exit_code()
}

/// Whether a program can be run.
fn is_installed(program: &str) -> bool {
    std::env::var_os("PATH")
        .is_some_and(|path| std::env::split_paths(&path).any(|folder| folder.join(program).is_file()))
}

/// A process that a test has started and that does not outlive it.
struct Running(Child);

impl Running {
    /// Its exit code, once it has ended by itself.
    fn wait(mut self) -> Option<i32> {
        self.0.wait().unwrap().code()
    }

    /// Asks it to end as Ctrl-C does, and waits for that.
    fn interrupt(self) -> Option<i32> {
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

/// Sends a signal to a process that this test has started.
fn signal(child: &Child, name: &str) {
    assert!(Command::new("kill").args([name, &child.id().to_string()]).status().unwrap().success());
}

/// Waits until something is so, and gives up after half a minute.
#[track_caller]
fn wait_until(what: &str, mut so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !so() {
        assert!(start.elapsed() < Duration::from_secs(30), "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// A file that something writes to as time goes by.
fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_default()
}

/// A MIDI file of notes `(tick, length, key)` on channel 1, 960 ticks a second.
fn song(notes: &[(u32, u32, u8)]) -> Vec<u8> {
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
