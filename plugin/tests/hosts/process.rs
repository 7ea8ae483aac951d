//! Tests that need a process of their own: this program, started again to do one piece of work.

use crate::host::bundle;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
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

/// A folder for what the tests make, under the target directory.
pub(crate) fn scratch(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hosts");
    std::fs::create_dir_all(&path).unwrap();
    path.join(name)
}

/// Tells another thread to stop when it goes, so that nobody waits for that thread after a failure.
pub(crate) struct Stops<'a>(pub(crate) &'a AtomicBool);

impl Drop for Stops<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
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
