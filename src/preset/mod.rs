//! Presets: a patch with its name, author, tags and comment, as a TOML file or built in; and kits, which put them on keys.

mod about;
mod body;
mod complaints;
mod factory;
mod file;
mod kit;
mod kit_file;
mod kit_load;
mod load;
mod migration;
mod routes;
mod tuning;
mod value;

use crate::patch::Patch;
use crate::sound::kit::{KEYS, Pad};
use crate::sound::{Kit, Sound};
use std::sync::Arc;

pub use body::{body_of_modes, modes_of_body};
pub use kit::{KIT_VERSION, KitPreset, Playable};
pub use kit_load::is_file_name;
pub use load::MAX_FILE_SIZE;
pub use migration::Replaced;
pub use tuning::OwnTuning;

/// The preset format that this version writes. It reads those before as well: 1 had no routes, and both had parameters
/// that are retired ([`crate::params::retired`]).
pub const FORMAT_VERSION: i64 = 3;

/// A patch and what a person calls it.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    /// What it is called and found by; never empty.
    pub name: String,
    /// Who made it.
    pub author: String,
    /// Words to search by.
    pub tags: Vec<String>,
    /// What it is and how to play it.
    pub comment: String,
    /// The sound.
    pub patch: Patch,
    /// How it tunes the keys; none for the way of the whole instrument.
    pub tuning: Option<OwnTuning>,
}

impl Preset {
    /// The sound to play, in its own tuning. Allocates.
    pub fn sound(&self) -> Arc<Sound> {
        let tuning = self.tuning.as_ref().map(|own| *own.tuning());
        Arc::new(Sound::new(self.patch.clone()).tuned(tuning))
    }

    /// The kit of this sound alone, under the preset's name. Allocates.
    pub fn kit(&self) -> Arc<Kit> {
        Arc::new(Kit::new(self.name.clone(), vec![self.sound()], vec![Some(Pad::of(0)); KEYS]))
    }
}
