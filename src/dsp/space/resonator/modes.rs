//! The modes of a body as its masses need them, at its reference pitch.

use super::super::modes::ModeSet;
use super::fourier::Pair;
use crate::dsp::simd::vector::LANES;

/// Modes above this fraction of half the sample rate are left out.
const TOP: f64 = 0.98;

/// The modes of a body, by ascending frequency. All rows have some more numbers, so that they can be read by blocks from any mode
/// on.
#[derive(Clone, Debug)]
pub(super) struct Modes {
    len: usize,
    /// Cycles per frame.
    pub(super) cycles: Vec<f64>,
    /// Position between low and high frequencies.
    pub(super) ways: Vec<f32>,
    /// Gains from the input to each side.
    pub(super) gains: Pair,
}

impl Modes {
    /// No modes, with room for some.
    pub(super) fn with_room(modes: usize) -> Self {
        let room = modes + LANES;
        let row = || Vec::with_capacity(room);
        Self { len: 0, cycles: Vec::with_capacity(room), ways: row(), gains: [row(), row()] }
    }

    /// Loads the modes of a body. Real-time safe if there is room for them.
    pub(super) fn load(&mut self, set: &ModeSet, sample_rate: f64) {
        let (modes, room) = (set.modes(), set.len() + LANES);
        self.len = modes.len();
        self.cycles.clear();
        self.cycles.extend(modes.iter().map(|mode| mode.frequency / sample_rate));
        self.cycles.resize(room, 0.0);
        self.ways.clear();
        self.ways.extend(set.ways());
        self.ways.resize(room, 0.0);
        for (side, gains) in self.gains.iter_mut().enumerate() {
            gains.clear();
            gains.extend(modes.iter().map(|mode| gain(mode.drive * if side == 0 { mode.left } else { mode.right })));
            gains.resize(room, 0.0);
        }
    }

    /// Number of modes that are audible at a pitch.
    pub(super) fn heard(&self, pitch: f64) -> usize {
        self.cycles[..self.len].partition_point(|cycles| cycles * pitch < 0.5 * TOP)
    }
}

/// A gain in single precision. Near a node it is 0, since products with tiny gains would be subnormal.
fn gain(value: f64) -> f32 {
    if value.abs() < 1e-9 { 0.0 } else { value.clamp(-1e6, 1e6) as f32 }
}
