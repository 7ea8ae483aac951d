//! The errors in a preset or kit: readers continue after each error, so that all of them can be reported.

use crate::error::{Error, Result};

/// Errors in a text, in the order in which they were found.
#[derive(Debug, Default)]
pub(super) struct Complaints(Vec<String>);

impl Complaints {
    /// Adds an error.
    pub(super) fn add(&mut self, complaint: impl Into<String>) {
        self.0.push(complaint.into());
    }

    /// The value that was read; on an error, adds the error with the prefix `place`, and returns none.
    pub(super) fn take<T>(&mut self, place: &str, read: std::result::Result<T, String>) -> Option<T> {
        read.map_err(|complaint| self.add(format!("{place}{complaint}"))).ok()
    }

    /// All errors.
    pub(super) fn into_lines(self) -> Vec<String> {
        self.0
    }

    /// Returns the first error, if there is any, as an error in the text `origin`.
    pub(super) fn into_first(self, origin: &str) -> Result<()> {
        match self.0.into_iter().next() {
            None => Ok(()),
            Some(first) => Err(Error::format(origin, first)),
        }
    }
}
