//! `sprung play` on a JACK server with the dummy driver: timing and pitch of live MIDI, and a server that restarts.

use super::sandbox::{Running, Sandbox, signal, song, sprung, text, wait_until};
use jack::{AudioIn, Client, ClientOptions, Control, MidiOut, ProcessScope, RawMidi};
use sprung::params::Param;
use sprung::units::{frequency_from_key, semitones_from_ratio};
use std::fs::File;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, sync_channel};

const RATE: usize = 48_000;
const PERIOD: usize = 256;

/// A JACK server that ends with the test.
struct Server(Child);

impl Server {
    fn start(name: &str) -> Self {
        let period = PERIOD.to_string();
        let arguments = ["-n", name, "--no-realtime", "-S", "-t", "5000", "-d", "dummy", "-r", "48000", "-p", &period];
        let mut command = Command::new("jackd");
        command.args(arguments).env("JACK_NO_AUDIO_RESERVATION", "1").stdout(Stdio::null()).stderr(Stdio::null());
        let server = Self(command.spawn().unwrap());
        wait_until("the server answers", || client("probe").is_some());
        server
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        signal(&self.0, "-TERM");
        let _ = self.0.wait();
    }
}

fn client(name: &str) -> Option<Client> {
    Client::new(name, ClientOptions::NO_START_SERVER).ok().map(|(client, _)| client)
}

/// Runs a test in a process of its own that uses only the server with this name, because JACK's library selects the server by an
/// environment variable.
fn with_own_server(test: &str, body: impl FnOnce(&str)) {
    let variable = "JACK_DEFAULT_SERVER";
    match std::env::var(variable) {
        Ok(name) if name.starts_with("sprung-") => body(&name),
        _ => {
            // Without a sound card, the server's clock is a sleep, which may miss periods on a busy machine. Sprung does not
            // cause this, so the test may be repeated.
            let passed = (1..=3).any(|attempt| {
                let name = format!("sprung-{test}-{}-{attempt}", std::process::id());
                let mut again = Command::new(std::env::current_exe().unwrap());
                again
                    .args(["--include-ignored", "--exact", &format!("jack::{test}")])
                    .env(variable, name)
                    .stderr(Stdio::inherit());
                let output = again.output().unwrap();
                let said = String::from_utf8_lossy(&output.stdout);
                // Not to stdout, where it would be counted as a result of another test.
                eprint!("{said}");
                // If the name matched no test, the process would succeed after zero tests.
                output.status.success() && said.contains("1 passed")
            });
            assert!(passed, "three times");
        }
    }
}

fn start(sandbox: &Sandbox, arguments: &str) -> Running {
    let stderr = File::create(sandbox.path("stderr")).unwrap();
    let mut command = sprung(arguments);
    // What the user of this machine has bound must not turn anything here.
    command.current_dir(sandbox.folder()).env("XDG_DATA_HOME", sandbox.folder());
    Running(command.stderr(stderr).spawn().unwrap())
}

/// Sends messages at frames counted from its start, and passes on the samples that it receives in each period, left and right.
struct Peer {
    midi: jack::Port<MidiOut>,
    audio: [jack::Port<AudioIn>; 2],
    messages: Vec<(usize, [u8; 3])>,
    next: usize,
    frame: usize,
    heard: std::sync::mpsc::SyncSender<[Vec<f32>; 2]>,
}

impl jack::ProcessHandler for Peer {
    fn process(&mut self, _: &Client, scope: &ProcessScope) -> Control {
        let frames = scope.n_frames() as usize;
        let mut writer = self.midi.writer(scope);
        while let Some((at, bytes)) = self.messages.get(self.next).filter(|(at, _)| *at < self.frame + frames) {
            writer.write(&RawMidi { time: at.saturating_sub(self.frame) as u32, bytes }).unwrap();
            self.next += 1;
        }
        self.frame += frames;
        let _ = self.heard.try_send([0, 1].map(|side| self.audio[side].as_slice(scope).to_vec()));
        Control::Continue
    }
}

/// The ports to which the instrument sends sound.
fn outputs(client: &Client) -> Vec<String> {
    client.ports(Some("_out:out_[01]$"), None, jack::PortFlags::IS_OUTPUT)
}

