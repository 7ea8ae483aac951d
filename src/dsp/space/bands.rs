//! How much energy a body may hold, by bands of frequency: a bound in closed form, from what went in.

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
    /// Where its lowest and its highest mode lie between low and high frequencies, at the body's own pitch.
    ways: [f32; 2],
    /// Least and greatest height of its modes, by which their decay goes.
    heights: [f64; 2],
    /// Whether any of its modes can be heard at the pitch that the body has.
    is_heard: bool,
    /// Root of the number of its modes, and of the summed squared gains of the louder pick-up.
    drive: f64,
    pick_up: f64,
    /// Sum of the squared gains, the mean of both sides.
    power: f64,
    /// Logarithm of what a frame leaves of the slowest mode's amplitude.
    ln_radius: f64,
    /// What a tick leaves of it.
    per_tick: f64,
    /// The root of the energy is at most this.
    amplitude: f64,
}

impl Band {
    /// A band at rest. Follow with [`Bands::tune`] and [`Bands::damp`].
    ///
    /// `ways`: of its lowest and highest mode; `gains`: the sum of the squared gains to the left and to the right.
    pub(super) fn new(blocks: Range<usize>, ways: [f32; 2], modes: usize, gains: [f64; 2]) -> Self {
        let [left, right] = gains;
        let (drive, pick_up, power) = (sqrt(modes as f64), sqrt(left.max(right)), 0.5 * (left + right));
        let (heights, is_heard) = ([0.0; 2], false);
        Self { blocks, ways, heights, is_heard, drive, pick_up, power, ln_radius: 0.0, per_tick: 1.0, amplitude: 0.0 }
    }
}

/// All bands of a body.
///
/// A frame turns and shrinks each mass, and adds the input to it. So by the triangle inequality the root of a band's energy
/// after a frame is at most `r` times what it was, and `|input| √modes`. By that of Cauchy and Schwarz a pick-up
/// hears at most `‖pick-up‖` times that root.
#[derive(Clone, Debug)]
pub(super) struct Bands {
    bands: Vec<Band>,
}

/// What rounding may add to an amplitude between two measurements, and much more.
const ROUNDING: f64 = 1.001;

impl Bands {
    /// None, with room for all.
    pub(super) fn new() -> Self {
        Self { bands: Vec::with_capacity(BANDS) }
    }

    pub(super) fn clear(&mut self) {
        self.bands.clear();
    }

    /// Adds the next, of higher frequencies than those before.
    pub(super) fn push(&mut self, band: Band) {
        self.bands.push(band);
    }

    /// Takes over a pitch that adds `shift` to the ways of all modes, and of which only the first `blocks` are heard.
    /// Follow with [`Bands::damp`]. Real-time safe.
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

    /// Takes over a decay, as the logarithms of its rates; while modes are still on their way from the decay before, with
    /// those too: the slower holds. Real-time safe.
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

    /// Gain by which white noise comes out as loud as it went in, at a decay: a mode's impulse response has the energy
    /// `gain² / 4λ`. Real-time safe.
    pub(super) fn noise_gain(&self, [low, span]: [f64; 2]) -> f64 {
        let energy = |band: &Band| {
            let height = 0.5 * (band.heights[0] + band.heights[1]);
            band.power / (4.0 * exp2(low + span * height))
        };
        let sum: f64 = self.heard().map(energy).sum();
        if sum > 0.0 { 1.0 / sqrt(sum) } else { 0.0 }
    }

    /// A control tick has passed, and with it input whose magnitudes add up to `input`.
    pub(super) fn tick(&mut self, input: f64) {
        for band in self.bands.iter_mut().filter(|band| band.is_heard) {
            band.amplitude = band.amplitude * band.per_tick + input * band.drive;
        }
    }

    /// A band's energy has been measured, and no input is still to come.
    pub(super) fn measured(&mut self, index: usize, energy: f64) {
        let band = &mut self.bands[index];
        band.amplitude = band.amplitude.min(sqrt(energy) * ROUNDING);
    }

    pub(super) fn rest(&mut self) {
        self.bands.iter_mut().for_each(|band| band.amplitude = 0.0);
    }

    /// At most what either pick-up hears, once input whose magnitudes add up to `input` has come as well.
    pub(super) fn peak(&self, input: f64) -> f64 {
        self.heard().map(|band| band.pick_up * (band.amplitude + input * band.drive)).sum()
    }

    /// At most how many frames it takes until that has fallen to `peak`. An exponential a band for each of some five steps.
    pub(super) fn frames_until(&self, peak: f64, input: f64) -> u64 {
        let mut amplitudes = Energies::<BANDS>::NONE;
        for band in self.heard() {
            amplitudes.add(band.pick_up * (band.amplitude + input * band.drive), band.ln_radius);
        }
        amplitudes.frames_until(peak)
    }
}
