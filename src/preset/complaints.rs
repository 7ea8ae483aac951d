//! What a reader of presets and kits could not take: readers go on after each complaint, so that all of them are told.

use crate::error::{Error, Result};

/// What is wrong with a text, in the order of reading.
#[derive(Debug, Default)]
pub(super) struct Complaints(Vec<String>);

impl Complaints {
    /// Adds one.
    pub(super) fn add(&mut self, complaint: impl Into<String>) {
        self.0.push(complaint.into());
    }

    /// What was read, or nothing with the complaint about it, which begins with `place`.
    pub(super) fn take<T>(&mut self, place: &str, read: std::result::Result<T, String>) -> Option<T> {
        read.map_err(|complaint| self.add(format!("{place}{complaint}"))).ok()
    }

    /// All of them.
    pub(super) fn into_lines(self) -> Vec<String> {
        self.0
    }

    /// The first as the error of a text called `origin`, if there are any.
    pub(super) fn into_first(self, origin: &str) -> Result<()> {
        match self.0.into_iter().next() {
            None => Ok(()),
            Some(first) => Err(Error::format(origin, first)),
        }
    }
}
