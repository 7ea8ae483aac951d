//! Batches of sounds.

use crate::failure::{raised, told};
use pyo3::prelude::*;
use sprung::batch::{Batch, Done, FileFormat, Shard};
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Time between two calls of the progress function, and between two checks for the end of the work or Ctrl-C.
const PATIENCE: Duration = Duration::from_millis(100);
const POLL: Duration = Duration::from_millis(10);

/// Renders the jobs of a file. Returns the number of jobs, and how many of them were finished before.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "they are the options of the command")]
pub(crate) fn batch(
    py: Python<'_>,
    jobs: PathBuf,
    out: PathBuf,
    shard: (u64, u64),
    resume: bool,
    seed: u64,
    flac: bool,
    at_once: Option<u16>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(u64, u64)> {
    let format = if flac { FileFormat::Flac } else { FileFormat::Wav };
    let shard = Shard::new(shard.0, shard.1).map_err(raised)?;
    let batch = Batch { jobs, folder: out, format, seed, shard, resume, at_once };
    // The exception of the caller's function or of Ctrl-C, which ends the batch.
    let (raised_by_caller, looked) = (Mutex::new(None), Mutex::new(Instant::now()));
    let stop = |error: PyErr| {
        if let Ok(mut place) = raised_by_caller.lock() {
            place.get_or_insert(error);
        }
    };
    let is_stopped = || raised_by_caller.lock().is_ok_and(|place| place.is_some());
    let tell = |done: Done| {
        if is_stopped() {
            return Err(sprung::Error::Interrupted);
        }
        let is_due = done.jobs == done.of
            || looked.try_lock().is_ok_and(|mut looked| {
                let is_due = looked.elapsed() >= PATIENCE;
                if is_due {
                    *looked = Instant::now();
                }
                is_due
            });
        if let Some(progress) = progress.as_ref().filter(|_| is_due) {
            Python::attach(|py| progress.call1(py, (done.jobs, done.of)).map(drop)).map_err(|error| {
                stop(error);
                sprung::Error::Interrupted
            })?;
        }
        Ok(())
    };
    // Python handles Ctrl-C only on the thread that called.
    let done = py.detach(|| {
        std::thread::scope(|scope| {
            let work = scope.spawn(|| batch.run(&tell));
            while !work.is_finished() {
                std::thread::sleep(POLL);
                if let Err(error) = Python::attach(|py| py.check_signals()) {
                    stop(error);
                }
            }
            work.join()
        })
    });
    if let Some(error) = raised_by_caller.into_inner().ok().flatten() {
        return Err(error);
    }
    let done = done.map_err(|_| told("the batch broke off, which is a defect of the synthesizer".to_owned()))?;
    done.map(|done| (done.jobs, done.found)).map_err(raised)
}
