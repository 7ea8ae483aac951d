//! The amplitudes that forces of 1 give.

/// The sums of all modes' amplitudes that mallet, pluck and noise of force 1 give, and the greatest amplitude that a nudge of
/// force 1 gives: left, right, and as displacement.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Reach {
    pub(crate) struck: [f64; 3],
    pub(crate) plucked: [f64; 3],
    pub(crate) noise: [f64; 3],
    pub(crate) nudged: [f64; 3],
}

impl Reach {
    /// Adds another reach, multiplied by a level.
    pub(crate) fn plus(self, other: Self, level: f64) -> Self {
        let sum = |a: [f64; 3], b: [f64; 3]| add(a, b.map(|b| level * b));
        Self {
            struck: sum(self.struck, other.struck),
            plucked: sum(self.plucked, other.plucked),
            noise: sum(self.noise, other.noise),
            nudged: further(self.nudged, other.nudged.map(|nudged| level * nudged)),
        }
    }

    /// The larger value for each force and side.
    pub(crate) fn max(self, other: Self) -> Self {
        Self {
            struck: further(self.struck, other.struck),
            plucked: further(self.plucked, other.plucked),
            noise: further(self.noise, other.noise),
            nudged: further(self.nudged, other.nudged),
        }
    }
}

fn further(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i].max(b[i]))
}

pub(crate) fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + b[i])
}
