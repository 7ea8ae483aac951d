//! Two bodies in one sound.

use super::link::Link;
use crate::sound::bodies::Body;

/// Two bodies in one sound.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The body that is struck, and drives the other one if they are in series.
    pub first: Body,
    /// The other body.
    pub second: Body,
    /// How they act on each other.
    pub link: Link,
    /// Mass of the second body as a multiple of that of the first.
    pub mass: f64,
    /// Share of a strike that falls on the second body, 0–1; the rest falls on the first.
    pub struck: f64,
    /// Share of the second body in what is heard, 0–1. At one half, both bodies are as loud on average over the keys.
    pub heard: f64,
    /// A string moves in two directions. The one across the strike gets this share of the strike, and of the shapes at the
    /// joint, 0–1. So it decays more slowly: a sound that decays fast at first and slowly afterwards (Weinreich 1977). At 0,
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

    /// Number of modes of the pair at most.
    pub fn count(&self) -> usize {
        self.directions() * self.first.modes + self.second.modes
    }

    /// Whether the first body moves in two directions.
    pub(super) fn has_polarisation(&self) -> bool {
        self.polarisation > 0.0
    }

    /// How many directions of the first body count.
    pub(super) fn directions(&self) -> usize {
        if self.has_polarisation() { 2 } else { 1 }
    }

    /// Whether one table of ratios is for all keys.
    pub(super) fn is_same_for_all_keys(&self) -> bool {
        self.first.follows_key && self.second.follows_key
    }
}
