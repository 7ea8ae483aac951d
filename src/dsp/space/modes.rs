//! The modes of a resonant body for a reverb, each with its frequency, its drive and its gains to the pick-ups.

use super::decay::way;
use crate::dsp::simd::vector::LANES;
use libm::{floor, log2, sqrt};
use std::ops::Range;
use std::sync::LazyLock;

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

/// The modes of a body, by ascending frequency, and what all its reverbs know of them: these only point to it, so a change to another
/// body copies nothing. Making one allocates: not for the audio thread.
///
/// Absolute levels do not matter: a [`super::Resonator`] plays every body equally loud.
#[derive(Clone, Debug)]
pub struct ModeSet {
    modes: Vec<BodyMode>,
    // Rows of a number for each mode, and some more, so that they can be read by blocks from any mode on.
    /// Frequencies in Hz.
    pub(super) frequencies: Vec<f64>,
    /// Positions between low and high frequencies.
    pub(super) ways: Vec<f32>,
    /// Gains from the input to each side.
    pub(super) gains: [Vec<f32>; 2],
    pub(super) bands: Vec<BandModes>,
}

/// Third octaves from 31 Hz to 40 kHz.
pub(super) const BANDS: usize = 32;

/// Modes of similar frequency, one after the other.
#[derive(Clone, Debug)]
pub(super) struct BandModes {
    pub(super) modes: Range<usize>,
    /// The positions of its lowest and its highest mode between low and high frequencies.
    pub(super) ways: [f32; 2],
    /// Square roots of the number of its modes, and of the summed squared gains of the louder pick-up.
    pub(super) drive: f64,
    pub(super) pick_up: f64,
    /// Sum of the squared gains, the mean of both sides.
    pub(super) power: f64,
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
        let row = |number: fn(&BodyMode) -> f32| modes.iter().map(number).chain([0.0; LANES]).collect();
        Self {
            frequencies: modes.iter().map(|mode| mode.frequency).chain([0.0; LANES]).collect(),
            ways: row(|mode| way(mode.frequency) as f32),
            gains: [row(|mode| gain(mode.drive * mode.left)), row(|mode| gain(mode.drive * mode.right))],
            bands: bands(&modes),
            modes,
        }
    }

    /// No modes.
    pub(super) fn none() -> &'static Self {
        static NONE: LazyLock<ModeSet> = LazyLock::new(|| ModeSet::new([]));
        &NONE
    }

    /// The same for as long as the process runs, as a [`super::Resonator`] wants it: its memory is never freed. For tests and benches; the
    /// instrument's own bodies are statics.
    pub fn leak(self) -> &'static Self {
        Box::leak(Box::new(self))
    }

    /// The modes, lowest first.
    pub fn modes(&self) -> &[BodyMode] {
        &self.modes
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

/// A gain in single precision. Near a node it is 0, since products with tiny gains would be subnormal.
fn gain(value: f64) -> f32 {
    if value.abs() < 1e-9 { 0.0 } else { value.clamp(-1e6, 1e6) as f32 }
}

/// Groups modes by their frequencies.
fn bands(modes: &[BodyMode]) -> Vec<BandModes> {
    let index = |mode: &BodyMode| floor((3.0 * log2(mode.frequency / 31.25)).clamp(0.0, (BANDS - 1) as f64));
    let mut start = 0;
    let band = |modes: &[BodyMode]| {
        let squares = |gain: fn(&BodyMode) -> f64| -> f64 {
            modes.iter().map(|mode| gain(mode) * mode.drive).map(|gain| gain * gain).sum()
        };
        let (left, right) = (squares(|mode| mode.left), squares(|mode| mode.right));
        let first = start;
        start += modes.len();
        BandModes {
            modes: first..start,
            ways: [modes[0], modes[modes.len() - 1]].map(|mode| way(mode.frequency) as f32),
            drive: sqrt(modes.len() as f64),
            pick_up: sqrt(left.max(right)),
            power: 0.5 * (left + right),
        }
    };
    modes.chunk_by(|a, b| index(a) == index(b)).map(band).collect()
}
