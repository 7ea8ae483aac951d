//! Finds where a body is struck and picked up, from the levels of its modes in a sound.

use super::draft::{Partial, contact_share, digits};
use crate::analysis::line::Line;
use crate::analysis::log_mel::RATE;
use crate::sound::bodies::{Body, BodyMode, LN_1000, Point};
use crate::sound::contact_time;
use libm::{cos, exp, fabs, log2, log10, sin, sqrt};
use std::f64::consts::PI;

/// Number of steps along the body's length in which strike positions and pickup positions are tried.
const STRIKES: u32 = 50;
const PICKUPS: u32 = 20;
/// Greatest tilt in dB per octave.
const STEEPEST: f64 = 24.0;
/// Least weight of a mode relative to the greatest weight.
const LEAST_WEIGHT: f64 = 0.15;
/// A mode is measured until its amplitude has fallen by e to the power of this.
const HEARD: f64 = 5.0;
/// Lower bounds of the level of a body's mode and of the share of a contact, since modes near a node give no information.
const LEAST_LEVEL: f64 = 1e-3;
const LEAST_SHARE: f64 = 0.01;

/// Partials of a sound, each with the ratio of the body's mode that it is.
pub(super) struct Levels(pub(super) Vec<(Partial, f64)>);

/// The level of a partial above that of its mode.
#[derive(Clone, Copy, Debug)]
struct Excess {
    octaves: f64,
    db: f64,
    weight: f64,
}

/// The weight of a partial in the search for a body.
pub(super) fn weight(partial: &Partial) -> f64 {
    // With energy as the weight, only the loudest mode would count.
    sqrt(fabs(partial.amplitude) * sqrt(partial.t60))
}

/// The mode of a body with this ratio.
fn mode_at(modes: &[BodyMode], ratio: f64) -> Option<&BodyMode> {
    modes.iter().find(|mode| fabs(mode.ratio - ratio) < 1e-9 * ratio)
}

impl Levels {
    /// The excess of each partial over its mode, if all modes are struck alike.
    fn points(&self, body: &Body) -> Vec<Excess> {
        let modes = body.modes();
        let point = |((partial, ratio), weight): (&(Partial, f64), f64)| {
            let level = mode_at(&modes, *ratio).map_or(0.0, |mode| fabs(mode.level)).max(LEAST_LEVEL);
            Excess { octaves: log2(*ratio), db: 20.0 * log10(fabs(partial.amplitude) / level), weight }
        };
        self.0.iter().zip(self.weights()).map(point).collect()
    }

    /// The weight of each partial, which has a lower bound.
    fn weights(&self) -> impl Iterator<Item = f64> {
        let weights = self.0.iter().map(|(partial, _)| weight(partial));
        let most = weights.clone().fold(0.0, f64::max);
        weights.map(move |weight| weight.max(LEAST_WEIGHT * most))
    }

    /// The excesses over modes that a contact has struck, with these shares in dB.
    fn struck(mut points: Vec<Excess>, shares: &[f64]) -> Vec<Excess> {
        points.iter_mut().zip(shares).for_each(|(point, share)| point.db -= share);
        points
    }

    /// The share in dB of a contact's force that reaches each mode; without a hardness, the strike is a single sample.
    fn shares(&self, hardness: Option<f64>) -> Vec<f64> {
        let share = |frequency: f64, hardness: f64| fabs(contact_share(frequency, contact_time(hardness)));
        let of = |(partial, _): &(Partial, f64)| hardness.map_or(1.0, |hardness| share(partial.frequency, hardness));
        self.0.iter().map(|pair| 20.0 * log10(of(pair).max(LEAST_SHARE))).collect()
    }

    /// The amplitude of each partial in a recording at [`RATE`] from its onset on.
    pub(super) fn amplitudes_in(&self, recording: &[f32]) -> Vec<f64> {
        self.0.iter().map(|(partial, _)| amplitude(recording, partial.frequency, partial.t60)).collect()
    }

