//! The window as a program, on a virtual screen and a JACK server without a sound card.

use crate::process::{scratch, wait_until};
use crate::screen::{Onlooker, Screen};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// The program, if it was built with these tests.
const PROGRAM: Option<&str> = option_env!("CARGO_BIN_EXE_sprung-standalone");

/// The program or server that these tests need besides a screen and that is missing here.
pub(crate) fn missing() -> Option<String> {
    if PROGRAM.is_none() {
        return Some("the program (‘cargo test --features standalone’ builds it)".to_owned());
    }
    let paths = std::env::var_os("PATH").unwrap_or_default();
    let is_there = std::env::split_paths(&paths).any(|folder| folder.join("jackd").is_file());
    (!is_there).then(|| "jackd".to_owned())
}

/// A process that ends with the test.
pub(crate) struct Running(Child);

impl Running {
    fn signal(&self, signal: i32) {
        let id = i32::try_from(self.0.id()).unwrap();
        // SAFETY: the process was started here, and has not been waited for.
        #[allow(unsafe_code)]
        let sent = unsafe { libc::kill(id, signal) };
        assert_eq!(sent, 0);
    }

    /// Interrupts it, as Ctrl-C does.
    pub(crate) fn interrupt(&self) {
        self.signal(libc::SIGINT);
    }

