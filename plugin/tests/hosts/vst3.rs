//! The VST3 bundle in hosts that Python drives.

use std::path::PathBuf;

/// The Python that `cargo xtask setup` has put the hosts into.
pub(crate) fn python() -> PathBuf {
    std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("python").join("bin/python")
}