    /// Deviation in dB of the played body's modes from the partials' `amplitudes` in a recording, both at [`RATE`] and from their
    /// onsets on: the fourth root of the mean fourth power, since the largest deviations are heard most.
    pub(super) fn off_db(&self, body: &Body, amplitudes: &[f64], played: &[f32]) -> f64 {
        let modes = body.modes();
        let (mut powers, mut weights) = (0.0, 1e-12);
        for (((_, ratio), own), weight) in self.0.iter().zip(amplitudes).zip(self.weights()) {
            let Some(mode) = mode_at(&modes, *ratio) else { continue };
            let off = 20.0 * log10(amplitude(played, mode.frequency, mode.t60).max(1e-9) / own.max(1e-9));
            (powers, weights) = (powers + weight * off * off * off * off, weights + weight);
        }
        sqrt(sqrt(powers / weights))
    }

    /// For each hardness, the body with the strike position, pickup position and tilt that fit the levels best, and the
    /// remaining RMS deviation in dB.
    pub(super) fn placed(&self, body: &Body, hardnesses: &[Option<f64>]) -> Vec<(f64, Body)> {
        let shares: Vec<Vec<f64>> = hardnesses.iter().map(|hardness| self.shares(*hardness)).collect();
        let mut best = vec![(f64::INFINITY, body.clone()); hardnesses.len()];
        let try_at = |best: &mut (f64, Body), other: &Body, points: &[Excess], shares: &[f64]| {
            let (tilt, off) = line(&Self::struck(points.to_vec(), shares), -STEEPEST..=STEEPEST);
            if off < best.0 {
                *best = (off, Body { tilt: digits(tilt, 3), ..other.clone() });
            }
        };
        let at = |x: f64, point: Point| Point { x: digits(x.clamp(0.0, 1.0), 4), ..point };
        let moved = |strike: f64, pickup: f64| {
            let (strike, pickup) = (at(strike, body.strike), at(pickup, body.pickup));
            Body { strike, pickup, tilt: 0.0, ..body.clone() }
        };
        for pickup in 0..=PICKUPS {
            // Try the body's own pickup position first.
            let pickup = if pickup == 0 { body.pickup.x } else { f64::from(pickup) / f64::from(PICKUPS) };
            for strike in 1..STRIKES {
                let other = moved(f64::from(strike) / f64::from(STRIKES), pickup);
                let points = self.points(&other);
                best.iter_mut().zip(&shares).for_each(|(best, shares)| try_at(best, &other, &points, shares));
            }
        }
        best
    }
}

/// The amplitude of a mode of this frequency in Hz and T60 in seconds, in samples at [`RATE`] that begin at its onset,
/// by a matched filter.
fn amplitude(samples: &[f32], frequency: f64, t60: f64) -> f64 {
    let (decay, theta) = (LN_1000 / (t60 * f64::from(RATE)), 2.0 * PI * frequency / f64::from(RATE));
    let len = samples.len().min((HEARD / decay) as usize);
    let (radius, step) = (exp(-decay), (cos(theta), sin(theta)));
    let (mut re, mut im, mut energy) = (0.0, 0.0, 1e-30);
    let (mut x, mut y, mut size) = (1.0, 0.0, 1.0);
    for sample in &samples[..len] {
        let sample = f64::from(*sample);
        (re, im, energy) = (re + x * sample, im + y * sample, energy + size * size);
        (x, y, size) = (radius * (x * step.0 - y * step.1), radius * (x * step.1 + y * step.0), radius * size);
    }
    2.0 * sqrt(re * re + im * im) / energy
}

/// The slope in dB per octave of the line through some points, within a range, and their RMS deviation from it in dB.
fn line(points: &[Excess], slopes: std::ops::RangeInclusive<f64>) -> (f64, f64) {
    let Some(line) = Line::through(points.iter().map(|point| [point.octaves, point.db, point.weight])) else {
        return (0.0, 0.0);
    };
    let line = Line { slope: line.slope.clamp(*slopes.start(), *slopes.end()), ..line };
    let off = |point: &Excess| point.db - line.at(point.octaves);
    let squares = points.iter().map(|point| point.weight * off(point) * off(point)).sum::<f64>();
    (line.slope, sqrt(squares / line.weight))
}
