//! Handles Ctrl-C, SIGTERM and SIGHUP: removes outputs that are not complete yet.
//!
//! A signal that was ignored when the program started, as `nohup` does, stays ignored.

use super::terminal::complain;
use sprung::internals::files::Output;
use sprung::{Error, Result};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Exit code that shells report for a program that was ended by Ctrl-C.
pub(super) const INTERRUPTED: u8 = 130;

static REQUESTED: AtomicBool = AtomicBool::new(false);
/// The files that [`end_at_once`] removes.
static TEMPORARIES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// From now on, an interrupt makes [`check`] fail, so that the work stops in order and removes its temporary file. If
/// there is none (`removable` is false), the process ends at once: otherwise a pipe that nobody reads could block it
/// forever.
pub(super) fn catch(removable: bool) -> Result<()> {
    let handler = move || {
        if removable {
            REQUESTED.store(true, Ordering::Relaxed);
        } else {
            end();
        }
    };
    install(handler)
}

/// From now on, an interrupt ends the process at once. The temporary files given to [`remove`] are deleted first.
pub(super) fn end_at_once() -> Result<()> {
    install(|| {
        // The lock is held until the process ends, so that no file can be added that would remain.
        let temporaries = TEMPORARIES.lock().unwrap_or_else(PoisonError::into_inner);
        for path in &*temporaries {
            // If the file was renamed in the meantime, it is complete, and nothing is removed.
            let _ = std::fs::remove_file(path);
        }
        end();
    })
}

/// Adds a temporary file to those that an interrupt removes.
pub(super) fn remove(output: &Output) {
    let temporary = output.temporary().map(PathBuf::from);
    TEMPORARIES.lock().unwrap_or_else(PoisonError::into_inner).extend(temporary);
}

/// Calls `handler` on its own thread at each interrupt.
#[cfg(unix)]
fn install(mut handler: impl FnMut() + 'static + Send) -> Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let heeded = [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| !is_ignored(*signal));
    let mut signals = signal_hook::iterator::Signals::new(heeded).map_err(failed)?;
    std::thread::Builder::new()
        .name("interrupt".to_owned())
        .spawn(move || signals.forever().for_each(|_| handler()))
        .map(drop)
        .map_err(failed)
}

/// Whether a signal is ignored. Must be called before a handler is installed.
#[cfg(unix)]
#[expect(unsafe_code, reason = "no crate tells by a safe function how a signal is handled")]
fn is_ignored(signal: std::ffi::c_int) -> bool {
    let mut action = std::mem::MaybeUninit::<libc::sigaction>::uninit();
    // SAFETY: without a new action, `sigaction` only writes the present action, and it has written it if it returns 0.
    unsafe {
        libc::sigaction(signal, std::ptr::null(), action.as_mut_ptr()) == 0
            && action.assume_init().sa_sigaction == libc::SIG_IGN
    }
}

/// Calls `handler` on its own thread at each interrupt.
#[cfg(windows)]
fn install(handler: impl FnMut() + 'static + Send) -> Result<()> {
    ctrlc::set_handler(handler).map_err(failed)
}

fn failed(error: impl std::fmt::Display) -> Error {
    Error::value("Ctrl-C", error.to_string())
}

fn end() -> ! {
    complain("error", "interrupted");
    std::process::exit(INTERRUPTED.into())
}

/// Returns an error if an interrupt has happened.
pub(super) fn check() -> Result<()> {
    if REQUESTED.load(Ordering::Relaxed) { Err(Error::Interrupted) } else { Ok(()) }
}
