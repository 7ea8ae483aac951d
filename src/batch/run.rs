//! Renders the jobs of a batch on all cores, and writes their manifest lines in order.

use super::jobs::{Jobs, Task};
use super::make::{file_of, has_sha256, make};
use super::manifest::{self, Entry, Known, Manifest};
use super::{Batch, Done};
use crate::error::{Error, Result};
use crate::render::on_threads;
use std::collections::BTreeMap;
use std::fs;
use std::panic::{self, AssertUnwindSafe};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// How many jobs may be ahead of an unfinished one: their lines wait in memory.
const WINDOW: u64 = if cfg!(test) { 4 } else { 1024 };

impl Batch {
    /// Renders all jobs of the shard. Every line of the file of jobs is checked before the first job starts. `progress`
    /// is called after each job and during long ones, by several threads, and can end the work by returning an error.
    ///
    /// Memory use does not grow with the number of jobs.
    ///
    /// # Errors
    /// [`Error::Format`] with file, line and key for an invalid job; [`Error::Value`] if a batch exists and is not to
    /// be resumed, or if it has other jobs; [`Error::Io`]; and the errors of `progress`. Finished jobs are kept, and
    /// the batch can be resumed.
    pub fn run(&self, progress: &(dyn Fn(Done) -> Result<()> + Sync)) -> Result<Done> {
        let name = manifest::name(self.shard.of());
        let path = self.folder.join(&name);
        // Resuming would cut off its last line if that has no line end.
        if self.own(&self.jobs).is_some() || same_file::is_same_file(&self.jobs, &path).unwrap_or(false) {
            let message = "this batch writes this file itself: expected another file of jobs, or another folder";
            return Err(Error::value(self.jobs.display().to_string(), message));
        }
        let changed = |message| Err(Error::value(self.jobs.display().to_string(), message));
        if fs::metadata(&self.jobs).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir()) {
            return changed("jobs are read twice, which a pipe or device does not allow: expected a file".to_owned());
        }
        let of = Jobs::open(self)?.count()?;
        fs::create_dir_all(&self.folder).map_err(|source| Error::io(self.folder.display().to_string(), source))?;
        let manifest = Manifest::open(&path, self.resume)?;
        let known = if self.resume { Known::open(&self.folder)? } else { Known::NONE };
        if manifest.lines > of {
            let message = format!("{} jobs are finished there, of {of}: expected the same jobs", manifest.lines);
            return Err(Error::value(name, message));
        }
        let (written, next) = (manifest.lines, 0);
        let queue = Queue {
            batch: self,
            state: Mutex::new(State { jobs: Jobs::open(self)?, known, taken: 0, failed: None }),
            finished: Mutex::new(Finished { manifest, written, next, waiting: BTreeMap::new(), found: 0 }),
            advanced: Condvar::new(),
            of,
            progress,
        };
        on_threads(self.at_once, || rayon::broadcast(|_| queue.work()))?;
        let state = queue.state.into_inner().unwrap_or_else(PoisonError::into_inner);
        let finished = queue.finished.into_inner().unwrap_or_else(PoisonError::into_inner);
        match state.failed {
            Some(error) => Err(error),
            None if finished.next != of => changed(format!(
                "it had {of} jobs to make at first, and {} later: expected a file that stays as it is",
                finished.next
            )),
            None => Ok(Done { jobs: finished.next, found: finished.found, of }),
        }
    }
}

/// The jobs that are left.
struct State<'a> {
    jobs: Jobs<'a>,
    known: Known,
    /// Number of jobs taken by the threads.
    taken: u64,
    /// The first error that occurred. No job is taken after it.
    failed: Option<Error>,
}

/// The finished jobs.
struct Finished {
    manifest: Manifest,
    /// Number of lines in the manifest at the start.
    written: u64,
    /// Index of the next line among the jobs of the shard.
    next: u64,
    /// Finished lines that wait for earlier ones, by their index, and whether each job was finished before.
    waiting: BTreeMap<u64, (String, bool)>,
    /// How many of the jobs before `next` were finished before.
    found: u64,
}

