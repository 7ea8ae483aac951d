//! What a correction is: a piece of text in place of another.

/// A piece of text in place of another.
pub(super) struct Edit {
    /// The file in the package.
    pub(super) file: &'static str,
    /// What is there.
    pub(super) old: &'static str,
    /// What comes in its place.
    pub(super) new: &'static str,
    /// How often it is there. Any other number means that the source is not what the edit was written for.
    pub(super) times: usize,
}

pub(super) const CONTEXT: &str = "src/wrapper/vst3/context.rs";
pub(super) const INNER: &str = "src/wrapper/vst3/inner.rs";
pub(super) const VIEW: &str = "src/wrapper/vst3/view.rs";
pub(super) const WORKER: &str = "src/event_loop/background_thread.rs";
pub(super) const WRAPPER: &str = "src/wrapper/vst3/wrapper.rs";

/// An edit of something that is there once.
pub(super) const fn edit(file: &'static str, old: &'static str, new: &'static str) -> Edit {
    Edit { file, old, new, times: 1 }
}
