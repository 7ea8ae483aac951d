//! What the user is told: on stderr, and in the window.

use crate::params::SprungParams;
use sprung::text::printable;

/// Prints a line on stderr, whether or not anybody reads it.
pub(super) fn complain(line: &str) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr(), "{}", printable(line));
}

/// Tells the user on stderr and in the window.
pub(super) fn tell(params: &SprungParams, news: impl IntoIterator<Item = String>) {
    for line in news {
        complain(&format!("sprung: {line}"));
        params.link().tell(line);
    }
}
