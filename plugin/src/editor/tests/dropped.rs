//! Files dropped on the window, which reads them by their paths.

use egui::DroppedFile;
use std::path::{Path, PathBuf};

#[derive(Debug)]
pub(super) struct Dropped(pub(super) PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        unreachable!("the window reads files itself")
    }
}

/// The place of a file in the repository's assets.
pub(super) fn asset(path: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../assets")).join(path)
}
