//! Keys that the window plays: the piano, the computer's keyboard, all keys as a grid, and what it plays by itself.

pub(super) mod audition;
pub(super) mod computer;
pub(super) mod grid;
pub(super) mod held_key;
pub(super) mod piano;
