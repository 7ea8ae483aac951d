//! Upper bounds of a body's energy, by bands of frequency, in closed form from its input.

use super::decay::height_of_way;
use super::modes::{BANDS, BandModes, ModeSet};
use super::ticks::BODY_TICK;
use crate::dsp::mode_bank::tail::Energies;
use libm::{exp, exp2, sqrt};
use std::ops::Range;

/// What is known of the energy of a band's modes.
#[derive(Clone, Debug)]
struct Band {
    of: &'static BandModes,
    /// Smallest and largest weight of the high decay among its modes; see [`height_of_way`].
    heights: [f64; 2],
    /// The slowest mode, and whether any mode is audible, with the coefficients that are wanted.
    wanted: Slowest,
    /// The same, and if the coefficients are changing, with the former ones.
    now: Slowest,
    /// The slowest mode's amplitude ratio per tick.
    per_tick: f64,
    /// Upper bound of the square root of the energy.
    amplitude: f64,
}

/// A bound of what a band does.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slowest {
    /// Whether any of its modes is audible.
    is_heard: bool,
    /// Logarithm of the slowest mode's amplitude ratio per frame.
    ln_radius: f64,
}

impl Band {
    /// Upper bound of the gain from the square root of the energy to either pick-up.
    fn pick_up(&self) -> f64 {
        self.of.pick_up * SUMS
    }

    fn set(&mut self, now: Slowest) {
        self.now = now;
        self.per_tick = exp(now.ln_radius * BODY_TICK as f64);
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

/// Upper bound, with a large margin, of the output's error: masses are summed by taps (`super::resonator`).
const SUMS: f64 = 1.0001;

/// Upper bound, with a large margin, of the amplitude that rounding adds between two measurements.
const ROUNDING: f64 = 1.001;

impl Bands {
    /// No bands, with room for all.
    pub(super) fn new() -> Self {
        Self { bands: Vec::with_capacity(BANDS) }
    }

    /// Loads the bands of a body. Follow with [`Bands::change`] and [`Bands::settle`]. Real-time safe.
    pub(super) fn load(&mut self, set: &'static ModeSet) {
        let none = Slowest { is_heard: false, ln_radius: f64::NEG_INFINITY };
        let band = |of| Band { of, heights: [0.0; 2], wanted: none, now: none, per_tick: 0.0, amplitude: 0.0 };
        self.bands.clear();
        self.bands.extend(set.bands.iter().map(band));
    }

    /// Sets the coefficients that are wanted: a pitch that adds `shift` to the ways of all modes, at which the first `heard`
    /// modes are audible, and a decay as the logarithms of its rates. Until [`Bands::settle`], the slower of the former decay
    /// and this one counts. Real-time safe.
    pub(super) fn change(&mut self, shift: f32, heard: usize, [low, span]: [f64; 2]) {
        for band in &mut self.bands {
            band.heights = band.of.ways.map(|way| height_of_way(way + shift).into());
            let [least, greatest] = band.heights;
            let ln_radius = -exp2((low + span * least).min(low + span * greatest));
            let is_heard = band.of.modes.start < heard;
            band.wanted = Slowest { is_heard, ln_radius };
            let ln_radius = if band.now.is_heard { ln_radius.max(band.now.ln_radius) } else { ln_radius };
            band.set(Slowest { is_heard: is_heard || band.now.is_heard, ln_radius });
        }
    }

    /// Ends a change: all masses have the wanted coefficients, and nothing sounds any more with others. Real-time safe.
    pub(super) fn settle(&mut self) {
        self.bands.iter_mut().filter(|band| band.now != band.wanted).for_each(|band| band.set(band.wanted));
    }

    fn heard(&self) -> impl Iterator<Item = &Band> {
        self.bands.iter().filter(|band| band.now.is_heard)
    }

    pub(super) fn len(&self) -> usize {
        self.bands.len()
    }

    /// The modes of a band.
    pub(super) fn modes(&self, index: usize) -> Range<usize> {
        self.bands[index].of.modes.clone()
    }

    /// Gain at which the output is as loud as the input for white noise, at a decay. A mode's impulse response has the energy
    /// `gain² / 4λ`. Real-time safe.
    pub(super) fn noise_gain(&self, [low, span]: [f64; 2]) -> f64 {
        let energy = |band: &Band| {
            let height = 0.5 * (band.heights[0] + band.heights[1]);
            band.of.power / (4.0 * exp2(low + span * height))
        };
        let sum: f64 = self.bands.iter().filter(|band| band.wanted.is_heard).map(energy).sum();
        if sum > 0.0 { 1.0 / sqrt(sum) } else { 0.0 }
    }

    /// Updates the bounds after a control tick whose input had the summed magnitudes `input`. Of bands that are not audible too:
    /// if they become so, the head of the response makes this input heard.
    pub(super) fn tick(&mut self, input: f64) {
        for band in &mut self.bands {
            band.amplitude = band.amplitude * band.per_tick + input * band.of.drive;
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
        self.heard().map(|band| band.pick_up() * (band.amplitude + input * band.of.drive)).sum()
    }

    /// Upper bound of the frames until that has fallen to `peak`. Takes one exponential per band for each of about five steps.
    pub(super) fn frames_until(&self, peak: f64, input: f64) -> u64 {
        let mut amplitudes = Energies::<BANDS>::NONE;
        for band in self.heard() {
            amplitudes.add(band.pick_up() * (band.amplitude + input * band.of.drive), band.now.ln_radius);
        }
        amplitudes.frames_until(peak)
    }
}
