//! What a download is called, and what became of one that needs a tool.

use std::path::{Path, PathBuf};

/// The result for a file that needs a tool. If the tool is there but fails, that is an error.
pub(super) enum Made {
    File(PathBuf),
    /// Not made, because something is missing: what, and how to get it.
    Nothing(String),
}

/// The path with the name of the packed folder and an ending.
pub(super) fn beside(stage: &Path, ending: &str) -> PathBuf {
    let name = stage.file_name().unwrap_or_default().to_string_lossy();
    stage.with_file_name(format!("{name}.{ending}"))
}
