//! The window without a screen: driven by simulated input, compared with pictures.

mod browsing;
mod fake_host;
mod gestures;
mod mode_edits;
mod pictures;
mod random_events;
mod renderer;
mod sounding;
