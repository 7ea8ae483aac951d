//! How many cases a test goes through: a well chosen part of them, or all in the long suite.

use std::cell::Cell;

thread_local! {
    static IS_THOROUGH: Cell<bool> = const { Cell::new(false) };
}

/// Says whether the test that begins on this thread goes through all of its cases.
pub(crate) fn set(is_thorough: bool) {
    IS_THOROUGH.set(is_thorough);
}

/// The number of cases, rounds or frames.
pub(crate) fn of(few: usize, all: usize) -> usize {
    if IS_THOROUGH.get() { all } else { few }
}
