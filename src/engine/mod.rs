//! From events to samples: voices, their manager, the synth, and the ensemble of sixteen channels.
//!
//! Does not depend on files, the command line or audio devices. Real-time safe once built, except where noted.

mod atomic;
pub mod banks;
mod channel;
mod controls;
mod damping;
pub mod ensemble;
pub mod event;
mod expression;
mod gain;
mod instrument;
pub mod midi;
mod modulation;
pub mod note;
pub(crate) mod pressed;
pub mod scope;
pub mod snapshot;
mod space;
pub mod synth;
pub mod telemetry;
mod voice;
pub mod voice_manager;
pub mod voice_state;
mod zones;

pub use ensemble::Ensemble;
pub use event::{Event, EventKind, Expression};
#[cfg(feature = "fit")]
pub(crate) use modulation::Lfo;
pub use note::{Note, NoteId, Notes};
pub use snapshot::{SHOWN_NOTES, Snapshot, SoundingNote};
pub use synth::Synth;
pub use telemetry::{Telemetry, TelemetryWriter};
pub use voice_state::{ModeState, StrikeState, VoiceState};
