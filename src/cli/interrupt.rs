//! Ctrl-C, SIGTERM and SIGHUP: outputs that are not whole yet do not stay.

use sprung::{Error, Result};
use std::sync::atomic::{AtomicBool, Ordering};

static REQUESTED: AtomicBool = AtomicBool::new(false);

/// From now on an interrupt makes [`check`] fail, so that the work ends in order and its temporary file goes.
/// Where there is none (`removable` is false), the process ends at once: a pipe that nobody reads would otherwise
/// hold it for ever.
pub(super) fn catch(removable: bool) -> Result<()> {
    let handler = move || {
        if removable {
            REQUESTED.store(true, Ordering::Relaxed);
        } else {
            super::complain("error", "interrupted");
            std::process::exit(super::INTERRUPTED.into());
        }
    };
    ctrlc::set_handler(handler).map_err(|error| Error::value("Ctrl-C", error.to_string()))
}

/// Fails once an interrupt has come.
pub(super) fn check() -> Result<()> {
    if REQUESTED.load(Ordering::Relaxed) { Err(Error::Interrupted) } else { Ok(()) }
}
