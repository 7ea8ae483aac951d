//! Why a row of the table has no result.

/// Why the program was not built or did not succeed.
#[derive(Debug, PartialEq)]
pub(super) enum Stopped {
    /// This machine lacks the CPU or a tool for it: the row is left out.
    Missing(String),
    /// The program failed or does not build: the chore fails.
    Failed(String),
}
