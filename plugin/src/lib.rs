//! Sprung as a CLAP and VST3 instrument: a thin shell around [`sprung::engine::Synth`]. It has no DSP of its own.
//!
//! | module | holds |
//! |---|---|
//! | `plugin` | what hosts are told, and their calls |
//! | `params` | the host's parameters, made from [`sprung::params::PARAMS`] |
//! | `loaded` | the exact sound, and how the audio thread takes it without waiting |
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
mod loaded;
mod params;
mod plugin;
mod state;
mod tail;

pub use plugin::Sprung;
