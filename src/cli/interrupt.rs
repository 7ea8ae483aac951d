//! Ctrl-C, SIGTERM and SIGHUP: outputs that are not whole yet are removed.
//!
//! What was ignored when the program started, as `nohup` has it, stays ignored.

use super::terminal::complain;
use sprung::io::Output;
use sprung::{Error, Result};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// What the shell reports for a program that Ctrl-C has ended.
pub(super) const INTERRUPTED: u8 = 130;

static REQUESTED: AtomicBool = AtomicBool::new(false);
/// What [`end_at_once`] removes.
static TEMPORARIES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// From now on an interrupt makes [`check`] fail, so that the work ends in order and its temporary file goes.
/// Where there is none (`removable` is false), the process ends at once: a pipe that nobody reads would otherwise
/// hold it for ever.
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

/// From now on an interrupt ends the process at once, wherever its work is: the temporary files of [`remove`] go first.
pub(super) fn end_at_once() -> Result<()> {
    install(|| {
        // The lock is kept to the end: no file is made known that would stay.
        let temporaries = TEMPORARIES.lock().unwrap_or_else(PoisonError::into_inner);
        for path in &*temporaries {
            // It may have got its name in the meantime: then it is whole.
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

/// Calls `handler`, on a thread of its own, each time that an interrupt comes.
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

/// Whether a signal is ignored; once a handler is installed, it is not.
#[cfg(unix)]
#[expect(unsafe_code, reason = "no crate tells by a safe function how a signal is handled")]
fn is_ignored(signal: std::ffi::c_int) -> bool {
    let mut action = std::mem::MaybeUninit::<libc::sigaction>::uninit();
    // SAFETY: without a new action, `sigaction` only writes the present one, which it has done when it gives 0.
    unsafe {
        libc::sigaction(signal, std::ptr::null(), action.as_mut_ptr()) == 0
            && action.assume_init().sa_sigaction == libc::SIG_IGN
    }
}

/// Calls `handler`, on a thread of its own, each time that an interrupt comes.
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

/// Fails once an interrupt has come.
pub(super) fn check() -> Result<()> {
    if REQUESTED.load(Ordering::Relaxed) { Err(Error::Interrupted) } else { Ok(()) }
}
