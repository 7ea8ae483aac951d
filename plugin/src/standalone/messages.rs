//! Messages for the user, on stderr and in the window.

use crate::params::SprungParams;
use sprung::internals::text::printable;

/// Prints a line on stderr; errors of printing are ignored.
pub(super) fn print(line: &str) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr(), "{}", printable(line));
}

/// Shows on stderr and in the window what went wrong.
pub(super) fn report(params: &SprungParams, messages: impl IntoIterator<Item = String>) {
    messages.into_iter().for_each(|line| show(params, Err(line)));
}

/// Shows on stderr and in the window what was done.
pub(super) fn tell(params: &SprungParams, messages: impl IntoIterator<Item = String>) {
    messages.into_iter().for_each(|line| show(params, Ok(line)));
}

/// Shows a message on stderr and in the window: what was done, or what went wrong.
pub(super) fn show(params: &SprungParams, message: Result<String, String>) {
    let (Ok(line) | Err(line)) = &message;
    print(&format!("sprung: {line}"));
    params.link().report(message);
}
