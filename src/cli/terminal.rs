//! What is written to stdout and stderr: with nothing in it that steers the terminal.

use sprung::text::{printable, printable_lines};
use sprung::{Error, Result};
use std::fmt::Display;
use std::io::{ErrorKind, Write};

/// Says one line on stderr, with nothing in it that steers the terminal.
pub(super) fn complain(severity: &str, message: impl Display) {
    complain_lines(&format!("sprung: {severity}: {}\n", printable(&message.to_string())));
}

/// Writes lines to stderr, with nothing in them that steers the terminal. If it is closed, there is nobody left to tell.
pub(super) fn complain_lines(text: &str) {
    let _ = write!(std::io::stderr(), "{}", printable_lines(text));
}

/// Writes lines to stdout, with nothing in them that steers the terminal.
pub(super) fn print(text: &str) -> Result<()> {
    let mut stdout = std::io::stdout().lock();
    checked(stdout.write_all(printable_lines(text).as_bytes()).and_then(|()| stdout.flush()))
}

/// What came of writing to stdout. A reader that has gone away, as `head` does, has what it wanted: that is no error.
pub(super) fn checked(written: std::io::Result<()>) -> Result<()> {
    match written {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Error::io("stdout", error)),
        _ => Ok(()),
    }
}
