//! The list of finished samples, a line of JSON each: what a resumed run need not make again.

use super::settings::Sampling;
use crate::error::{Error, Result};
use crate::io::Journal;
use crate::preset::Playable;
use serde_json::{Value, json};
use std::fs::Metadata;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// A finished sample.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    /// The file, relative to the folder.
    pub(super) file: String,
    pub(super) frames: u64,
    /// The file’s size, by which one that was cut off or replaced since is recognised.
    pub(super) bytes: u64,
    /// The first frame of its loop, and the one after the last.
    pub(super) looped: Option<[u64; 2]>,
    /// Seconds in which it falls by 60 dB when the key is let go; none if it rings on.
    pub(super) release: Option<f64>,
    /// dB a second by which the held sound falls, if the sample is what sounds after it.
    pub(super) fall: Option<f64>,
}

/// The list, as it was at the start, and open to be continued.
pub(super) struct List {
    known: Vec<Line>,
    journal: Mutex<Journal>,
    /// The first line, until it is written.
    settings: Option<String>,
}

impl Line {
    fn parse(line: &str) -> Option<Self> {
        let value: Value = serde_json::from_str(line).ok()?;
        let ends = |value: &Value| Some([value[0].as_u64()?, value[1].as_u64()?]);
        Some(Self {
            file: value["file"].as_str()?.to_owned(),
            frames: value["frames"].as_u64()?,
            bytes: value["bytes"].as_u64()?,
            looped: ends(&value["loop"]),
            release: value["release"].as_f64(),
            fall: value["fall"].as_f64(),
        })
    }
}

impl List {
    /// Opens the list of a folder.
    pub(super) fn open(sampling: &Sampling, playable: &Playable) -> Result<Self> {
        let mut journal = Journal::open(&sampling.folder.join("samples.jsonl"))?;
        let (settings, before) = (settings(sampling, playable), journal.text()?);
        // A line without an end was cut off when its writer was killed.
        let whole = before.rfind('\n').map_or(0, |end| end + 1);
        let mut lines = before[..whole].lines();
        let first = lines.next();
        if first.is_some() && !sampling.resume {
            let message = "an instrument is there already: add --resume to go on with it, or choose another folder";
            return Err(Error::value(&journal.name, message));
        }
        if first.is_some_and(|first| first != settings) {
            let message = "it has other settings, or another version has made it: expected the same, or another folder";
            return Err(Error::value(&journal.name, message));
        }
        let known = lines.filter_map(Line::parse).collect();
        journal.go_on()?;
        let settings = Some(settings).filter(|_| first.is_none());
        Ok(Self { known, journal: Mutex::new(journal), settings })
    }

    /// Writes the settings if the list is new. From then on, the folder has an instrument that can be resumed.
    pub(super) fn begin(&self) -> Result<()> {
        self.settings.iter().try_for_each(|settings| self.write(settings))
    }

    /// The line of a file, if it was finished before and is there as it was.
    pub(super) fn find(&self, folder: &Path, file: &str) -> Option<Line> {
        let is_there = |line: &&Line| line.file == file && bytes(&folder.join(file)) == Some(line.bytes);
        // A file that was made again has another line, further down.
        self.known.iter().rev().find(is_there).cloned()
    }

    /// Adds a finished sample.
    pub(super) fn add(&self, line: &Line) -> Result<()> {
        let Line { file, frames, bytes, looped, release, fall } = line;
        let line =
            json!({ "file": file, "frames": frames, "bytes": bytes, "loop": looped, "release": release, "fall": fall });
        self.write(&line.to_string())
    }

    fn write(&self, line: &str) -> Result<()> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner).write(line)
    }
}

/// The length of a file; none if there is no such file.
pub(super) fn bytes(path: &Path) -> Option<u64> {
    path.metadata().ok().filter(Metadata::is_file).map(|about| about.len())
}

/// All that a sample depends on.
fn settings(sampling: &Sampling, playable: &Playable) -> String {
    let Sampling { keys, every, velocities, strikes, releases, length, rate, bits, format, seed, .. } = sampling;
    let keys = keys.as_ref().map(|keys| [*keys.start(), *keys.end()]);
    // A kit's own text has only the names of its presets.
    let presets: Vec<String> = playable.clone().presets_mut().iter().map(|preset| preset.to_toml()).collect();
    let settings = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "sound": playable.to_toml(),
        "presets": presets,
        "keys": keys,
        "every": every,
        "velocities": velocities,
        "strikes": strikes,
        "releases": releases,
        "length": length,
        "rate": rate,
        "bits": bits.bits(),
        "float": *bits == crate::io::SampleFormat::Float32,
        "format": format.ending(),
        "seed": seed,
    });
    settings.to_string()
}
