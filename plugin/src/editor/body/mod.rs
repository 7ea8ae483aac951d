//! The body from which a sound's modes are made: its page, its numbers, and its moving picture.

mod edit;
mod face;
pub(super) mod form;
mod numbers;
pub(super) mod origin;
pub(super) mod page;
mod shape;
pub(super) mod view;
