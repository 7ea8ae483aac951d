//! Tests that need a process of their own: this program starts itself again for one piece of work.

use crate::host::bundle;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Environment variable: the piece of work for which a process was started.
const WORK: &str = "SPRUNG_HOSTS_WORK";

/// The piece of work for which this process was started; `None` in the test program itself.
pub(crate) fn work() -> Option<String> {
    std::env::var(WORK).ok()
}

/// The command that starts this program for a piece of work, with the same plugin.
pub(crate) fn command(work: &str) -> Command {
    let (name, folder) = bundle::environment();
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.env(WORK, work).env(name, folder).stdin(Stdio::null());
    // Windows do not depend on the session in which the tests run.
    command.env("DBUS_SESSION_BUS_ADDRESS", "");
    command
}

/// Runs a command to its end and returns its stdout, or fails with everything that it wrote.
#[track_caller]
pub(crate) fn succeeds(mut command: Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let [stdout, stderr] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{}\n{stdout}\n{stderr}", output.status);
    stdout
}

/// A folder under the target directory for files of the tests.
pub(crate) fn scratch(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hosts");
    std::fs::create_dir_all(&path).unwrap();
    path.join(name)
}

/// Tells another thread to stop when dropped, so that a test that failed does not wait for that thread.
pub(crate) struct Stops<'a>(pub(crate) &'a AtomicBool);

impl Drop for Stops<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Waits until a condition is true, for at most half a minute.
#[track_caller]
pub(crate) fn wait_until(what: &str, mut so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !so() {
        assert!(start.elapsed() < Duration::from_secs(30), "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}
