//! A correction: replaces one piece of text by another.

/// Replaces a piece of text by another.
pub(super) struct Edit {
    /// Path of the file in the package.
    pub(super) file: &'static str,
    /// The old text.
    pub(super) old: &'static str,
    /// The new text.
    pub(super) new: &'static str,
    /// How often the old text occurs. Any other number means that the edit was written for a different source.
    pub(super) times: usize,
}

pub(super) const BUFFERS: &str = "src/wrapper/util/buffer_management.rs";
pub(super) const CLAP_CONTEXT: &str = "src/wrapper/clap/context.rs";
pub(super) const CLAP_WRAPPER: &str = "src/wrapper/clap/wrapper.rs";
pub(super) const CONTEXT: &str = "src/wrapper/vst3/context.rs";
pub(super) const INNER: &str = "src/wrapper/vst3/inner.rs";
pub(super) const VIEW: &str = "src/wrapper/vst3/view.rs";
pub(super) const WORKER: &str = "src/event_loop/background_thread.rs";
pub(super) const WRAPPER: &str = "src/wrapper/vst3/wrapper.rs";

/// An edit of a text that occurs once.
pub(super) const fn edit(file: &'static str, old: &'static str, new: &'static str) -> Edit {
    Edit { file, old, new, times: 1 }
}
