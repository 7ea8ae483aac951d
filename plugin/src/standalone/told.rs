//! Messages for the user, on stderr and in the window.

use crate::params::SprungParams;
use sprung::text::printable;

/// Prints a line on stderr; errors of printing are ignored.
pub(super) fn complain(line: &str) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr(), "{}", printable(line));
}

/// Shows messages on stderr and in the window.
pub(super) fn tell(params: &SprungParams, news: impl IntoIterator<Item = String>) {
    for line in news {
        complain(&format!("sprung: {line}"));
        params.link().tell(line);
    }
}
