//! Why a row of the table has no result.

/// What kept the program from being built or from ending well.
#[derive(Debug, PartialEq)]
pub(super) enum Stopped {
    /// This machine has not the CPU or a tool for it: the row is left out.
    Missing(String),
    /// It ran and failed, or does not build: the chore fails.
    Failed(String),
}
