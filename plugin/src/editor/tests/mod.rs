//! The window without a screen: driven by simulated input, compared with pictures.

mod browsing;
mod fake_host;
mod gestures;
mod pictures;
mod renderer;
mod sounding;
