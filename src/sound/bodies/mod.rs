//! Bodies as physics describes them: strings, bars, drum heads, plates, bells, tubes, glasses, and dense beds of modes.
//!
//! A [`Body`] is a [`Model`] with its size or pitch, its material, the points of strike and pickup, and its
//! irregularities. [`Body::modes`] computes its modes: frequencies, T60s, and the mode shapes at those points, whose
//! product is the level. This runs off the audio thread. It uses exactly rounded operations and `libm` in an order that must
//! not change, so the same body has the same bits everywhere. Each model's file names the source of its law.
//!
//! | file | holds |
//! |---|---|
//! | `body`, `fields`, `modes`, `table` | the body, its numbers with their ranges, its modes, and a patch's table of them |
//! | `model`, `size`, `material` | the models by name, their dimensions and their materials |
//! | `mass`, `string`, `bar`, `membrane`, `timpani`, `plate`, `disc`, `bell`, `tube`, `glass`, `bowl`, `bed` | one model each |
//! | `partial`, `roots`, `bessel` | code that models share |
//!
//! - **Level** is the mode shape at the strike position times the mode shape at the listening position. Shapes have
//!   mean square 1 over the body, so every mode has the mass of the whole body. A third position, the joint, has the
//!   same scale.
//! - **T60** is `ln 1000 / (damping · (b0 + b1 f^p + radiation))` at the mode's own frequency.
//! - **Pairs** are two shapes that are rotated against each other by the axis of an imperfection. Without a split, the
//!   axis is at the strike position, and the other mode of the pair is not made.
//! - **Count**: the lowest modes, however weak, so that moving a position changes levels and nothing else.
//!
//! In a preset, `[body]` replaces `modes`; the mode table keeps this text as its origin, so that a preset is saved with
//! its body. Zeros and roots are found by bracketing, which cannot fail. `tests/engine/body_reference.rs` compares with SciPy,
//! which finds each by another method: ratios within 1e−9 (the kettledrum 1e−6, the free plate 1e−3), levels within 0.1
//! dB. `tests` here tries random bodies over all ranges, and pins their bits.

mod bar;
mod bed;
mod bell;
mod bessel;
mod body;
mod bowl;
mod disc;
pub(crate) mod fields;
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
pub(crate) use body::DEFAULT_FREQUENCY;
pub(crate) use body::RATIO_RANGE;
pub use body::{Body, Pitch};
pub(crate) use fields::FIELDS;
pub(crate) use material::LN_1000;
pub use material::{Loss, MATERIALS, Material};
pub use model::{CustomMode, Model};
pub use modes::BodyMode;
pub use partial::Point;
pub use plate::Edge;
pub use size::Size;
pub use timpani::Drum;
