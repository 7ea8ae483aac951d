//! What the view shows and what it plays on.

use crate::patch::Patch;
use crate::realtime::{LiveSender, PatchSender, Status};
use std::sync::Arc;

/// What the view shows and what it plays on.
pub struct Desk {
    /// The device, as text.
    pub device: String,
    /// What the audio thread tells.
    pub status: Arc<Status>,
    /// Takes notes and parameters.
    pub keys: LiveSender,
    /// Takes presets.
    pub patches: PatchSender,
    /// Name of the sound that every channel starts with.
    pub name: String,
    /// That sound.
    pub patch: Patch,
    /// The sounds that program changes choose from, in the order of the factory presets.
    pub programs: Vec<Patch>,
}
