//! Requests to render, with the option names that the command, batches and Python share.

mod names;
mod playable;
mod programs;
pub mod quantity;
mod recording;
mod render;
mod song;
mod sounds;
mod tuning;

pub use names::{Name, Number};
pub use playable::playable;
pub use recording::recording;
pub use render::{Prepared, Request};
pub use song::SongRequest;
pub use sounds::{SoundRequest, Sounds};
pub use tuning::TuningRequest;