/// The queue from which the threads take jobs, and to which they return the lines.
struct Queue<'a> {
    batch: &'a Batch,
    state: Mutex<State<'a>>,
    finished: Mutex<Finished>,
    /// Signalled when lines were written or a job has failed.
    advanced: Condvar,
    of: u64,
    progress: &'a (dyn Fn(Done) -> Result<()> + Sync),
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Queue<'_> {
    /// Takes and renders jobs until none are left, or one has failed.
    fn work(&self) {
        let work = || {
            while let Some((place, task, known)) = self.take()? {
                self.make(place, &task, known)?;
            }
            Ok(())
        };
        match panic::catch_unwind(AssertUnwindSafe(work)) {
            Ok(Ok(())) => {}
            Ok(Err(error)) => self.fail(error),
            Err(panic) => {
                // Otherwise the other threads would wait for this job forever.
                self.fail(Error::Interrupted);
                panic::resume_unwind(panic);
            }
        }
    }

    /// Ends the work of all threads.
    fn fail(&self, error: Error) {
        lock(&self.state).failed.get_or_insert(error);
        // A thread that has just checked `failed` holds this lock until it waits, and is then woken.
        drop(lock(&self.finished));
        self.advanced.notify_all();
    }

    /// The next job, its index in the shard, and its line if it was finished before.
    fn take(&self) -> Result<Option<(u64, Task, Option<Entry>)>> {
        let mut state = lock(&self.state);
        if state.failed.is_some() {
            return Ok(None);
        }
        let Some(task) = state.jobs.next()? else { return Ok(None) };
        let known = state.known.find(task.number)?;
        let place = state.taken;
        state.taken += 1;
        Ok(Some((place, task, known)))
    }

    fn make(&self, place: u64, task: &Task, known: Option<Entry>) -> Result<()> {
        self.wait_for_room(place);
        let check = || (self.progress)(self.done());
        check()?;
        let (line, was_found) = match known {
            Some(entry) => {
                self.check_same(task, &entry)?;
                let is_whole = has_sha256(&self.batch.folder.join(&entry.file), &entry.sha256);
                let line = if is_whole { entry.line.clone() } else { make(task, self.batch, &check)? };
                if line != entry.line {
                    let message = format!(
                        "job {} gives another sound or other labels than its line says: they are of another version, or an input has changed; \
                         choose another folder",
                        task.number
                    );
                    return Err(Error::value(self.batch.folder.display().to_string(), message));
                }
                (line, is_whole)
            }
            None if place < lock(&self.finished).written => {
                let message = format!("its manifest leaves out job {}: expected another folder", task.number);
                return Err(Error::value(self.batch.folder.display().to_string(), message));
            }
            None => (make(task, self.batch, &check)?, false),
        };
        self.put(place, line, was_found)?;
        (self.progress)(self.done())
    }

    /// Waits while too many lines wait for an earlier job.
    fn wait_for_room(&self, place: u64) {
        let mut finished = lock(&self.finished);
        while place >= finished.next + WINDOW && lock(&self.state).failed.is_none() {
            finished = self.advanced.wait(finished).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Returns an error if a finished line belongs to another job.
    fn check_same(&self, task: &Task, entry: &Entry) -> Result<()> {
        let file = file_of(task.number, self.batch.format);
        let is_same = entry.job == task.drawn.line && entry.seed == task.drawn.request.seed && entry.file == file;
        if is_same {
            return Ok(());
        }
        let message = format!(
            "job {} is another there than in {}: expected the same jobs, --seed and --format, or another folder",
            task.number, task.origin
        );
        Err(Error::value(self.batch.folder.display().to_string(), message))
    }

    /// Stores a finished line, and writes all lines whose predecessors are written.
    fn put(&self, place: u64, line: String, was_found: bool) -> Result<()> {
        let mut finished = lock(&self.finished);
        finished.waiting.insert(place, (line, was_found));
        loop {
            let next = finished.next;
            let Some((line, was_found)) = finished.waiting.remove(&next) else { break };
            // The first lines may exist from an earlier run.
            if next >= finished.written {
                finished.manifest.write(&line)?;
            }
            finished.next += 1;
            finished.found += u64::from(was_found);
        }
        self.advanced.notify_all();
        Ok(())
    }

    fn done(&self) -> Done {
        let finished = lock(&self.finished);
        // Counts only jobs in the manifest: others are rendered again when the batch is resumed.
        Done { jobs: finished.next, found: finished.found, of: self.of }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FileFormat, Shard};
    use super::*;
    use std::path::Path;

    const JOB: &str = r#"{"note": "C2", "length": 0.001, "tail": "none", "rate": 8000}"#;

    fn batch(folder: &Path) -> Batch {
        Batch {
            jobs: folder.join("jobs.jsonl"),
            folder: folder.join("sounds"),
            format: FileFormat::Wav,
            seed: 0,
            shard: Shard::new(1, 1).unwrap(),
            resume: false,
            at_once: Some(2),
        }
    }

    #[test]
    fn a_panic_ends_all_threads() {
        use std::sync::atomic::{AtomicBool, Ordering};
        let folder = tempfile::tempdir().unwrap();
        let batch = batch(folder.path());
        fs::write(&batch.jobs, format!("{JOB}\n").repeat(50)).unwrap();
        let has_panicked = AtomicBool::new(false);
        let panic_once = |_: Done| -> Result<()> {
            assert!(has_panicked.swap(true, Ordering::Relaxed), "the first job panics");
            Ok(())
        };
        let ended = panic::catch_unwind(AssertUnwindSafe(|| batch.run(&panic_once)));
        assert!(ended.is_err());
        let made = fs::read_to_string(batch.folder.join("manifest.jsonl")).unwrap();
        assert!(made.lines().count() < 50);
    }

    #[test]
    fn jobs_that_become_fewer_are_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let batch = Batch { at_once: Some(1), ..batch(folder.path()) };
        // Larger than the reader's buffer.
        fs::write(&batch.jobs, format!("{JOB}\n{}{JOB}\n", "\n".repeat(100_000))).unwrap();
        let shorten = |_: Done| -> Result<()> {
            fs::write(&batch.jobs, JOB).unwrap();
            Ok(())
        };
        let error = batch.run(&shorten).unwrap_err().to_string();
        assert!(
            error.ends_with("it had 2 jobs to make at first, and 1 later: expected a file that stays as it is"),
            "{error}"
        );
    }
}
