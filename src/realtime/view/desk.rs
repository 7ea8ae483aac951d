//! What the view shows and what it plays on.

use crate::realtime::{KitSender, LiveSender, Status};
use crate::sound::Kit;
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
    pub kits: KitSender,
    /// What every channel starts with that is not among `channels`.
    pub kit: Arc<Kit>,
    /// What single channels, 0–15, start with.
    pub channels: Vec<(u8, Arc<Kit>)>,
    /// What program changes choose from, in the order of the factory presets.
    pub programs: Vec<Arc<Kit>>,
}
