//! A file of finished work, a line each, from which an interrupted run goes on.

use crate::error::{Error, Result};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

/// A journal that is open to be continued. While it is, no other process can write it.
pub(crate) struct Journal {
    /// Its name in errors.
    pub(crate) name: String,
    file: File,
}

impl Journal {
    /// Opens or creates a journal, and changes nothing of it yet.
    ///
    /// # Errors
    /// [`Error::Locked`] if another process writes it, [`Error::Io`].
    pub(crate) fn open(path: &Path) -> Result<Self> {
        let name = path.display().to_string();
        // Not in the mode that appends: Windows does not let such a file be shortened.
        let opened = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
        let file = opened.map_err(|source| Error::io(&name, source))?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => Err(Error::Locked { path: name }),
            // Some file systems have no locks.
            Ok(()) | Err(TryLockError::Error(_)) => Ok(Self { name, file }),
        }
    }

    /// Whether there is nothing in it.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(crate) fn is_empty(&self) -> Result<bool> {
        self.file.metadata().map(|metadata| metadata.len() == 0).map_err(|source| Error::io(&self.name, source))
    }

    /// Everything in it.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(crate) fn text(&mut self) -> Result<String> {
        let mut text = String::new();
        let read = self.file.seek(SeekFrom::Start(0)).and_then(|_| self.file.read_to_string(&mut text));
        read.map(|_| text).map_err(|source| Error::io(&self.name, source))
    }

    /// Cuts off a line without an end, which was cut short when its writer was killed, and goes on after the whole lines. Returns
    /// their number. Memory use does not grow with it.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(crate) fn go_on(&mut self) -> Result<u64> {
        let failed = |source| Error::io(&self.name, source);
        self.file.seek(SeekFrom::Start(0)).map_err(failed)?;
        let (mut lines, mut whole, mut at, mut block) = (0, 0, 0, vec![0; 1 << 16]);
        loop {
            let read = self.file.read(&mut block).map_err(failed)?;
            if read == 0 {
                break;
            }
            for (index, _) in block[..read].iter().enumerate().filter(|(_, byte)| **byte == b'\n') {
                (lines, whole) = (lines + 1, at + index as u64 + 1);
            }
            at += read as u64;
        }
        self.file.set_len(whole).and_then(|()| self.file.seek(SeekFrom::Start(whole))).map_err(failed)?;
        Ok(lines)
    }

    /// Appends a line.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(crate) fn write(&mut self, line: &str) -> Result<()> {
        // In one write, so that a killed process leaves a whole line or the beginning of one.
        let written = self.file.write_all(format!("{line}\n").as_bytes());
        written.map_err(|source| Error::io(&self.name, source))
    }
}
