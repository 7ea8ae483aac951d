//! Reads a file of jobs line by line, since it may be larger than memory.

use super::Batch;
use super::draw::Chance;
use super::template::{Drawn, Fault, Template};
use crate::error::{Error, Result};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};

/// U+FEFF in UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// Longest line in bytes.
const LONGEST: u64 = 1 << 20;

/// A job to render.
pub(super) struct Task {
    /// Its number in the whole batch, from 0.
    pub(super) number: u64,
    /// File and line that it comes from.
    pub(super) origin: String,
    pub(super) drawn: Drawn,
}

/// The jobs of a file, in order. Each line makes one job or several; empty lines make none.
pub(super) struct Jobs<'a> {
    batch: &'a Batch,
    reader: BufReader<File>,
    line: u64,
    template: Option<Template>,
    /// Number of jobs that the present line has left.
    left: u64,
    number: u64,
}

impl<'a> Jobs<'a> {
    /// The jobs of the batch's shard.
    pub(super) fn open(batch: &'a Batch) -> Result<Self> {
        let file = File::open(&batch.jobs).map_err(|source| Error::io(batch.jobs.display().to_string(), source))?;
        Ok(Self { batch, reader: BufReader::new(file), line: 0, template: None, left: 0, number: 0 })
    }

    /// Reads and checks all lines, and returns the number of jobs of the shard.
    pub(super) fn count(mut self) -> Result<u64> {
        let mut all = 0_u64;
        let mut read = BTreeSet::new();
        while self.next_template()? {
            if let Some(template) = &self.template {
                template.check_sounds(self.batch, &mut read).map_err(|fault| self.fault(fault))?;
            }
            all = all.saturating_add(self.left);
        }
        let [index, count] = self.batch.shard.of();
        Ok(all.saturating_sub(index).div_ceil(count))
    }

    /// The next job.
    pub(super) fn next(&mut self) -> Result<Option<Task>> {
        let [index, count] = self.batch.shard.of();
        loop {
            while self.left == 0 {
                if !self.next_template()? {
                    return Ok(None);
                }
            }
            let number = self.number;
            (self.number, self.left) = (number + 1, self.left - 1);
            if number % count != index {
                continue;
            }
            let Some(template) = &self.template else { return Ok(None) };
            let drawn = template.draw(Chance::new(self.batch.seed, number)).map_err(|fault| self.fault(fault))?;
            return Ok(Some(Task { number, origin: self.origin(), drawn }));
        }
    }

    /// Advances to the next line that is not empty. Returns whether there is one.
    fn next_template(&mut self) -> Result<bool> {
        let mut text = Vec::new();
        loop {
            text.clear();
            let read = self.reader.by_ref().take(LONGEST + 1).read_until(b'\n', &mut text);
            if read.map_err(|source| Error::io(self.batch.jobs.display().to_string(), source))? == 0 {
                return Ok(false);
            }
            self.line += 1;
            if text.len() as u64 > LONGEST {
                return Err(self.fault(("line".to_owned(), "too long: expected at most 1 MiB".to_owned())));
            }
            // Some editors begin a file with a byte order mark.
            if self.line == 1 && text.starts_with(BYTE_ORDER_MARK) {
                text.drain(..BYTE_ORDER_MARK.len());
            }
            if !text.trim_ascii().is_empty() {
                break;
            }
        }
        let text = str::from_utf8(&text);
        let text = text.map_err(|_| self.fault(("line".to_owned(), "expected UTF-8 text".to_owned())))?;
        let template = Template::parse(text, self.batch).map_err(|fault| self.fault(fault))?;
        self.left = template.repeat;
        self.template = Some(template);
        Ok(true)
    }

    fn origin(&self) -> String {
        format!("{}:{}", self.batch.jobs.display(), self.line)
    }

    fn fault(&self, (key, message): Fault) -> Error {
        Error::format(self.origin(), format!("{key}: {message}"))
    }
}
