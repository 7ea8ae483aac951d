//! Which modes of a fit the sound cannot have had: louder than its peak allows, not known at all, or lost beside a neighbour.
//!
//! Sounds that are no sums of damped sinusoids, such as glides, are explained best by modes that all but cancel. Such modes
//! explain much, so they stand out of noise, but they say nothing of the sound.

use super::fit::Fit;
use super::pole::{LN_60_DB, Pole};
use libm::{exp, sqrt};
use std::f64::consts::PI;

/// Amplitude over the sound's peak that modes can have. Two as loud as each other, a bandwidth apart, cancel at the onset
/// and have one and a half times the peak that is heard.
const LOUDEST: f64 = 2.0;
/// Shortest T60 in seconds.
const SHORTEST: f64 = 0.005;
/// Least frequency in bandwidths at half power: what decays faster does not vibrate.
const LEAST_QUALITY: f64 = 1.0;
/// Largest standard deviations of a pole in its widths, and of an amplitude as a share of it.
const DEVIATION: f64 = 0.5;
/// A mode 100 dB below a neighbour, and within so many times the sum of their widths, cannot be heard: it only corrects the
/// neighbour's shape.
const SKIRT: f64 = 1e-5;
const BESIDE: f64 = 8.0;
/// Lowest frequency that is heard, in Hz.
pub(super) const AUDIBLE: f64 = 20.0;

/// What the modes of a sound are bound by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Largest magnitude of a sample from the onset on.
    pub(super) peak: f64,
    /// Samples from the onset to the first one of the fit.
    pub(super) late: f64,
    /// Hz.
    pub(super) sample_rate: f64,
}

impl Limits {
    /// Whether a mode is heard: those below explain drifts, and are no result.
    fn audible(&self, pole: Pole) -> bool {
        pole.theta * self.sample_rate >= 2.0 * PI * AUDIBLE
    }

    /// The level of a mode at the onset over the most that the peak allows.
    fn excess(&self, pole: Pole, amplitude: f64) -> f64 {
        amplitude * exp((pole.decay * self.late).min(500.0)) / (LOUDEST * self.peak)
    }

    fn rings(&self, pole: Pole) -> bool {
        let longest = LN_60_DB / (SHORTEST * self.sample_rate);
        // The bandwidth at half power is decay / π cycles per sample.
        pole.decay <= longest && 2.0 * pole.decay * LEAST_QUALITY <= pole.theta
    }
}

/// Places of modes that the sound cannot have had, given the floors of noise at each mode; of neighbours that are too loud
/// the loudest alone, since the others may be plausible without it.
pub(super) fn implausible(fit: &Fit, floors: &[f64], len: usize, limits: &Limits) -> Vec<usize> {
    let certainty = fit.certainty(len);
    let unknown = |k: usize| {
        let Some(certainty) = &certainty else { return true };
        let deviation = |index: usize| sqrt(certainty.variances[k][index] * floors[k] / 2.0);
        let width = fit.poles[k].width(len);
        let known = deviation(0) < DEVIATION * width && deviation(1) < DEVIATION * width && deviation(2) < DEVIATION;
        !known
    };
    let is_on_a_skirt = |k: usize| {
        let is_of = |other: usize| {
            let distance = (fit.poles[k].theta - fit.poles[other].theta).abs();
            fit.amplitudes[k].norm() < SKIRT * fit.amplitudes[other].norm()
                && distance < BESIDE * (fit.poles[k].width(len) + fit.poles[other].width(len))
        };
        (0..fit.poles.len()).any(is_of)
    };
    let mut dropped: Vec<usize> = (0..fit.poles.len())
        .filter(|k| limits.audible(fit.poles[*k]) && (!limits.rings(fit.poles[*k]) || unknown(*k) || is_on_a_skirt(*k)))
        .collect();
    let excess = |k: usize| limits.excess(fit.poles[k], fit.amplitudes[k].norm());
    let is_loud = |k: usize| excess(k) > 1.0 || excess(k).is_nan();
    let mut loud: Vec<usize> = (0..fit.poles.len()).filter(|k| is_loud(*k) && !dropped.contains(k)).collect();
    loud.sort_by(|a, b| excess(*b).total_cmp(&excess(*a)));
    for k in loud {
        let beside = |other: &usize| {
            let distance = (fit.poles[k].theta - fit.poles[*other].theta).abs();
            distance < 4.0 * (fit.poles[k].width(len) + fit.poles[*other].width(len))
        };
        if !dropped.iter().any(beside) {
            dropped.push(k);
        }
    }
    dropped
}
