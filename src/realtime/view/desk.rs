//! The data that the view shows, and the senders through which it plays.

use crate::preset::Playable;
use crate::preset::library::Library;
use crate::realtime::{KitSender, LiveSender, Status};
use crate::sound::Kit;
use std::sync::Arc;

/// Makes the playable kit of a preset or kit from the list.
pub type MakeKit = Box<dyn Fn(&Playable) -> Arc<Kit>>;

/// The data that the view shows, and the senders through which it plays.
pub struct Desk {
    /// The device, as text.
    pub device: String,
    /// State that the audio thread reports.
    pub status: Arc<Status>,
    /// Takes notes and parameters.
    pub keys: LiveSender,
    /// Takes kits.
    pub kits: KitSender,
    /// The initial kit of the channels that are not in `channels`.
    pub kit: Arc<Kit>,
    /// Initial kits of single channels, 0–15.
    pub channels: Vec<(u8, Arc<Kit>)>,
    /// The kits that program changes select.
    pub programs: Vec<Arc<Kit>>,
    /// Makes the playable kit of an entry of the list.
    pub make: MakeKit,
    /// The user's own sounds; none if the system names no folder for user data.
    pub library: Option<Library>,
}