/// Connects a peer to the instrument, sends messages, and returns this many frames of the instrument's sound.
fn listen(messages: Vec<(usize, [u8; 3])>, frames: usize) -> [Vec<f32>; 2] {
    let client = client("peer").unwrap();
    let midi = client.register_port("midi", MidiOut::default()).unwrap();
    let audio = ["left", "right"].map(|name| client.register_port(name, AudioIn::default()).unwrap());
    let (heard, periods): (_, Receiver<[Vec<f32>; 2]>) = sync_channel(1 << 16);
    wait_until("the instrument's ports appear", || {
        outputs(&client).len() == 2 && client.port_by_name("sprung:midi_in").is_some()
    });
    let peer = Peer { midi, audio, messages, next: 0, frame: 0, heard };
    let active = client.activate_async((), peer).unwrap();
    let client = active.as_client();
    client.connect_ports_by_name("peer:midi", "sprung:midi_in").unwrap();
    for (from, to) in outputs(client).iter().zip(["peer:left", "peer:right"]) {
        client.connect_ports_by_name(from, to).unwrap();
    }
    let mut all = [Vec::new(), Vec::new()];
    while all[0].len() < frames {
        let period = periods.recv_timeout(std::time::Duration::from_secs(10)).expect("the server goes on");
        all.iter_mut().zip(period).for_each(|(all, period)| all.extend(period));
    }
    all
}

/// Frames at which sound starts after silence.
fn onsets(samples: &[f32]) -> Vec<usize> {
    let mut silent = 1000;
    let mut found = Vec::new();
    for (frame, sample) in samples.iter().enumerate() {
        if *sample == 0.0 {
            silent += 1;
        } else {
            if silent >= 100 {
                found.push(frame);
            }
            silent = 0;
        }
    }
    found
}

/// Frequency in Hz, from the upward zero crossings of a sine.
fn frequency(samples: &[f32]) -> f64 {
    let crossings: Vec<f64> = (1..samples.len())
        .filter(|n| samples[n - 1] < 0.0 && samples[*n] >= 0.0)
        .map(|n| n as f64 - f64::from(samples[n]) / f64::from(samples[n] - samples[n - 1]))
        .collect();
    (crossings.len() - 1) as f64 * RATE as f64 / (crossings[crossings.len() - 1] - crossings[0])
}

#[test]
#[ignore = "waits for seconds to pass"]
fn live_notes_are_in_time_and_in_tune() {
    with_own_server("live_notes_are_in_time_and_in_tune", |name| {
        let _server = Server::start(name);
        let sandbox = Sandbox::new();
        let arguments = "play --host jack --headless --record take.wav --set decay=0.05 --set release=0.05";
        let child = start(&sandbox, arguments);
        // The messages cover every frame of a period.
        let keys = [57_u8, 69, 64, 72, 60];
        let sent: Vec<(usize, u8)> = (0..24).map(|n| (RATE + n * 9001, keys[n % keys.len()])).collect();
        let messages = sent.iter().flat_map(|&(at, key)| [(at, [0x90, key, 127]), (at + 2000, [0x80, key, 64])]);
        let [left, right] = listen(messages.collect(), RATE + 24 * 9001 + RATE / 2);
        assert_eq!(child.interrupt(), Some(0), "{}", text(&sandbox.path("stderr")));

        let onsets = onsets(&left);
        assert_eq!(onsets.len(), sent.len(), "{onsets:?}");
        let delays: Vec<usize> = onsets.iter().zip(&sent).map(|(heard, (at, _))| heard - at).collect();
        let (least, most) = (*delays.iter().min().unwrap(), *delays.iter().max().unwrap());
        println!("notes sound {least} to {most} frames after they were sent: a jitter of {} frames", most - least);
        assert!(most - least <= PERIOD / 8, "{delays:?}");
        assert!(most <= 3 * PERIOD, "{delays:?}");
        for (onset, (_, key)) in onsets.iter().zip(&sent) {
            let expected = frequency_from_key(f64::from(*key), 440.0);
            let cents = 100.0 * semitones_from_ratio(frequency(&left[*onset..onset + 1900]) / expected);
            assert!(cents.abs() < 3.0, "key {key}: {cents} cents off");
        }

        // The recording starts before the listening and ends after it.
        let recorded = sandbox.floats("take.wav");
        let recorded_left: Vec<f32> = recorded.chunks_exact(2).map(|frame| frame[0]).collect();
        let start = super::jack::onsets(&recorded_left)[0];
        for (n, frame) in (onsets[0]..left.len() - RATE / 4).enumerate() {
            let expected = [left[frame], right[frame]];
            assert_eq!([recorded[2 * (start + n)], recorded[2 * (start + n) + 1]], expected, "frame {n}");
        }
    });
}

