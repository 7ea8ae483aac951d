//! The modes of both bodies before they are joined, at the pitch of a key.

use super::pair::Pair;
use crate::sound::bodies::{self, LN_1000};
use crate::sound::coupled::BodyMode;
use std::f64::consts::TAU;

/// The modes of both bodies, each at the body's own frequency.
pub(super) struct Free {
    first: Vec<BodyMode>,
    second: Vec<BodyMode>,
}

impl Pair {
    /// The modes of both bodies, each at the body's own frequency. Allocates.
    pub(super) fn free(&self) -> Free {
        let modes = |body: &bodies::Body, mass| body.modes().iter().map(|mode| of_body(mode, mass)).collect::<Vec<_>>();
        Free { first: modes(&self.first, 1.0), second: modes(&self.second, self.mass) }
    }
}

impl Free {
    /// Number of modes of the first and of the second body.
    pub(super) fn len(&self) -> [usize; 2] {
        [self.first.len(), self.second.len()]
    }

    /// The modes of the first and the second body for a note of this frequency in Hz.
    pub(super) fn at(&self, pair: &Pair, frequency: f64) -> [Vec<BodyMode>; 2] {
        let ratio = |body: &bodies::Body| if body.follows_key { frequency / body.frequency() } else { 1.0 };
        [scaled(&self.first, ratio(&pair.first)), scaled(&self.second, ratio(&pair.second))]
    }
}

/// A mode of a body of this mass. Shapes of bodies are scaled so that every mode has the body's mass.
fn of_body(mode: &bodies::BodyMode, mass: f64) -> BodyMode {
    let mode = BodyMode {
        angular_frequency: TAU * mode.frequency,
        decay_rate: LN_1000 / mode.t60,
        joint: mode.joint,
        strike: mode.strike,
        pickup: mode.pickup * mode.gain,
    };
    mode.with_mass(mass)
}

/// The modes with all frequencies multiplied by a ratio.
pub(super) fn scaled(modes: &[BodyMode], ratio: f64) -> Vec<BodyMode> {
    modes.iter().map(|mode| BodyMode { angular_frequency: mode.angular_frequency * ratio, ..*mode }).collect()
}
