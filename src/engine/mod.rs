//! From events to samples: voices, their manager, the synth, and the ensemble of sixteen channels.
//!
//! Does not depend on files, the command line or audio devices. Real-time safe once built, except where noted.
//!
//! | where | what |
//! |---|---|
//! | `event`, `midi`, `channel`, `banks`, `zones` | events; MIDI messages as events; controllers; program changes; MPE |
//! | `pressed` | the keys and pedals that a stream of events holds down |
//! | `note`, `expression` | a note, its note expressions, how events select notes |
//! | `knobs`, `controls`, `instrument` | the state of each knob; what voices follow; one sound of a kit |
//! | `modulation/` | routes and their sources, and the host's offsets |
//! | `voice/`, `damping` | one voice: strikes, pitch, decay, gain, tension, bloom, energy; its strikes apart, for labels |
//! | `voice_manager/` | which notes sound, and in which voices: note on and off, mono, pedals, slots, the pool |
//! | `space/` | the effects after the voices: `dsp::space` with parameters, sleep and tails |
//! | `synth/` | a kit on sixteen channels |
//! | `ensemble/` | a synth for each channel, rendered in chunks and mixed |
//! | `blend` | the balance of an effect between what comes in and what the synth makes of it |
//! | `snapshot`, `telemetry`, `scope`, `atomic` | what displays read while the engine plays |
//! | `curves` | what parts of a sound do, for displays |
//! | `voice_state` | a voice and its modes as they are, for labels |
//! | `workers` | who does the work of a block: its caller, or several threads |

mod atomic;
pub(crate) mod banks;
pub(crate) mod blend;
mod channel;
mod controls;
pub(crate) mod curves;
mod damping;
pub(crate) mod ensemble;
pub(crate) mod event;
mod expression;
mod gain;
mod instrument;
mod knobs;
pub mod midi;
mod modulation;
pub(crate) mod note;
mod portamento;
pub(crate) mod pressed;
pub(crate) mod scope;
pub(crate) mod snapshot;
mod space;
pub(crate) mod synth;
pub(crate) mod telemetry;
mod voice;
pub(crate) mod voice_manager;
pub(crate) mod voice_state;
mod workers;
mod zones;

pub use ensemble::Ensemble;
pub(crate) use ensemble::Stems;
pub use event::{Event, EventKind, Expression};
#[cfg(feature = "fit")]
pub(crate) use modulation::Lfo;
pub(crate) use note::Note;
pub use note::{EndedNote, NoteId, Notes};
pub use snapshot::{Mass, Snapshot, SoundingNote};
pub(crate) use synth::PadGroup;
pub use synth::{Outputs, SAMPLE_RATES, Synth};
pub(crate) use telemetry::{Telemetry, TelemetryWriter};
pub(crate) use voice_state::{ModeState, VoiceState};
pub use workers::Workers;
pub(crate) use zones::Owners;
