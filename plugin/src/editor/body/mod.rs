//! The body from which a sound's modes are made: its page, its numbers, and its moving picture.

pub(super) mod edit;
pub(super) mod face;
pub(super) mod numbers;
pub(super) mod offer;
pub(super) mod origin;
pub(super) mod page;
pub(super) mod small;
pub(super) mod view;
