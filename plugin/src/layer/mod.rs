//! A layer between CLAP hosts and the wrapper, with the extensions that the wrapper lacks.
//!
//! | file | what hosts get |
//! |---|---|
//! | `entry` | the library's entry and its plugins, each with the layer around it |
//! | `note_names` | the names of a kit's pads |
//! | `discovery`, `preset_load` | the sounds of the factory and the user's, to be listed and loaded |
//! | `state_context` | states for presets, which leave the window as it is |
//! | `input`, `modulation` | controllers that turn knobs; modulation of the notes of a key or a channel |
//! | `indication` | marks at knobs: what a controller is mapped to, and what is automated |
//!
//! A plugin that a host gets is a copy of the wrapper's (`instance`): all functions and the data are the wrapper's, but
//! for those that the layer has to see first. The wrapper's functions read nothing of a plugin but `plugin_data`, so they
//! work with the copy as with their own, and so do the wrapper's extensions. `published` says how the layer comes to the
//! parameters behind that data, which the wrapper keeps to itself.
//!
//! This folder has the plugin's unsafe code for CLAP. What hosts pass is taken as CLAP defines it; null pointers, unknown
//! ids and texts that are not UTF-8 are refused. Only `input`, and what it calls, runs on the audio
//! thread.

#![allow(unsafe_code, reason = "CLAP is an interface of C")]

mod c;
mod discovery;
pub(crate) mod entry;
mod extensions;
mod host;
mod indication;
mod input;
mod instance;
mod modulation;
mod note_names;
mod place;
mod preset_load;
pub(crate) mod published;
mod state_context;
#[cfg(test)]
mod tests;
