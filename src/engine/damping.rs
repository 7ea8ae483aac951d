//! T60 of a note's modes: from their own decay, the damper, and a touch of the body.

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
    /// Reciprocal of a T60 in seconds: the T60 that a touch alone gives to a mode whose motion is largest at the point of
    /// touch. 0 if nothing touches the body.
    pub(crate) touch: f64,
}

impl Damping {
    /// T60 in seconds of a mode whose own T60 is `scale` times the decay: interpolated geometrically towards the damper's.
    /// A touch adds a rate of decay in proportion to `touched`, the square of the mode shape at the point of touch, 0–1.
    /// So a touch only ever shortens, and a touch in the middle of a string leaves the even partials. It does not depend on the
    /// damper.
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
