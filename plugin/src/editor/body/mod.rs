//! The body from which a sound's modes are made: its page, its numbers, and its moving picture.

pub(super) mod edit;
pub(super) mod face;
mod handle;
pub(super) mod numbers;
pub(super) mod offer;
pub(super) mod origin;
pub(super) mod page;
pub(super) mod pick;
mod pointing;
pub(super) mod small;
mod tool;
pub(super) mod view;
