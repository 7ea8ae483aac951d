//! Makes a sound from recordings on a thread of its own: reads them and fits a preset as `sprung fit` does.

use crate::files;
use sprung::analysis::fit::{Settings, Take, VELOCITY, fit, take_velocities_from_names};
use sprung::io::sound_file;
use sprung::preset::Preset;
use sprung::text::printable;
use sprung::{Error, Result};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::thread::{Builder, JoinHandle};

/// Largest file that is read, in bytes: the fit would use little of a longer one, and reading cannot be cancelled.
const LARGEST: u64 = 32 << 20;
/// Number of steps in which progress is reported.
const STEPS: f64 = 1000.0;

/// The result of a fit.
pub(super) struct Done {
    pub(super) preset: Preset,
    /// Warnings, and a summary of the sound.
    pub(super) message: String,
}

/// State shared by both threads.
#[derive(Default)]
struct Shared {
    /// Number of completed steps.
    steps: AtomicU32,
    is_cancelled: AtomicBool,
}

/// A fit in progress.
pub(super) struct Work {
    /// What is being fitted, as text for the user.
    pub(super) name: String,
    shared: Arc<Shared>,
    worker: Option<JoinHandle<Result<Done>>>,
}

impl Work {
    /// Begins to fit a sound to recordings of one instrument.
    ///
    /// # Errors
    /// A message, if the system has no thread for it.
    pub(super) fn start(paths: Vec<PathBuf>) -> std::result::Result<Self, String> {
        let name = match &paths[..] {
            [] => return Err("no recording".to_owned()),
            [path] => file_name(path),
            [first, more @ ..] => format!("{} and {} more", file_name(first), more.len()),
        };
        let shared = Arc::new(Shared::default());
        let progress = shared.clone();
        let worker = Builder::new().name("sprung fit".to_owned()).spawn(move || fitted(&paths, &progress));
        match worker {
            Ok(worker) => Ok(Self { name, shared, worker: Some(worker) }),
            Err(error) => Err(format!("{name} cannot be fitted: {error}")),
        }
    }

    /// The share of the work that is done.
    pub(super) fn share(&self) -> f64 {
        f64::from(self.shared.steps.load(Ordering::Relaxed)) / STEPS
    }

    /// Asks the work to end; it ends soon after.
    pub(super) fn cancel(&self) {
        self.shared.is_cancelled.store(true, Ordering::Relaxed);
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.shared.is_cancelled.load(Ordering::Relaxed)
    }

    /// The result or the error, once the work is over.
    pub(super) fn take(&mut self) -> Option<std::result::Result<Done, String>> {
        let worker = self.worker.take_if(|worker| worker.is_finished())?;
        Some(match worker.join() {
            // A result that came after the cancellation is dropped too.
            _ if self.is_cancelled() => Err(format!("cancelled: {} was not fitted", self.name)),
            Ok(Ok(done)) => Ok(done),
            Ok(Err(error)) => Err(error.to_string()),
            Err(_) => Err(format!("{} cannot be fitted: an error in the plugin; nothing was changed", self.name)),
        })
    }
}

/// No code of the plugin may run after it has been unloaded, so the thread is joined.
impl Drop for Work {
    fn drop(&mut self) {
        self.cancel();
        if let Some(worker) = self.worker.take() {
            // The result is not wanted, not even a panic.
            let _ = worker.join();
        }
    }
}

fn fitted(paths: &[PathBuf], shared: &Shared) -> Result<Done> {
    let mut remarks = Vec::new();
    let mut takes = Vec::new();
    for path in paths {
        if shared.is_cancelled.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
        let take = read(path)?;
        remarks.extend(take.recording.warnings.iter().map(|warning| format!("{}: {warning}", take.name)));
        takes.push(take);
    }
    if let Some(velocities) = take_velocities_from_names(&mut takes) {
        remarks.push(format!("velocities {velocities} by the names"));
    }
    let fitted = fit(&takes, &Settings::default(), &mut |share| {
        shared.steps.store((share * STEPS) as u32, Ordering::Relaxed);
        !shared.is_cancelled.load(Ordering::Relaxed)
    })?;
    remarks.extend(fitted.warnings.iter().cloned());
    remarks.push(fitted.summary());
    let stem = paths.first().and_then(|path| path.file_stem()).unwrap_or_default().to_string_lossy();
    Ok(Done { preset: fitted.named(&stem, &takes), message: remarks.join("; ") })
}

fn read(path: &Path) -> Result<Take> {
    let name = file_name(path);
    let failed = |source| Error::io(name.as_str(), source);
    let file = files::open(path, &name, "a recording")?;
    let size = file.metadata().map_err(failed)?.len();
    if size > LARGEST {
        let [size, largest] = [size, LARGEST].map(|bytes| bytes as f64 / f64::from(1 << 20));
        let message = format!("it has {size:.0} MB: expected at most {largest:.0}; cut out a single stroke");
        return Err(Error::format(&name, message));
    }
    let recording = sound_file::read(file, &name)?;
    Ok(Take { name, recording, key: None, velocity: VELOCITY })
}

/// The last part of a path, safe to show.
fn file_name(path: &Path) -> String {
    printable(&path.file_name().unwrap_or_default().to_string_lossy()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_is_dropped_has_ended() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/sounds/tone.flac");
        let work = Work::start(vec![path.into()]).unwrap();
        let shared = work.shared.clone();
        drop(work);
        assert_eq!(Arc::strong_count(&shared), 1, "its thread is gone");
    }
}
