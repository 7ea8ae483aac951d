//! Presets and kits: a patch with name, author, tags, comment and details, as a file or built in, and presets assigned to keys.

pub(crate) mod about;
pub(crate) mod body;
mod body_table;
pub(crate) mod catalogue;
mod complaints;
mod custom_modes;
mod factory;
mod factory_files;
mod file;
mod guide;
mod kit;
mod kit_file;
mod kit_load;
pub(crate) mod library;
mod load;
mod mode_list;
mod moods;
pub(crate) mod pair;
mod phrase;
mod programs;
mod routes;
mod traits;
mod tuning;
mod value;

use crate::patch::Patch;
use crate::sound::{Kit, Sound};
use std::sync::Arc;

pub(crate) use body::modes_of_body;
pub use guide::{Family, Guide};
pub use kit::{KitPreset, Playable};
pub(crate) use kit_load::is_file_name;
pub(crate) use load::MAX_FILE_SIZE;
pub use phrase::{Phrase, PhraseNote};
pub use programs::Programs;
pub use tuning::OwnTuning;

/// The preset format version that is read and written.
pub(crate) const FORMAT_VERSION: i64 = 1;

/// A patch with name, author, tags, comment and details.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    /// Name by which it is listed and found; never empty.
    pub name: String,
    /// Author.
    pub author: String,
    /// Words to search for.
    pub tags: Vec<String>,
    /// Description for musicians, and how to play it.
    pub comment: String,
    /// How it is made, and where its figures come from.
    pub details: String,
    /// Family, keys, macro names and phrase, which do not change the sound.
    pub guide: Guide,
    /// The sound.
    pub patch: Patch,
    /// Its own tuning; if there is none, the instrument's applies.
    pub tuning: Option<OwnTuning>,
}

impl Preset {
    /// A preset with nothing but a name and a sound. Allocates.
    pub fn new(name: impl Into<String>, patch: Patch) -> Self {
        let [author, comment, details] = [const { String::new() }; 3];
        let (tags, guide) = (Vec::new(), Guide::default());
        Self { name: name.into(), author, tags, comment, details, guide, patch, tuning: None }
    }

    /// The sound of the preset, with its own tuning if it has one. Allocates.
    pub fn sound(&self) -> Arc<Sound> {
        let tuning = self.tuning.as_ref().map(|own| *own.tuning());
        Arc::new(Sound::new(self.patch.clone()).tuned(tuning))
    }

    /// A kit of this sound alone, with the preset's name. Allocates.
    pub fn kit(&self) -> Arc<Kit> {
        Kit::single(self.name.clone(), self.sound())
    }
}