    #[track_caller]
    pub(crate) fn ends(&mut self) -> ExitStatus {
        let mut status = None;
        wait_until("the program ends", || {
            status = self.0.try_wait().unwrap();
            status.is_some()
        });
        status.unwrap()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let is_over = |child: &mut Child| child.try_wait().is_ok_and(|status| status.is_some());
        if is_over(&mut self.0) {
            return;
        }
        if let Ok(id) = i32::try_from(self.0.id()) {
            // SAFETY: the process was started here, and has not been waited for.
            #[allow(unsafe_code)]
            let _ = unsafe { libc::kill(id, libc::SIGTERM) };
        }
        // A process that does not end by itself is killed, so that a test that failed does not wait for it.
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(5) && !is_over(&mut self.0) {
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A screen, a JACK server and a user's folders.
pub(crate) struct Stand {
    pub(crate) screen: Screen,
    pub(crate) onlooker: Onlooker,
    server: String,
    jack: Option<Running>,
    pub(crate) folder: tempfile::TempDir,
    /// ALSA's configuration; `None` for the system's.
    pub(crate) alsa: Option<PathBuf>,
}

impl Stand {
    pub(crate) fn new(name: &str) -> Self {
        let mut stand = Self::without_server(name);
        stand.serve();
        stand
    }

    fn without_server(name: &str) -> Self {
        let server = format!("sprung-window-{name}-{}", std::process::id());
        let screen = Screen::new();
        let onlooker = Onlooker::new(Some(&screen.display));
        Self { onlooker, screen, server, jack: None, folder: tempfile::tempdir().unwrap(), alsa: None }
    }

    /// Starts the server.
    fn serve(&mut self) {
        let mut jack = Command::new("jackd");
        jack.args(["-n", &self.server, "--no-realtime", "-S", "-t", "5000", "-d", "dummy", "-r", "44100", "-p", "256"]);
        jack.env("JACK_NO_AUDIO_RESERVATION", "1").stdout(Stdio::null()).stderr(Stdio::null());
        self.jack = Some(Running(jack.spawn().unwrap()));
        wait_until("the server", || {
            let list = self.command(&["--list"]).output().unwrap().stdout;
            String::from_utf8_lossy(&list).contains("JACK Output")
        });
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(PROGRAM.unwrap());
        command.args(arguments).stdin(Stdio::null()).env("DISPLAY", &self.screen.display);
        command.env("JACK_DEFAULT_SERVER", &self.server).env("JACK_NO_START_SERVER", "1");
        command.envs(self.alsa.iter().map(|file| ("ALSA_CONFIG_PATH", file)));
        command.env("XDG_STATE_HOME", self.folder.path()).env("XDG_DATA_HOME", self.folder.path());
        command.env("DBUS_SESSION_BUS_ADDRESS", "");
        command
    }

    pub(crate) fn state(&self) -> PathBuf {
        self.folder.path().join("sprung/standalone.json")
    }

    /// Starts the program on the server, and waits for its window. Returns it and the file with its stderr.
    #[track_caller]
    pub(crate) fn start(&self, arguments: &[&str]) -> (Running, PathBuf) {
        self.start_with(&["--host", "jack", "--midi-in", "none"], arguments)
    }

    /// As [`Stand::start`], with options instead of those for the server.
    #[track_caller]
    pub(crate) fn start_with(&self, options: &[&str], arguments: &[&str]) -> (Running, PathBuf) {
        let stderr = self.folder.path().join("stderr");
        let mut command = self.command(options);
        let running = Running(command.args(arguments).stderr(File::create(&stderr).unwrap()).spawn().unwrap());
        wait_until("the window", || self.onlooker.find("Sprung").is_some());
        wait_until("a picture", || self.onlooker.sees_a_picture(600, 400));
        (running, stderr)
    }
}

pub(crate) fn preset(file: &Path) -> String {
    let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    let state: serde_json::Value = serde_json::from_str(&text).unwrap();
    state["preset"].as_str().unwrap().to_owned()
}

pub(crate) fn it_keeps_its_state_whatever_ends_it() {
    let stand = Stand::new("state");
    let (mut running, stderr) = stand.start(&["Church Bell"]);
    let stderr = std::fs::read_to_string(stderr).unwrap();
    assert!(stderr.contains("playing on JACK") && stderr.contains("44100 Hz"), "the rate is the device's: {stderr}");
    running.signal(libc::SIGINT);
    assert_eq!(running.ends().code(), Some(0));
    let first = preset(&stand.state());
    assert!(first.contains("Church Bell"), "{first}");

    // The sound of the last run comes back; a change in the window is kept when a signal ends the program.
    let (mut running, _) = stand.start(&[]);
    stand.onlooker.drag_slowly([200, 500], [200, 440]);
    let mut changed = first.clone();
    wait_until("a change is kept while the window is open", || {
        for y in (440..640).step_by(20) {
            stand.onlooker.drag_slowly([60, y], [60, y - 30]);
        }
        changed = preset(&stand.state());
        changed != first
    });
    running.signal(libc::SIGTERM);
    assert_eq!(running.ends().code(), Some(0));
    assert!(preset(&stand.state()).contains("Church Bell"));

    // Its close button ends it too.
    let changed = preset(&stand.state());
    let (mut running, _) = stand.start(&[]);
    stand.onlooker.close(stand.onlooker.find("Sprung").unwrap());
    assert_eq!(running.ends().code(), Some(0));
    assert_eq!(preset(&stand.state()), changed);
    let files = std::fs::read_dir(stand.state().parent().unwrap()).unwrap();
    let mut names: Vec<_> = files.map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(names, ["standalone.json", "standalone.lock"], "nothing else is left behind");
}

/// Keys of an American keyboard.
const SLASH: u8 = 61;
const GONG: [u8; 4] = [42, 32, 57, 42];
const DOWN: u8 = 116;
const ENTER: u8 = 36;
const CONTROL: u8 = 37;
const SHIFT: u8 = 50;
const Z: u8 = 52;
const MINUS: u8 = 20;
const EQUALS: u8 = 21;

pub(crate) fn keys_search_and_undo_and_zoom() {
    let stand = Stand::new("keys");
    let (mut running, _) = stand.start(&["Marimba"]);
    // The window takes the keys with the first click.
    let empty = [550, 692];
    stand.onlooker.hover(empty);
    stand.onlooker.drag_slowly(empty, empty);
    for key in [SLASH].into_iter().chain(GONG).chain([DOWN]) {
        stand.onlooker.press_key(key);
        std::thread::sleep(Duration::from_millis(300));
    }
    let has = |name| stand.state().is_file() && preset(&stand.state()).contains(name);
    wait_until("a gong is found and loaded", || has("Gong"));
    stand.onlooker.press_key(ENTER);
    let presses = |what: &str, keys: &[u8], so: &dyn Fn() -> bool| {
        wait_until(what, || {
            stand.onlooker.press_keys(keys);
            std::thread::sleep(Duration::from_secs(1));
            so()
        });
    };
    presses("it is undone", &[CONTROL, Z], &|| has("Marimba"));
    presses("it is done again", &[CONTROL, SHIFT, Z], &|| has("Gong"));
    let is_larger = || std::fs::read_to_string(stand.state()).unwrap().contains("\"zoom\":");
    presses("the window is larger", &[CONTROL, EQUALS], &is_larger);
    presses("and as it was", &[CONTROL, MINUS], &|| !is_larger());
    running.signal(libc::SIGINT);
    assert_eq!(running.ends().code(), Some(0));
}

pub(crate) fn a_broken_state_is_set_aside() {
    let stand = Stand::new("broken");
    std::fs::create_dir(stand.state().parent().unwrap()).unwrap();
    std::fs::write(stand.state(), "{\"preset\": 1").unwrap();
    let (mut running, stderr) = stand.start(&[]);
    running.signal(libc::SIGINT);
    assert_eq!(running.ends().code(), Some(0));
    let stderr = std::fs::read_to_string(stderr).unwrap();
    let aside = stand.state().with_file_name("standalone.not-understood-1.json");
    assert!(stderr.contains("not a state of Sprung") && stderr.contains(aside.to_str().unwrap()), "{stderr}");
    assert_eq!(std::fs::read_to_string(aside).unwrap(), "{\"preset\": 1");
    assert!(preset(&stand.state()).contains("Church Bell"));
}

pub(crate) fn without_a_sound_card_it_plays_on_the_server_or_waits_for_a_device() {
    let mut stand = Stand::without_server("cards");
    let config = stand.folder.path().join("asound.conf");
    std::fs::write(&config, "pcm.!default { type hw\n card 9 }\n").unwrap();
    stand.alsa = Some(config);
    let said = |stderr: &Path, words| std::fs::read_to_string(stderr).unwrap().contains(words);
    const WAITS: &str = "silent until a device is chosen or plugged in: ";
    let (mut running, stderr) = stand.start_with(&[], &["--midi-in", "none"]);
    assert!(said(&stderr, WAITS) && !said(&stderr, "playing on"));
    stand.serve();
    wait_until("it plays on the server that has come", || said(&stderr, "playing on JACK"));
    running.interrupt();
    assert_eq!(running.ends().code(), Some(0));
    let (mut running, stderr) = stand.start_with(&[], &["--midi-in", "none"]);
    assert!(said(&stderr, "playing on JACK") && !said(&stderr, WAITS));
    running.interrupt();
    assert_eq!(running.ends().code(), Some(0));
}

pub(crate) fn what_is_missing_is_said() {
    let stand = Stand::new("missing");
    let refused = |command: &mut Command, word: &str| {
        let output = command.output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{stderr}");
        let last = stderr.lines().last().unwrap_or_default();
        assert!(last.starts_with("error: ") && last.contains(word), "{stderr}");
    };
    let nowhere = format!("{}-nowhere", stand.server);
    refused(stand.command(&["--host", "jack"]).env("JACK_DEFAULT_SERVER", nowhere), "JACK");
    refused(&mut stand.command(&["--host", "tape"]), "tape");
    refused(&mut stand.command(&["No Such Sound"]), "No Such Sound");
    let list = stand.command(&["--list"]).output().unwrap();
    let list = String::from_utf8_lossy(&list.stdout).into_owned();
    assert!(list.contains("--host jack") && list.contains("MIDI"), "{list}");
    drop(stand.start(&[]));
    let mut blind = stand.command(&["--host", "jack", "--midi-in", "none"]);
    let output = blind.env_remove("DISPLAY").stderr(File::create(scratch("blind")).unwrap()).status().unwrap();
    let stderr = std::fs::read_to_string(scratch("blind")).unwrap();
    assert!(output.code() == Some(1) && stderr.contains("the window cannot be shown"), "{stderr}");
}
