//! Ctrl-C, SIGTERM and SIGHUP: outputs that are not whole yet do not stay.

use sprung::io::Output;
use sprung::{Error, Result};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

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

fn install(handler: impl FnMut() + 'static + Send) -> Result<()> {
    ctrlc::set_handler(handler).map_err(|error| Error::value("Ctrl-C", error.to_string()))
}

fn end() -> ! {
    super::complain("error", "interrupted");
    std::process::exit(super::INTERRUPTED.into())
}

/// Fails once an interrupt has come.
pub(super) fn check() -> Result<()> {
    if REQUESTED.load(Ordering::Relaxed) { Err(Error::Interrupted) } else { Ok(()) }
}
