//! Sounds by the thousand, from a file of jobs, with exact labels.
//!
//! A file of jobs has an object of JSON a line, with the names of [`Request`](crate::request::Request) and of parameters.
//! Values may be drawn by chance. Each job makes a file, and a line of the manifest, in the order of their numbers. A batch
//! that was killed can be gone on with; its shards can be made anywhere. Files and manifest are the same bytes then.

mod checks;
mod draw;
mod jobs;
mod make;
mod manifest;
mod run;
mod scalar;
mod template;

use crate::error::{Error, Result};
use std::path::PathBuf;

/// The format of the files of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileFormat {
    /// WAV.
    Wav,
    /// FLAC, which has the samples of the WAV in less room. It has no floats, and rates up to 96 kHz.
    Flac,
}

impl FileFormat {
    /// How file names end.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Wav => "wav",
            Self::Flac => "flac",
        }
    }
}

/// One of several parts of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: u64,
    count: u64,
}

impl Shard {
    /// The whole batch.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

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

/// A batch to make.
#[derive(Clone, Debug)]
pub struct Batch {
    /// The file of jobs.
    pub jobs: PathBuf,
    /// The folder that everything goes to. It is made if it is not there.
    pub folder: PathBuf,
    /// The format of the files.
    pub format: FileFormat,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// The part to make.
    pub shard: Shard,
    /// Whether to go on with a batch that is there.
    pub resume: bool,
    /// Jobs that are made at once; none for one a core.
    pub at_once: Option<u16>,
}

/// How far a batch is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Done {
    /// Jobs that are finished, those that were found finished included.
    pub jobs: u64,
    /// Of these, jobs that were found finished.
    pub found: u64,
    /// All jobs of the part.
    pub of: u64,
}
