//! Converts a body into the mode table of a patch.

use super::body::Body;
use super::modes::{BodyMode, pitch_mode};
use crate::patch::{MAX_MODES, Mode, ModeTable};

/// Modes with less than this share of the sum of all levels (−120 dB) are left out, because they are inaudible.
const INAUDIBLE: f64 = 1e-6;

impl Body {
    /// The mode table of a patch: ratios to the played note, levels whose absolute values add up to 1, and decays as
    /// multiples of the T60 of the mode that sets the pitch ([`Body::t60`]). Set the patch's `decay` to that T60.
    /// Allocates.
    ///
    /// The table contains only ratios. For a body that does not follow the keys ([`Body::follows_key`]), the caller
    /// must make every key sound at the body's own `Body::frequency`, so that the ratios give the body's frequencies.
    pub fn table(&self) -> ModeTable {
        let modes = self.most(MAX_MODES).modes();
        let t60 = pitch_mode(&modes).map_or(1.0, |mode| mode.t60);
        let sum: f64 = modes.iter().map(|mode| mode.level.abs()).sum();
        let fields = Mode::FIELDS;
        let within = |field: usize, value: f64| (value as f32).clamp(fields[field].1, fields[field].2);
        let mode = |mode: &BodyMode| Mode {
            ratio: within(0, mode.ratio),
            level: within(1, mode.level / sum),
            decay: within(2, mode.t60 / t60),
            strike: within(3, self.strike_share),
            pan: within(4, mode.pan),
        };
        // A body that is struck or heard at a node of all its modes is silent.
        let audible = |mode: &&BodyMode| sum > 0.0 && mode.level.abs() >= INAUDIBLE * sum;
        let table: Vec<Mode> = modes.iter().filter(audible).map(mode).collect();
        if table.is_empty() { ModeTable::new(&[Mode { level: 0.0, ..Mode::UNIT }]) } else { ModeTable::new(&table) }
    }

    /// The T60 in seconds of the mode that sets the pitch. Allocates.
    pub fn t60(&self) -> f64 {
        pitch_mode(&self.most(MAX_MODES).modes()).map_or(1.0, |mode| mode.t60)
    }

    /// The body with at most this many modes.
    fn most(&self, modes: usize) -> Body {
        Body { modes: self.modes.min(modes), ..self.clone() }
    }
}
