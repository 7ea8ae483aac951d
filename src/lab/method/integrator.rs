//! The interface of every method: a step from one state to the next.

use crate::error::Result;
use crate::lab::system::State;

/// Advances a state by one step of fixed length.
pub(crate) trait Integrator {
    /// The state one step after `state`, the state at time `t`. Fails only if an iteration does not converge.
    fn step(&self, state: State, t: f64) -> Result<State>;
}
