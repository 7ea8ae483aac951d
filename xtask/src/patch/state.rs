//! An edit of how a state is read: it only silences a warning of the compiler.

use super::edit::{Edit, edit};

// In release builds the last arm does not use the two names that it binds, and rustc warns, since cargo hides warnings of registry
// packages only. The outer variables have the same names and values, so `_` does.
pub(super) const EDITS: &[Edit] =
    &[edit("src/wrapper/state.rs", "                (param_ptr, param_value) => {\n", "                _ => {\n")];
