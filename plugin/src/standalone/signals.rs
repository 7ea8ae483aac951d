//! Ctrl-C and the system's request to terminate.

/// Calls `handler` on a separate thread at each interrupt or request to terminate.
#[cfg(unix)]
pub(super) fn catch(mut handler: impl FnMut() + Send + 'static) -> Result<(), String> {
    use signal_hook::consts::{SIGINT, SIGTERM};
    let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM]).map_err(failed)?;
    let wait = move || signals.forever().for_each(|_| handler());
    std::thread::Builder::new().name("interrupt".to_owned()).spawn(wait).map(drop).map_err(failed)
}

/// Calls `handler` on a separate thread at each interrupt.
#[cfg(windows)]
pub(super) fn catch(handler: impl FnMut() + Send + 'static) -> Result<(), String> {
    ctrlc::set_handler(handler).map_err(failed)
}

fn failed(error: impl std::fmt::Display) -> String {
    format!("Ctrl-C: {error}")
}
