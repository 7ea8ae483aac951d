//! What the window plays: the piano and its wheels, the computer's keyboard, all keys as a grid, and single notes.

pub(super) mod audition;
pub(super) mod computer;
pub(super) mod grid;
pub(super) mod held_key;
pub(super) mod piano;
pub(super) mod wheels;
