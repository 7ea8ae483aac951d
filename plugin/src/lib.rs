//! Sprung as a CLAP and VST3 instrument: a thin shell around [`sprung::engine::Synth`], without DSP of its own.
//!
//! | module | holds |
//! |---|---|
//! | `plugin` | the description that hosts read, and the calls that they make |
//! | `multi` | the same with outputs for pads and channels |
//! | `resonator`, `chord` | the same as an effect: Sprung Resonator; what it holds while nobody plays |
//! | `params` | the host's parameters, made from [`sprung::params::PARAMS`] |
//! | `loaded` | the loaded sound with exact values, and how the audio thread gets it without waiting |
//! | `live` | the audio thread: follows parameters, passes events on, renders |
//! | `link` | messages between the window and the audio thread |
//! | `lock` | locks whose holder may have panicked |
//! | `layer` | extensions of CLAP that the wrapper lacks, between it and the host |
//! | `callback`, `marks` | what `layer` tells the host on its main thread; what the host says of parameters |
//! | `files` | preset and kit files that users name |
//! | `devices` | the standalone program's devices and ports, as its window chooses them |
//! | `events` | converts the wrapper's note events to the engine's |
//! | `tail` | how long the sound continues |
//! | `state` | the state that a host stores in its project |
//! | `editor` | the window |
//! | `export` | the entry points of the library |
//! | `standalone` | the window as a program, with a sound device of its own (feature `standalone`) |
//!
//! The wrapper is nice-plug. Its normalised values are called positions here: knob positions from 0 to 1.

mod callback;
mod chord;
mod devices;
mod editor;
mod events;
mod export;
mod files;
mod layer;
mod link;
mod live;
mod loaded;
mod lock;
mod marks;
mod mts_esp;
mod multi;
mod params;
mod plugin;
mod resonator;
#[cfg(feature = "standalone")]
pub mod standalone;
mod state;
mod tail;

pub use multi::SprungMulti;
pub use plugin::Sprung;
pub use resonator::Resonator;
