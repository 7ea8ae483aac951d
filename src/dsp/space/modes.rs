//! The modes of a resonant body for a reverb, each with its frequency, its drive and its gains to the pick-ups.

use super::decay::way;

/// Maximum number of modes of a body. If a body has more, its lowest are kept.
pub const MAX_MODES: usize = 16_384;

/// One mode of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMode {
    /// Frequency in Hz.
    pub frequency: f64,
    /// Mode shape at the point of the drive: the amplitude that a sample of 1 gives the mode.
    pub drive: f64,
    /// Mode shape at the left pick-up.
    pub left: f64,
    /// Mode shape at the right pick-up.
    pub right: f64,
}

/// The modes of a body, by ascending frequency. Making one allocates: not for the audio thread.
///
/// Absolute levels do not matter: a [`super::Resonator`] plays every body equally loud.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeSet {
    modes: Vec<BodyMode>,
    /// Position of each mode between low and high frequencies.
    ways: Vec<f32>,
}

impl ModeSet {
    /// Sorts modes by frequency. Modes that are not finite, and frequencies of 0 and below, are left out.
    pub fn new(modes: impl IntoIterator<Item = BodyMode>) -> Self {
        let is_valid = |mode: &BodyMode| {
            let numbers = [mode.frequency, mode.drive, mode.left, mode.right];
            mode.frequency > 0.0 && numbers.iter().all(|number| number.is_finite())
        };
        let mut modes: Vec<_> = modes.into_iter().filter(is_valid).collect();
        // A stable sort: modes of the same frequency keep the body's order, on every machine.
        modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        modes.truncate(MAX_MODES);
        let ways = modes.iter().map(|mode| way(mode.frequency) as f32).collect();
        Self { modes, ways }
    }

    /// The modes, lowest first.
    pub fn modes(&self) -> &[BodyMode] {
        &self.modes
    }

    /// Position of each mode between low and high frequencies.
    pub(super) fn ways(&self) -> &[f32] {
        &self.ways
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.modes.len()
    }

    /// Whether there are no modes.
    pub fn is_empty(&self) -> bool {
        self.modes.is_empty()
    }
}
