//! Messages for the user, on stderr and in the window.

use crate::params::SprungParams;
use sprung::text::printable;

/// Prints a line on stderr; errors of printing are ignored.
pub(super) fn print(line: &str) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr(), "{}", printable(line));
}

/// Shows messages on stderr and in the window.
pub(super) fn report(params: &SprungParams, messages: impl IntoIterator<Item = String>) {
    for line in messages {
        print(&format!("sprung: {line}"));
        params.link().report(line);
    }
}
