//! The data that the view shows, and the senders through which it plays.

use sprung::internals::library::Library;
use sprung::preset::Playable;
use sprung::realtime::{KitSender, LiveSender, Status};
use sprung::sound::Kit;
use std::sync::Arc;

/// Makes the playable kit of a preset or kit from the list.
pub(crate) type MakeKit = Box<dyn Fn(&Playable) -> Arc<Kit>>;

/// The data that the view shows, and the senders through which it plays.
pub(crate) struct Desk {
    /// The device, as text.
    pub(crate) device: String,
    /// State that the audio thread reports.
    pub(crate) status: Arc<Status>,
    /// Takes notes and parameters.
    pub(crate) keys: LiveSender,
    /// Takes kits.
    pub(crate) kits: KitSender,
    /// The initial kit of the channels that are not in `channels`.
    pub(crate) kit: Arc<Kit>,
    /// Initial kits of single channels, 0–15.
    pub(crate) channels: Vec<(u8, Arc<Kit>)>,
    /// The kits that program changes select.
    pub(crate) programs: Vec<Arc<Kit>>,
    /// Makes the playable kit of an entry of the list.
    pub(crate) make: MakeKit,
    /// The user's own sounds; none if the system names no folder for user data.
    pub(crate) library: Option<Library>,
}
