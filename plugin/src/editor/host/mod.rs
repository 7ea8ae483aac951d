//! The window at its host: its size in the host's pixels, the keyboard focus, and screen readers.

#[cfg(target_os = "linux")]
pub(super) mod accessibility;
pub(crate) mod extent;
pub(super) mod focus;
pub(super) mod keep;
#[cfg(target_os = "linux")]
mod x11;
