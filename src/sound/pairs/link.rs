//! The link between the two bodies of a pair.

use crate::sound::coupled::Joint;
use std::f64::consts::TAU;

/// The link between two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Link {
    /// No link: a strike excites both.
    Apart,
    /// The first drives the second, and gets no force back.
    Series,
    /// A spring and a damper connect their joints.
    Spring {
        /// The frequency in Hz at which the mass of the first body would oscillate on this spring.
        stiffness: f64,
        /// The share of critical damping that this oscillation would have.
        damping: f64,
    },
    /// Their joints move together.
    Rigid,
}

impl Link {
    /// The joint for a first body of this mass in kg, if the bodies act on each other.
    pub(super) fn joint(self, mass: f64) -> Option<Joint> {
        match self {
            Self::Apart | Self::Series => None,
            Self::Rigid => Some(Joint::Rigid),
            Self::Spring { stiffness, damping } => {
                let angular = TAU * stiffness;
                // K = m ω², and critical damping of that mass is R = 2 m ω.
                let damping = 2.0 * damping * mass * angular;
                Some(Joint::Spring { stiffness: mass * angular * angular, damping })
            }
        }
    }
}
