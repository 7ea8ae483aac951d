//! Upper bounds of a body's energy, by bands of frequency, in closed form from its input.

use super::decay::height_of_way;
use super::kernel::FRAMES;
use crate::dsp::mode_bank::tail::Energies;
use libm::{exp, exp2, sqrt};
use std::ops::Range;

/// Third octaves from 31 Hz to 40 kHz.
pub(super) const BANDS: usize = 32;

/// Modes of similar frequency: whole blocks, one after the other.
#[derive(Clone, Debug)]
pub(super) struct Band {
    blocks: Range<usize>,
    /// The positions of its lowest and its highest mode between low and high frequencies, at the body's reference pitch.
    ways: [f32; 2],
    /// Smallest and largest weight of the high decay among its modes; see [`height_of_way`].
    heights: [f64; 2],
    /// Whether any of its modes is audible at the body's present pitch.
    is_heard: bool,
    /// Square roots of the number of its modes, and of the summed squared gains of the louder pick-up.
    drive: f64,
    pick_up: f64,
    /// Sum of the squared gains, the mean of both sides.
    power: f64,
    /// Logarithm of the slowest mode's amplitude ratio per frame.
    ln_radius: f64,
    /// The slowest mode's amplitude ratio per tick.
    per_tick: f64,
    /// Upper bound of the square root of the energy.
    amplitude: f64,
}

impl Band {
    /// A band at rest. Follow with [`Bands::tune`] and [`Bands::damp`].
    ///
    /// `ways` has those of its lowest and highest mode; `gains` the sums of the squared gains to the left and to the right.
    pub(super) fn new(blocks: Range<usize>, ways: [f32; 2], modes: usize, gains: [f64; 2]) -> Self {
        let [left, right] = gains;
        let (drive, pick_up, power) = (sqrt(modes as f64), sqrt(left.max(right)), 0.5 * (left + right));
        let (heights, is_heard) = ([0.0; 2], false);
        Self { blocks, ways, heights, is_heard, drive, pick_up, power, ln_radius: 0.0, per_tick: 1.0, amplitude: 0.0 }
    }
}

/// All bands of a body.
///
/// A frame turns and shrinks each mass, and adds the input to it. So by the triangle inequality, the square root of a band's
/// energy after a frame is at most `r` times the one before plus `|input| √modes`. By the Cauchy–Schwarz inequality, the
/// output of a pick-up is at most `‖pick-up‖` times that square root.
#[derive(Clone, Debug)]
pub(super) struct Bands {
    bands: Vec<Band>,
}

/// Upper bound, with a large margin, of the amplitude that rounding adds between two measurements.
const ROUNDING: f64 = 1.001;

impl Bands {
    /// No bands, with room for all.
    pub(super) fn new() -> Self {
        Self { bands: Vec::with_capacity(BANDS) }
    }

    pub(super) fn clear(&mut self) {
        self.bands.clear();
    }

    /// Adds the next band. Its frequencies are higher than those of the bands before.
    pub(super) fn push(&mut self, band: Band) {
        self.bands.push(band);
    }

    /// Sets the pitch: it adds `shift` to the ways of all modes, and only the first `blocks` blocks are audible. Follow with
    /// [`Bands::damp`]. Real-time safe.
    pub(super) fn tune(&mut self, shift: f32, blocks: usize) {
        for band in &mut self.bands {
            band.heights = band.ways.map(|way| height_of_way(way + shift).into());
            band.is_heard = band.blocks.start < blocks;
            if !band.is_heard {
                band.amplitude = 0.0;
            }
        }
    }

    fn heard(&self) -> impl Iterator<Item = &Band> {
        self.bands.iter().filter(|band| band.is_heard)
    }

    pub(super) fn len(&self) -> usize {
        self.bands.len()
    }

    /// The blocks of a band.
    pub(super) fn blocks(&self, index: usize) -> Range<usize> {
        self.bands[index].blocks.clone()
    }

    /// Sets the decay, as the logarithms of its rates. While some modes still have the previous decay, its rates are given too,
    /// and the slower decay counts. Real-time safe.
    pub(super) fn damp(&mut self, decays: [[f64; 2]; 2]) {
        for band in &mut self.bands {
            let slowest = |[low, span]: [f64; 2]| {
                let [least, greatest] = band.heights;
                exp2((low + span * least).min(low + span * greatest))
            };
            band.ln_radius = -slowest(decays[0]).min(slowest(decays[1]));
            band.per_tick = exp(band.ln_radius * FRAMES as f64);
        }
    }

    /// Gain at which the output is as loud as the input for white noise, at a decay. A mode's impulse response has the energy
    /// `gain² / 4λ`. Real-time safe.
    pub(super) fn noise_gain(&self, [low, span]: [f64; 2]) -> f64 {
        let energy = |band: &Band| {
            let height = 0.5 * (band.heights[0] + band.heights[1]);
            band.power / (4.0 * exp2(low + span * height))
        };
        let sum: f64 = self.heard().map(energy).sum();
        if sum > 0.0 { 1.0 / sqrt(sum) } else { 0.0 }
    }

    /// Updates the bounds after a control tick whose input had the summed magnitudes `input`.
    pub(super) fn tick(&mut self, input: f64) {
        for band in self.bands.iter_mut().filter(|band| band.is_heard) {
            band.amplitude = band.amplitude * band.per_tick + input * band.drive;
        }
    }

    /// Lowers a band's bound to its measured energy. No input may be pending.
    pub(super) fn measured(&mut self, index: usize, energy: f64) {
        let band = &mut self.bands[index];
        band.amplitude = band.amplitude.min(sqrt(energy) * ROUNDING);
    }

    pub(super) fn rest(&mut self) {
        self.bands.iter_mut().for_each(|band| band.amplitude = 0.0);
    }

    /// Upper bound of the output of either pick-up, after further input whose magnitudes sum to `input`.
    pub(super) fn peak(&self, input: f64) -> f64 {
        self.heard().map(|band| band.pick_up * (band.amplitude + input * band.drive)).sum()
    }

    /// Upper bound of the frames until that has fallen to `peak`. Takes one exponential per band for each of about five steps.
    pub(super) fn frames_until(&self, peak: f64, input: f64) -> u64 {
        let mut amplitudes = Energies::<BANDS>::NONE;
        for band in self.heard() {
            amplitudes.add(band.pick_up * (band.amplitude + input * band.drive), band.ln_radius);
        }
        amplitudes.frames_until(peak)
    }
}
