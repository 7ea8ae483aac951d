//! Presets: a patch with its name, author, tags and comment, as a TOML file or built in.

mod body;
mod factory;
mod file;
mod load;
mod routes;
mod value;

use crate::patch::Patch;

pub use body::{body_of_modes, modes_of_body};
pub use load::MAX_FILE_SIZE;

/// The preset format that this version writes. It reads those before as well: 1 had no routes.
pub const FORMAT_VERSION: i64 = 2;

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
}