#[test]
#[ignore = "waits for seconds to pass"]
fn a_controller_that_is_learnt_turns_its_parameter() {
    with_own_server("a_controller_that_is_learnt_turns_its_parameter", |name| {
        let _server = Server::start(name);
        let sandbox = Sandbox::new();
        let arguments = "play --host jack --headless --learn tune=21 --set decay=0.05 --set release=0.05";
        let child = start(&sandbox, arguments);
        // Where it is played first, it has not reached the middle, where the parameter stands; the end is 48 semitones above it.
        let moved = [(RATE, 10), (RATE + 9_000, 127), (RATE + 18_000, 64)];
        let messages = moved.iter().flat_map(|&(at, position)| {
            [(at, [0xB0, 21, position]), (at + 2_000, [0x90, 57, 127]), (at + 4_000, [0x80, 57, 64])]
        });
        let [left, _] = listen(messages.collect(), RATE + 3 * 9_000 + RATE / 2);
        assert_eq!(child.interrupt(), Some(0), "{}", text(&sandbox.path("stderr")));
        let onsets = onsets(&left);
        assert_eq!(onsets.len(), 3, "{onsets:?}");
        let middle = f64::from(Param::Tune.info().denormalise(64.0 / 127.0));
        for (onset, semitones) in onsets.iter().zip([0.0, 48.0, middle]) {
            let expected = frequency_from_key(57.0 + semitones, 440.0);
            let cents = 100.0 * semitones_from_ratio(frequency(&left[*onset..onset + 1900]) / expected);
            assert!(cents.abs() < 3.0, "{semitones}: {cents} cents off");
        }
    });
}

#[test]
#[ignore = "waits for seconds to pass"]
fn a_server_that_ends_is_waited_for() {
    with_own_server("a_server_that_ends_is_waited_for", |name| {
        let server = Server::start(name);
        let sandbox = Sandbox::new();
        let notes: Vec<_> = (0..200).map(|n| (n * 96, 50, 60)).collect();
        sandbox.write("long.mid", song(&notes));
        sandbox.succeeds("render long.mid --bits 32f -o expected.wav");
        let child = start(&sandbox, "play long.mid --host jack --headless --record take.wav");
        let said = |line: &str| text(&sandbox.path("stderr")).contains(line);
        wait_until("the port is open", || said("‘sprung:midi_in’ is open"));
        std::thread::sleep(std::time::Duration::from_millis(500));
        drop(server);
        wait_until("the loss is told", || said("the sound device is gone: "));
        let _server = Server::start(name);
        wait_until("the return is told", || said("the sound device is back: "));
        std::thread::sleep(std::time::Duration::from_secs(1));
        assert_eq!(child.interrupt(), Some(0), "{}", text(&sandbox.path("stderr")));
        // The song has continued where it was, and the recording has no gap.
        let (recorded, expected) = (sandbox.floats("take.wav"), sandbox.floats("expected.wav"));
        let same = recorded.iter().zip(&expected).take_while(|(a, b)| a.to_bits() == b.to_bits()).count();
        assert!(same > 2 * RATE, "{same} samples are those of the song, of {}", recorded.len());
    });
}

#[test]
#[ignore = "waits for seconds to pass"]
fn what_the_server_cannot_do_is_refused() {
    with_own_server("what_the_server_cannot_do_is_refused", |name| {
        let refused = |arguments: &str, expected: &str| {
            let output = sprung(arguments).output().unwrap();
            let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(output.status.code() == Some(1) && stderr.contains(expected), "{arguments}: {stderr}");
        };
        refused("play --host jack", "no JACK server is running");
        let _server = Server::start(name);
        refused("play --host jack --rate 44100", "does not run at 44100 Hz: expected 48000 Hz");
        refused("play --host jack --buffer 100", "has no blocks of 100 frames: expected 256");
    });
}
