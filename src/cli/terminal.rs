//! Writes to stdout and stderr, without control characters that would affect the terminal.

pub(super) use sprung::internals::text::counted;
use sprung::internals::text::{printable, printable_lines};
use sprung::{Error, Result};
use std::fmt::Display;
use std::io::{ErrorKind, Write};

/// Prints one line on stderr, without control characters.
pub(super) fn complain(severity: &str, message: impl Display) {
    complain_lines(&format!("sprung: {severity}: {}\n", printable(&message.to_string())));
}

/// Prints a warning.
pub(super) fn warn(message: &str) {
    complain("warning", message);
}

/// Writes lines to stderr, without control characters. Errors are ignored: if stderr is closed, nothing can be
/// reported.
pub(super) fn complain_lines(text: &str) {
    let _ = write!(std::io::stderr(), "{}", printable_lines(text));
}

/// Writes lines to stdout, without control characters.
pub(super) fn print(text: &str) -> Result<()> {
    let mut stdout = std::io::stdout().lock();
    checked(stdout.write_all(printable_lines(text).as_bytes()).and_then(|()| stdout.flush()))
}

/// Checks the result of writing to stdout. A reader such as `head` may close the pipe when it has enough: this is not
/// an error.
pub(super) fn checked(written: std::io::Result<()>) -> Result<()> {
    match written {
        Err(error) if !is_closed(&error) => Err(Error::io("stdout", error)),
        _ => Ok(()),
    }
}

/// Whether the reader of a pipe has closed it.
pub(super) fn is_closed(error: &std::io::Error) -> bool {
    // Windows has three errors for this, of which the standard library knows two.
    const ERROR_PIPE_NOT_CONNECTED: i32 = 233;
    error.kind() == ErrorKind::BrokenPipe || (cfg!(windows) && error.raw_os_error() == Some(ERROR_PIPE_NOT_CONNECTED))
}
