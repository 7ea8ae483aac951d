//! Bodies as physics describes them: what strings, bars, heads, plates, bells, tubes, glasses and denser things ring with.
//!
//! A [`Body`] is a [`Model`] with its size or pitch, its material, the places where it is struck and heard, and what makes it
//! irregular; [`Body::modes`] says which modes that gives: frequencies, T60s, and mode shapes at those places, whose product
//! is the level. All of it is made off the audio thread, from exactly rounded operations and `libm` in a frozen order: the
//! same body has the same bits everywhere. Each model's file names where its law is from.
//!
//! | file | holds |
//! |---|---|
//! | `body`, `fields`, `modes`, `table` | the body, its numbers with their ranges, its modes, and a patch's table of them |
//! | `model`, `size`, `material` | the models by name, what they measure and what they are made of |
//! | `mass`, `string`, `bar`, `membrane`, `timpani`, `plate`, `disc`, `bell`, `tube`, `glass`, `bowl`, `bed` | a model each |
//! | `partial`, `roots`, `bessel` | what they share |

mod bar;
mod bed;
mod bell;
mod bessel;
mod body;
mod bowl;
mod disc;
mod fields;
mod glass;
mod mass;
mod material;
mod membrane;
mod model;
mod modes;
mod partial;
mod plate;
mod roots;
mod size;
mod string;
mod table;
#[cfg(test)]
mod tests;
mod timpani;
mod tube;

pub use bed::{Bed, BedKind};
pub use body::{Body, DEFAULT_FREQUENCY, Pitch, RATIO_RANGE, T60_RANGE};
pub use fields::{FIELDS, Field, MAX_MODES};
pub use mass::ringing;
pub use material::{LN_1000, Loss, MATERIALS, Material};
pub use model::{CustomMode, Model};
pub use modes::BodyMode;
pub use partial::Point;
pub use plate::Edge;
pub use size::Size;
pub use timpani::Drum;
