//! Upper bounds of a body's energy, by bands of frequency, in closed form from its input.

use super::decay::height_of_way;
use super::modes::{BodyMode, ModeSet};
use super::ticks::BODY_TICK;
use crate::dsp::mode_bank::tail::Energies;
use libm::{exp, exp2, floor, log2, sqrt};
use std::ops::Range;

/// Third octaves from 31 Hz to 40 kHz.
pub(super) const BANDS: usize = 32;

/// Modes of similar frequency, one after the other.
#[derive(Clone, Debug)]
struct Band {
    modes: Range<usize>,
    /// The positions of its lowest and its highest mode between low and high frequencies, at the body's reference pitch.
    ways: [f32; 2],
    /// Smallest and largest weight of the high decay among its modes; see [`height_of_way`].
    heights: [f64; 2],
    /// Square roots of the number of its modes, and of the summed squared gains of the louder pick-up.
    drive: f64,
    pick_up: f64,
    /// Sum of the squared gains, the mean of both sides.
    power: f64,
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

    /// Groups the modes of a body by their frequencies. Follow with [`Bands::change`] and [`Bands::settle`]. Real-time safe.
    pub(super) fn load(&mut self, set: &ModeSet) {
        self.bands.clear();
        let (modes, ways) = (set.modes(), set.ways());
        let index = |frequency: f64| floor((3.0 * log2(frequency / 31.25)).clamp(0.0, (BANDS - 1) as f64));
        let mut start = 0;
        while start < modes.len() {
            let band = index(modes[start].frequency);
            let end = start + modes[start..].partition_point(|mode| index(mode.frequency) <= band);
            let squares = |gain: fn(&BodyMode) -> f64| -> f64 {
                modes[start..end].iter().map(|mode| gain(mode) * mode.drive).map(|gain| gain * gain).sum()
            };
            let (left, right) = (squares(|mode| mode.left), squares(|mode| mode.right));
            let none = Slowest { is_heard: false, ln_radius: f64::NEG_INFINITY };
            self.bands.push(Band {
                modes: start..end,
                ways: [ways[start], ways[end - 1]],
                heights: [0.0; 2],
                drive: sqrt((end - start) as f64),
                pick_up: sqrt(left.max(right)) * SUMS,
                power: 0.5 * (left + right),
                wanted: none,
                now: none,
                per_tick: 0.0,
                amplitude: 0.0,
            });
            start = end;
        }
    }

    /// Sets the coefficients that are wanted: a pitch that adds `shift` to the ways of all modes, at which the first `heard`
    /// modes are audible, and a decay as the logarithms of its rates. Until [`Bands::settle`], the slower of the former decay
    /// and this one counts. Real-time safe.
    pub(super) fn change(&mut self, shift: f32, heard: usize, [low, span]: [f64; 2]) {
        for band in &mut self.bands {
            band.heights = band.ways.map(|way| height_of_way(way + shift).into());
            let [least, greatest] = band.heights;
            let ln_radius = -exp2((low + span * least).min(low + span * greatest));
            let is_heard = band.modes.start < heard;
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
        self.bands[index].modes.clone()
    }

    /// Gain at which the output is as loud as the input for white noise, at a decay. A mode's impulse response has the energy
    /// `gain² / 4λ`. Real-time safe.
    pub(super) fn noise_gain(&self, [low, span]: [f64; 2]) -> f64 {
        let energy = |band: &Band| {
            let height = 0.5 * (band.heights[0] + band.heights[1]);
            band.power / (4.0 * exp2(low + span * height))
        };
        let sum: f64 = self.bands.iter().filter(|band| band.wanted.is_heard).map(energy).sum();
        if sum > 0.0 { 1.0 / sqrt(sum) } else { 0.0 }
    }

    /// Updates the bounds after a control tick whose input had the summed magnitudes `input`. Of bands that are not audible too:
    /// if they become so, the head of the response makes this input heard.
    pub(super) fn tick(&mut self, input: f64) {
        for band in &mut self.bands {
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
            amplitudes.add(band.pick_up * (band.amplitude + input * band.drive), band.now.ln_radius);
        }
        amplitudes.frames_until(peak)
    }
}
