//! Presets: a patch with its name, author, tags and comment, as a TOML file or built in.

mod factory;
mod file;
mod load;
mod migration;
mod routes;
mod value;

use crate::patch::Patch;

pub use load::MAX_FILE_SIZE;
pub use migration::Replaced;

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
}
