//! Sampler instruments of presets and kits: samples of keys, velocities and alternating strikes, with SFZ and DecentSampler files.
//!
//! Samples are as loud as the sound is, so the files switch the sampler's own response to velocity off. A loop is set only where the
//! held sound is steady and comes back to itself; anything else is as long as asked for, and fades out there if it still sounds.
//!
//! Finished samples have a line in a list, so that an interrupted run can be resumed; each is the same bytes whenever it is made.

mod instrument;
mod list;
mod plan;
mod release;
mod run;
mod settings;
mod steady;
mod strike;
mod take;

pub use run::Sampled;
pub use settings::Sampling;
