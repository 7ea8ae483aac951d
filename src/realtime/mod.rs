//! Playing live: sound devices, MIDI ports and a recorder.
//!
//! The audio thread owns the [`Player`], or another [`Source`]. Everything that it receives (live events, kits) and
//! sends (recording, status) goes through queues of fixed size and atomics, so that it never allocates, locks or waits.
//!
//! A stream borrows the player and returns it when the stream ends, for whatever reason. A device that comes back gets
//! the same player, so the song, the sound and the recording continue where they were. `block_clock` says when an event
//! sounds.

pub(crate) mod block_clock;
pub(crate) mod convert;
pub(crate) mod device;
pub(crate) mod fade;
mod jack_midi;
pub(crate) mod live;
mod midi_in;
pub(crate) mod midi_ports;
pub(crate) mod player;
pub(crate) mod recorder;
pub(crate) mod session;
pub(crate) mod status;
pub(crate) mod stream;

pub(crate) use block_clock::BlockClock;
pub use block_clock::{Moment, Stamp};
pub use convert::DeviceSample;
pub use device::{Choice, Found};
pub use live::{LiveEvent, LiveInputs, LiveSender};
pub use midi_in::MidiIn;
pub use player::{KitSender, Player, Setup};
pub use recorder::Tap;
pub use session::Session;
pub use status::Status;
pub use stream::Source;
