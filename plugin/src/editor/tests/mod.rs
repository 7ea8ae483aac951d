//! The window without a screen: driven by simulated input, compared with pictures.

mod animation;
mod auditioning;
mod body_numbers;
mod browsing;
mod comparing;
mod devices;
mod dropped;
mod empty;
mod fake_host;
mod fitted;
mod gestures;
mod kits;
mod learning;
mod loading;
mod mode_edits;
mod motion;
mod moving;
mod paging;
mod picking;
mod pictures;
mod playing;
mod random_events;
mod reaching;
mod renderer;
mod rings;
mod sounding;
