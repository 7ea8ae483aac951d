//! Renders thousands of sounds from a file of jobs, with exact labels.
//!
//! A file of jobs has one JSON object per line, with the names of [`Request`](crate::request::Request) and of
//! parameters. Values may be drawn at random. Each job makes a file, and a line of the manifest; lines are in the order
//! of the jobs' numbers. A killed batch can be resumed, and its shards can be rendered on different machines: files and
//! manifest are the same bytes as without interruption.
//!
//! A job is a function of the file of jobs, the seed and its number. Any thread may make any job, and lines wait until
//! those before them are written; so a manifest is always a beginning of the whole one, whenever its writer is killed.
//! Resuming reads it beside the jobs and compares. So neither memory nor the bytes depend on the number of jobs,
//! threads or shards. Tests: `tests/cli/batches.rs` kills batches, cuts manifests and compares shards;
//! `tests/cli/batches_at_scale.rs` does so with 2,000 sounds, on demand.

mod checks;
mod draw;
mod jobs;
mod make;
mod manifest;
mod run;
mod scalar;
mod template;
mod twice;

use crate::error::{Error, Result};
pub use crate::io::FileFormat;
use std::path::PathBuf;

/// One of several parts of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: u64,
    count: u64,
}

impl Shard {
    /// The `number`-th part, from 1, of `count` parts. It has the jobs whose numbers, from 0, leave `number` − 1 when
    /// divided by `count`.
    ///
    /// # Errors
    /// [`Error::Value`] if there is no such part.
    pub fn new(number: u64, count: u64) -> Result<Self> {
        if (1..=count).contains(&number) {
            return Ok(Self { index: number - 1, count });
        }
        Err(Error::value(
            "shard",
            format!("there is no part {number} of {count}: expected 1/{count} to {count}/{count}"),
        ))
    }

    fn of(self) -> [u64; 2] {
        [self.index, self.count]
    }
}

/// The settings of a batch.
#[derive(Clone, Debug)]
pub struct Batch {
    /// The file of jobs.
    pub jobs: PathBuf,
    /// The folder for all outputs. It is created if it does not exist.
    pub folder: PathBuf,
    /// The format of the files.
    pub format: FileFormat,
    /// Seed of all drawn values.
    pub seed: u64,
    /// The shard to render.
    pub shard: Shard,
    /// Whether to resume an existing batch.
    pub resume: bool,
    /// Number of jobs at once; none for one per core.
    pub at_once: Option<u16>,
}

/// Progress of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Done {
    /// Finished jobs, including those that were finished before.
    pub jobs: u64,
    /// Of these, the jobs that were finished before.
    pub found: u64,
    /// All jobs of the shard.
    pub of: u64,
}
