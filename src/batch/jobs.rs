//! A file of jobs, read line by line: it may be longer than memory.

use super::draw::Chance;
use super::template::{Drawn, Fault, Template};
use crate::error::{Error, Result};
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// Longest line in bytes.
const LONGEST: u64 = 1 << 20;

/// A job to do.
pub(super) struct Task {
    /// Its number in the whole batch, from 0.
    pub(super) number: u64,
    /// File and line that it comes from.
    pub(super) origin: String,
    pub(super) drawn: Drawn,
}

/// The jobs of a file, in order. Each line makes one job or several; empty lines make none.
pub(super) struct Jobs {
    path: PathBuf,
    reader: BufReader<File>,
    seed: u64,
    /// The jobs that are wanted: those whose number leaves `shard[0]` when divided by `shard[1]`.
    shard: [u64; 2],
    line: u64,
    template: Option<Template>,
    /// Jobs that the present line still makes.
    left: u64,
    number: u64,
}

impl Jobs {
    /// The jobs of a shard, counted from 0: one of so many.
    pub(super) fn open(path: &Path, seed: u64, shard: [u64; 2]) -> Result<Self> {
        let file = File::open(path).map_err(|source| Error::io(path.display().to_string(), source))?;
        let (path, reader) = (path.to_owned(), BufReader::new(file));
        Ok(Self { path, reader, seed, shard, line: 0, template: None, left: 0, number: 0 })
    }

    /// Reads all lines, checks them, and gives the number of jobs of the shard.
    pub(super) fn count(mut self) -> Result<u64> {
        let mut all = 0_u64;
        while self.next_template()? {
            all = all.saturating_add(self.left);
        }
        let [index, count] = self.shard;
        Ok(all.saturating_sub(index).div_ceil(count))
    }

    /// The next job.
    pub(super) fn next(&mut self) -> Result<Option<Task>> {
        loop {
            while self.left == 0 {
                if !self.next_template()? {
                    return Ok(None);
                }
            }
            let number = self.number;
            (self.number, self.left) = (number + 1, self.left - 1);
            if number % self.shard[1] != self.shard[0] {
                continue;
            }
            let Some(template) = &self.template else { return Ok(None) };
            let drawn = template.draw(Chance::new(self.seed, number)).map_err(|fault| self.fault(fault))?;
            return Ok(Some(Task { number, origin: self.origin(), drawn }));
        }
    }

    /// Goes on to the next line that is not empty. Returns whether there is one.
    fn next_template(&mut self) -> Result<bool> {
        let name = || self.path.display().to_string();
        let mut text = Vec::new();
        loop {
            text.clear();
            let read = self.reader.by_ref().take(LONGEST + 1).read_until(b'\n', &mut text);
            if read.map_err(|source| Error::io(name(), source))? == 0 {
                return Ok(false);
            }
            self.line += 1;
            if text.len() as u64 > LONGEST {
                return Err(self.fault(("line".to_owned(), "too long: expected at most 1 MiB".to_owned())));
            }
            if !text.trim_ascii().is_empty() {
                break;
            }
        }
        let text = str::from_utf8(&text);
        let text = text.map_err(|_| self.fault(("line".to_owned(), "expected UTF-8 text".to_owned())))?;
        let template = Template::parse(text).map_err(|fault| self.fault(fault))?;
        self.left = template.repeat;
        self.template = Some(template);
        Ok(true)
    }

    fn origin(&self) -> String {
        format!("{}:{}", self.path.display(), self.line)
    }

    fn fault(&self, (key, message): Fault) -> Error {
        Error::format(self.origin(), format!("{key}: {message}"))
    }
}
