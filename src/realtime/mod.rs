//! Playing live: sound devices, MIDI ports and a recorder.
//!
//! The audio thread owns the [`Player`], or another [`Source`]. Everything that it receives (live events, kits) and
//! sends (recording, status) goes through queues of fixed size and atomics, so that it never allocates, locks or waits.
//!
//! A stream borrows the player and returns it when the stream ends, for whatever reason. A device that comes back gets
//! the same player, so the song, the sound and the recording continue where they were. `block_clock` says when an event
//! sounds.

pub mod block_clock;
pub mod convert;
pub mod device;
mod fade;
mod jack_midi;
pub mod live;
mod midi_in;
pub mod midi_ports;
pub mod player;
pub mod recorder;
pub mod session;
pub mod status;
pub mod stream;

pub use block_clock::{BlockClock, Moment, Stamp};
pub use device::{Choice, Found};
pub use fade::Fade;
pub use jack_midi::JackMidi;
pub use live::{LiveEvent, LiveInputs, LiveSender};
pub use midi_in::MidiIn;
pub use midi_ports::{MidiPorts, Wanted};
pub use player::{KitSender, Player, Setup};
pub use recorder::{Recorded, Recording, Tap};
pub use session::Session;
pub use status::Status;
pub use stream::Source;
