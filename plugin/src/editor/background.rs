//! Work of seconds on a thread of its own, with its progress, which can be cancelled.

use super::host::keep::keep_loaded;
use sprung::Result;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::thread::{Builder, JoinHandle, sleep};
use std::time::Duration;

/// Number of steps in which progress is reported.
const STEPS: f64 = 1000.0;
/// How often, and at what intervals, it is looked whether work that was dropped has ended.
const LOOKS: usize = 40;
const INTERVAL: Duration = Duration::from_millis(5);

/// What both threads see.
#[derive(Default)]
pub(super) struct Progress {
    /// Number of completed steps.
    steps: AtomicU32,
    is_cancelled: AtomicBool,
}

impl Progress {
    /// Reports the share of the work that is done. Returns whether the work is to go on.
    pub(super) fn report(&self, share: f64) -> bool {
        self.steps.store((share * STEPS) as u32, Ordering::Relaxed);
        !self.is_cancelled()
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.is_cancelled.load(Ordering::Relaxed)
    }
}

/// Work in progress.
pub(super) struct Background<T> {
    /// What it is about, as text for the user.
    pub(super) name: String,
    progress: Arc<Progress>,
    worker: Option<JoinHandle<Result<T>>>,
}

impl<T: Send + 'static> Background<T> {
    /// Begins to work.
    ///
    /// # Errors
    /// A message, if the system has no thread for it.
    pub(super) fn start(
        name: String,
        work: impl FnOnce(&Progress) -> Result<T> + Send + 'static,
    ) -> std::result::Result<Self, String> {
        let progress = Arc::new(Progress::default());
        let seen = progress.clone();
        match Builder::new().name("sprung work".to_owned()).spawn(move || work(&seen)) {
            Ok(worker) => Ok(Self { name, progress, worker: Some(worker) }),
            Err(error) => Err(format!("{name}: no thread for this: {error}")),
        }
    }

    /// The share of the work that is done.
    pub(super) fn share(&self) -> f64 {
        f64::from(self.progress.steps.load(Ordering::Relaxed)) / STEPS
    }

    /// The result or the error, once the work is over.
    pub(super) fn take(&mut self) -> Option<std::result::Result<T, String>> {
        let worker = self.worker.take_if(|worker| worker.is_finished())?;
        Some(match worker.join() {
            // A result that came after the cancellation is dropped too.
            _ if self.is_cancelled() => Err(format!("cancelled: {}", self.name)),
            Ok(result) => result.map_err(|error| error.to_string()),
            Err(_) => Err(format!("{}: an error in the plugin; nothing was changed", self.name)),
        })
    }
}

impl<T> Background<T> {
    /// Asks the work to end; it ends soon after.
    pub(super) fn cancel(&self) {
        self.progress.is_cancelled.store(true, Ordering::Relaxed);
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.progress.is_cancelled()
    }
}

/// No code of the plugin may run after it has been unloaded, so the thread is joined. One that hangs, in a folder of a network that
/// does not answer, is left to itself where the code can be kept loaded: nobody may wait for it.
impl<T> Drop for Background<T> {
    fn drop(&mut self) {
        self.cancel();
        let Some(worker) = self.worker.take() else { return };
        let mut looks = LOOKS;
        while looks > 0 && !worker.is_finished() {
            looks -= 1;
            sleep(INTERVAL);
        }
        if worker.is_finished() || !keep_loaded() {
            // The result is not wanted, not even a panic.
            let _ = worker.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn work_that_is_dropped_has_ended() {
        let work = Background::start("waiting".to_owned(), |progress| {
            while progress.report(0.5) {
                std::thread::sleep(Duration::from_millis(1));
            }
            Ok(())
        });
        let work = work.unwrap();
        let progress = work.progress.clone();
        drop(work);
        assert_eq!(Arc::strong_count(&progress), 1, "its thread is gone");
    }

    #[test]
    fn work_that_hangs_is_waited_for_by_nobody() {
        let (end, hanging) = std::sync::mpsc::channel::<()>();
        let work =
            Background::start("hanging".to_owned(), move |_| Ok(hanging.recv_timeout(Duration::from_secs(20)).is_ok()));
        let work = work.unwrap();
        let progress = work.progress.clone();
        drop(work);
        assert_eq!(Arc::strong_count(&progress), 1 + usize::from(keep_loaded()), "its thread still hangs");
        drop(end);
    }
}
