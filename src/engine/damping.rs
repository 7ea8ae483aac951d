//! How long the modes of a note ring: their own decay, and the damper's hold on it.

use libm::pow;

/// T60 below which a mode is a click whatever its pitch.
const SHORTEST_T60: f64 = 0.000_5;

/// How the note is damped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Damping {
    /// T60 of a held note of ratio 1, in seconds.
    pub(crate) decay: f64,
    /// T60 of a damped mode, in seconds; 0 where `amount` is.
    pub(crate) release: f64,
    /// How far it is damped, 0–1.
    pub(crate) amount: f64,
}

impl Damping {
    /// T60 in seconds of a mode whose T60 is `scale` times the decay: between its own and the damper's, by ratio.
    pub(crate) fn t60(self, scale: f64) -> f64 {
        let held = (self.decay * scale).max(SHORTEST_T60);
        let damped = held.min(self.release).max(SHORTEST_T60);
        if self.amount == 0.0 {
            held
        } else if self.amount == 1.0 {
            damped
        } else {
            held * pow(damped / held, self.amount)
        }
    }
}
