//! The modes of a pair.

use super::across;
use super::free::{Free, scaled};
use super::link::Link;
use super::pair::Pair;
use super::tuned;
use crate::error::Result;
use crate::sound::coupled::{self, CoupledMode};
use std::f64::consts::TAU;

impl Pair {
    /// The modes at a note of this frequency in Hz. Not real-time safe.
    ///
    /// # Errors
    /// [`Error::Value`](crate::Error::Value) for a number that is out of range, and if the poles were not found.
    pub(crate) fn modes(&self, frequency: f64) -> Result<Vec<CoupledMode>> {
        self.check()?;
        self.coupled(&self.free(), frequency)
    }

    /// As [`Pair::modes`], from free modes at their own frequencies. If the bodies act on each other, the one that follows
    /// the keys is tuned so that the pair has the pitch of the note.
    pub(super) fn coupled(&self, free: &Free, frequency: f64) -> Result<Vec<CoupledMode>> {
        let [first, second] = free.at(self, frequency);
        let Some(joint) = self.link.joint(1.0) else {
            return match self.link {
                Link::Series => coupled::series(&first, &second, 1.0),
                _ => coupled::apart(&first, &second),
            };
        };
        let factor = |body: &[_], other: &[_]| tuned::factor(body, other, joint, TAU * frequency);
        let mut modes = match (self.first.follows_key, self.second.follows_key) {
            (true, _) => coupled::joined(&scaled(&first, factor(&first, &second)), &second, joint)?,
            (_, true) => coupled::joined(&first, &scaled(&second, factor(&second, &first)), joint)?,
            _ => coupled::joined(&first, &second, joint)?,
        };
        if self.has_polarisation() {
            modes.extend(across::modes(&first, &second, joint, self.polarisation));
        }
        Ok(modes)
    }
}
