//! Tests that need a process of their own: this program, started again to do one piece of work.

use crate::host::bundle;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Environment variable: the piece of work that a process is started for.
const WORK: &str = "SPRUNG_HOSTS_WORK";

/// The piece of work that this process was started for, if it is not the test program itself.
pub(crate) fn work() -> Option<String> {
    std::env::var(WORK).ok()
}

/// This program, to be started for a piece of work with the same plugin.
pub(crate) fn command(work: &str) -> Command {
    let (name, folder) = bundle::environment();
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.env(WORK, work).env(name, folder).stdin(Stdio::null());
    command
}

/// Runs a command to its end; what it writes to stdout, or a failure with all that it wrote.
#[track_caller]
pub(crate) fn succeeds(mut command: Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let [stdout, stderr] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{}\n{stdout}\n{stderr}", output.status);
    stdout
}

/// A screen that nobody looks at, as long as it lives.
pub(crate) struct Screen {
    server: Child,
    manager: Option<Child>,
    /// What `DISPLAY` has to say.
    pub(crate) display: String,
}

impl Screen {
    /// Starts Xvfb on a free display, with a window manager if wanted.
    pub(crate) fn new(managed: bool) -> Self {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x800x24", "+extension", "GLX", "-nolisten", "tcp"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts");
        let mut number = String::new();
        let stdout = server.stdout.take().expect("stdout is piped");
        std::io::BufRead::read_line(&mut std::io::BufReader::new(stdout), &mut number).unwrap();
        let display = format!(":{}", number.trim());
        let manager = managed.then(|| {
            let mut openbox = Command::new("openbox");
            openbox.env("DISPLAY", &display).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
            openbox.spawn().expect("openbox starts")
        });
        Self { server, manager, display }
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        for child in self.manager.iter_mut().chain([&mut self.server]) {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// A folder for what the tests make, under the target directory.
pub(crate) fn scratch(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hosts");
    std::fs::create_dir_all(&path).unwrap();
    path.join(name)
}

/// Waits until something is so, and gives up after half a minute.
#[track_caller]
pub(crate) fn wait_until(what: &str, mut so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !so() {
        assert!(start.elapsed() < Duration::from_secs(30), "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}
