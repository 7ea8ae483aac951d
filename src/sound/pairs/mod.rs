//! Two bodies that make one sound: their link, the strike, and the pickup.
//!
//! A [`Pair`] is two [bodies](super::bodies::Body) and their [`Link`]. Its modes are those of the module `coupled`, exactly: poles and residues
//! of the whole. Each body follows the keys or keeps its own frequency ([`follows_key`](super::bodies::Body::follows_key)): the bar and the tube of a
//! marimba both follow; a string follows and its soundboard does not. If one of them does not, every key needs its own
//! table ([`Pair::table`]).
//!
//! The output of a body is its displacement, with each mode multiplied by its frequency, as for a single body: so a pair
//! whose bodies do not act on each other has the levels of both. A residue has an amplitude and a phase; a strike starts
//! the mode with both.
//!
//! | file | holds |
//! |---|---|
//! | `pair`, `link`, `fields` | the pair, the link between its bodies, and its numbers with their ranges |
//! | `free` | the modes of both bodies before they are joined, at the pitch of a key |
//! | `tuned`, `response` | the tuning of the body that follows the keys; the effective stiffness of a joint for one mode |
//! | `across` | a string's second direction |
//! | `modes`, `table` | the modes of the pair, and the patch's table of them, or one table for each key |
//!
//! Each mode has a level and a phase `φ`, and starts as `sin(ωt + φ)`: in the bank, a force `F` with the gain `g` adds
//! `F g sin φ` to `x` and `F g cos φ` to `y`. So every force is convolved with the response of the pair, noise too
//! (`every_force_is_convolved_with_a_turned_response`). A form of the kernel (`TURNED` in `mode_bank::step`) lets noise
//! act on both coordinates; sounds without phases are computed as before. Limits: levels with phases belong to one
//! place, so a plucked pair is plucked where its body is struck, and `pluck_position` does nothing; `vary_position` and
//! a bow treat the modes as a string's; the original formulas do not turn noise.
//!
//! A body that follows the keys is tuned so that the mode that sets its pitch is exactly right once it is joined
//! (`tuned`). If the other body has a mode at nearly the same pitch, the two push each other away and there may be no
//! such tuning; then the body is tuned as if the other one did not move.
//!
//! `tests/engine/pair_reference.rs` renders a string on a plate, joined, in series and apart, for three keys, and compares
//! pitch, T60, level and samples with an eigenproblem solved by SciPy.

mod across;
pub(crate) mod fields;
mod free;
mod link;
mod modes;
mod pair;
mod response;
mod table;
#[cfg(test)]
mod tests;
mod tuned;

pub(crate) use fields::{LINK_FIELDS, LinkField};
pub use link::Link;
pub use pair::Pair;
