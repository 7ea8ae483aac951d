//! The manifest of a batch: a line of JSON for each finished job, in the order of their numbers.

use crate::error::{Error, Result};
use crate::io::Journal;
use serde_json::{Map, Value};
use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// The version that writes the lines. Another version may render other sounds for the same jobs.
pub(super) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Beginning and end of the names of manifests.
const STEM: &str = "manifest";
const ENDING: &str = ".jsonl";

/// The name of the manifest of a shard; `index` counts from 0.
pub(super) fn name([index, count]: [u64; 2]) -> String {
    if count == 1 { format!("{STEM}{ENDING}") } else { format!("{STEM}-{}-of-{count}{ENDING}", index + 1) }
}

/// Whether a text consists of digits.
pub(super) fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// Whether a file of this name is the manifest of a batch or of a shard.
pub(super) fn is_name(file: &str) -> bool {
    match file.strip_prefix(STEM).and_then(|rest| rest.strip_suffix(ENDING)) {
        Some("") => true,
        Some(shard) => {
            let numbers = shard.strip_prefix('-').and_then(|shard| shard.split_once("-of-"));
            numbers.is_some_and(|(index, count)| is_number(index) && is_number(count))
        }
        None => false,
    }
}

/// A line of a manifest, with the parts that are needed to resume a batch.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub(super) number: u64,
    version: String,
    /// The file, relative to the folder.
    pub(super) file: String,
    pub(super) sha256: String,
    /// The job with its drawn values, and the seed with which it was rendered.
    pub(super) job: Map<String, Value>,
    pub(super) seed: u64,
    /// The whole line, without its end.
    pub(super) line: String,
}

impl Entry {
    fn parse(line: &str) -> Option<Self> {
        let value: Value = serde_json::from_str(line).ok()?;
        let text = |key: &str| value[key].as_str().map(str::to_owned);
        Some(Self {
            number: value["number"].as_u64()?,
            version: text("version")?,
            file: text("file")?,
            sha256: text("sha256")?,
            job: value["job"].as_object()?.clone(),
            seed: value["seed"].as_u64()?,
            line: line.to_owned(),
        })
    }
}

/// Reads the finished lines of one manifest in order.
struct Reader {
    path: PathBuf,
    reader: BufReader<File>,
    next: Option<Entry>,
}

impl Reader {
    fn open(path: PathBuf) -> Result<Self> {
        let file = File::open(&path).map_err(|source| Error::io(path.display().to_string(), source))?;
        let mut reader = Self { path, reader: BufReader::new(file), next: None };
        reader.advance()?;
        Ok(reader)
    }

    /// Reads the next line. A line without a line end was cut off when its writer was killed, and is ignored.
    fn advance(&mut self) -> Result<()> {
        // Read as bytes, since a line may have been cut off within a character.
        let mut line = Vec::new();
        let read = self.reader.read_until(b'\n', &mut line);
        read.map_err(|source| Error::io(self.path.display().to_string(), source))?;
        self.next = match line.strip_suffix(b"\n") {
            None => None,
            Some(line) => Some(str::from_utf8(line).ok().and_then(Entry::parse).ok_or_else(|| {
                Error::format(
                    self.path.display().to_string(),
                    "not a manifest: expected lines as this command writes them",
                )
            })?),
        };
        match self.next.as_ref().filter(|entry| entry.version != VERSION) {
            None => Ok(()),
            Some(entry) => {
                let message = format!(
                    "version {0} has made job {1}, and this is version {VERSION}, which may make another sound of it: go on with \
                     version {0}, or choose a new folder",
                    entry.version, entry.number
                );
                Err(Error::value(self.path.display().to_string(), message))
            }
        }
    }
}

/// The finished jobs according to the manifests in a folder. Manifests are in the order of the jobs' numbers, so that
/// all are read in parallel, and memory use does not grow with them.
pub(super) struct Known(Vec<Reader>);

impl Known {
    /// No manifests.
    pub(super) const NONE: Self = Self(Vec::new());

    /// The manifests in a folder, of all shards.
    pub(super) fn open(folder: &Path) -> Result<Self> {
        let failed = |source| Error::io(folder.display().to_string(), source);
        let mut paths = Vec::new();
        for entry in fs::read_dir(folder).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            if is_name(name) {
                paths.push(path);
            }
        }
        paths.sort();
        paths.into_iter().map(Reader::open).collect::<Result<_>>().map(Self)
    }

    /// The line of a job, if any manifest has it. Numbers must rise from call to call.
    pub(super) fn find(&mut self, number: u64) -> Result<Option<Entry>> {
        let mut found = None;
        for manifest in &mut self.0 {
            while manifest.next.as_ref().is_some_and(|entry| entry.number < number) {
                manifest.advance()?;
            }
            if manifest.next.as_ref().is_some_and(|entry| entry.number == number) {
                found = found.or(manifest.next.clone());
            }
        }
        Ok(found)
    }
}

/// The manifest that is being written.
pub(super) struct Manifest {
    journal: Journal,
    /// Number of lines that existed at the start.
    pub(super) lines: u64,
}

impl Manifest {
    /// Opens or creates a manifest. With `resume`, an existing one is continued; an incomplete last line is cut off. Without, it must be
    /// empty: a batch whose first job failed leaves it so.
    pub(super) fn open(path: &Path, resume: bool) -> Result<Self> {
        let mut journal = Journal::open(path)?;
        if !resume && !journal.is_empty()? {
            let message = "a batch is there already: add --resume to go on with it, or choose another folder";
            return Err(Error::value(&journal.name, message));
        }
        let lines = journal.go_on()?;
        Ok(Self { journal, lines })
    }

    /// Appends a line.
    pub(super) fn write(&mut self, line: &str) -> Result<()> {
        self.journal.write(line)
    }
}
