//! T60 of a note's modes: their own decay, the effect of the damper, and that of a finger that touches the body.

use libm::pow;

/// Lower limit of T60 in seconds: below it, a mode is a click at any pitch.
const SHORTEST_T60: f64 = 0.000_5;

/// How the note is damped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Damping {
    /// T60 of a held note of ratio 1, in seconds.
    pub(crate) decay: f64,
    /// T60 of a fully damped mode, in seconds. Not used if `amount` is 0.
    pub(crate) release: f64,
    /// Degree of damping, 0–1.
    pub(crate) amount: f64,
    /// The reciprocal of the T60 in seconds that a touch gives a mode that moves most where the body is touched, if it had
    /// no other damping; 0 if nothing touches it.
    pub(crate) touch: f64,
}

impl Damping {
    /// T60 in seconds of a mode whose own T60 is `scale` times the decay: interpolated geometrically towards the
    /// damper's. A touch adds to its rate of decay, in proportion to `touched`, which says how far the mode moves there: the
    /// square of its shape, 0–1.
    pub(crate) fn t60(self, scale: f64, touched: f64) -> f64 {
        let untouched = self.untouched(scale);
        let share = untouched * self.touch * touched;
        if share == 0.0 { untouched } else { (untouched / (1.0 + share)).max(SHORTEST_T60) }
    }

    fn untouched(self, scale: f64) -> f64 {
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
