//! An edit of how a state is read: the compiler warns of nothing in it.

use super::edit::{Edit, STATE, edit};

// Only builds with assertions use the two names that the last arm gives, and a package beside ours is not spared the warnings. Names
// of the same values stand outside the match.
pub(super) const EDITS: &[Edit] =
    &[edit(STATE, "                (param_ptr, param_value) => {\n", "                _ => {\n")];
