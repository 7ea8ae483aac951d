//! Sprung as a CLAP and VST3 instrument: a thin shell around [`sprung::engine::Synth`]. It has no DSP of its own.
//!
//! | module | holds |
//! |---|---|
//! | `plugin` | what hosts are told, and their calls |
//! | `params` | the host's parameters, made from [`sprung::params::PARAMS`] |
//! | `slate` | the exact patch, shared between threads without locks |
//! | `live` | the audio thread: follows parameters, hands over events, renders |
//! | `events` | the wrapper's note events as the engine's |
//! | `tail` | how long the sound goes on |
//! | `state` | what a host's project keeps |
//! | `editor` | the window |
//! | `export` | the entry points of the library |
//!
//! The wrapper is nice-plug; what it calls a normalised value is called a position here: how far a knob is turned.

mod editor;
mod events;
mod export;
mod live;
mod params;
mod plugin;
mod slate;
mod state;
mod tail;

pub use plugin::Sprung;
