//! Asks the host for a call on its main thread, from whichever thread loads a sound.

use crate::lock::lock;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::Relaxed;

/// Asks the host. May be called on any thread.
type Ask = Box<dyn Fn() + Send>;

/// What is to be done on the host's main thread.
#[derive(Default)]
pub(crate) struct Callback {
    /// None if no host can be asked.
    ask: Mutex<Option<Ask>>,
    /// Whether the host has yet to hear that keys have other names.
    has_new_names: AtomicBool,
}

impl Callback {
    /// From now on, `ask` is used.
    pub(crate) fn connect(&self, ask: Ask) {
        *lock(&self.ask) = Some(ask);
    }

    /// From now on, nobody is asked. Waits for another thread that is asking.
    pub(crate) fn disconnect(&self) {
        *lock(&self.ask) = None;
    }

    /// Keys have other names. Not for the audio thread.
    pub(crate) fn tell_new_names(&self) {
        self.has_new_names.store(true, Relaxed);
        if let Some(ask) = &*lock(&self.ask) {
            ask();
        }
    }

    /// Whether keys have other names since the last call.
    pub(crate) fn take_new_names(&self) -> bool {
        self.has_new_names.swap(false, Relaxed)
    }
}
