//! What every method is: a step from one state to the next.

use crate::error::Result;
use crate::lab::system::State;

/// Advances a state by one step of fixed length.
pub trait Integrator {
    /// The state one step after `state`, which is that at time `t`. Fails only where an iteration does not converge.
    fn step(&self, state: State, t: f64) -> Result<State>;
}
