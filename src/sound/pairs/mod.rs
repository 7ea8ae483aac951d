//! Two bodies that make one sound: their link, the strike, and the pickup.
//!
//! A [`Pair`] is two [bodies](super::bodies::Body) and their [`Link`]. Its modes are those of [`super::coupled`], exactly: poles and residues
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

mod across;
mod fields;
mod free;
mod link;
mod modes;
mod pair;
mod response;
mod table;
#[cfg(test)]
mod tests;
mod tuned;

pub use fields::{LINK_FIELDS, LinkField};
pub use link::Link;
pub use pair::Pair;
