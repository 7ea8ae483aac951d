//! Two bodies in one sound.

use super::link::Link;
use crate::sound::bodies::Body;

/// Two bodies in one sound.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The body that is struck. If the two are in series, it drives the other one.
    pub first: Body,
    /// The other body.
    pub second: Body,
    /// The link between them.
    pub link: Link,
    /// Mass of the second body as a multiple of that of the first.
    pub mass: f64,
    /// Share of a strike that falls on the second body, 0–1; the rest falls on the first.
    pub struck: f64,
    /// Share of the second body in the output, 0–1. At one half, both bodies are equally loud on average over the keys.
    pub heard: f64,
    /// A string moves in two directions. This is the share of the direction across the strike in the strike and in the shapes at
    /// the joint, 0–1. So it decays more slowly: the sound decays fast at first and slowly afterwards (Weinreich 1977). At 0,
    /// only one direction counts.
    pub polarisation: f64,
    /// The lowest and the highest MIDI key with a table of its own, if the keys need different tables.
    pub keys: [u8; 2],
}

impl Pair {
    /// A pair with the starting values of its fields. Allocates nothing.
    pub fn new(first: Body, second: Body, link: Link) -> Self {
        let struck = if link == Link::Apart { 0.5 } else { 0.0 };
        Self { first, second, link, mass: 10.0, struck, heard: 0.5, polarisation: 0.0, keys: [21, 108] }
    }

    /// Maximum number of modes of the pair.
    pub(crate) fn count(&self) -> usize {
        self.directions() * self.first.modes + self.second.modes
    }

    /// Whether the first body moves in two directions.
    pub(super) fn has_polarisation(&self) -> bool {
        self.polarisation > 0.0
    }

    /// Number of directions of the first body.
    pub(super) fn directions(&self) -> usize {
        if self.has_polarisation() { 2 } else { 1 }
    }

    /// Whether all keys use the same table of ratios.
    pub(super) fn is_same_for_all_keys(&self) -> bool {
        self.first.follows_key && self.second.follows_key
    }
}
