//! Finds modes of a fit that the sound cannot have: too loud for its peak, too uncertain, or masked by a neighbour.
//!
//! Sounds that are no sums of damped sinusoids, such as glides, are explained best by modes that almost cancel each
//! other. Such modes explain much, so they stand out of noise, but they have no meaning for the sound.

use super::fit::Fit;
use super::pole::{LN_60_DB, Pole};
use libm::{exp, sqrt};
use std::f64::consts::PI;

/// Largest amplitude of a mode, relative to the sound's peak. Two equally loud modes, a bandwidth apart, may cancel at
/// the onset, and each have one and a half times the peak that is heard.
const LOUDEST: f64 = 2.0;
/// Shortest T60 in seconds.
const SHORTEST: f64 = 0.005;
/// Least frequency in bandwidths at half power: a mode that decays faster does not oscillate.
const LEAST_QUALITY: f64 = 1.0;
/// Largest standard deviations of a pole in its widths, and of an amplitude as a share of it.
const DEVIATION: f64 = 0.5;
/// A mode 100 dB below a neighbour, and within so many times the sum of their widths, is inaudible: it only corrects
/// the shape of the neighbour.
const SKIRT: f64 = 1e-5;
const BESIDE: f64 = 8.0;
/// Lowest audible frequency in Hz.
pub(super) const AUDIBLE: f64 = 20.0;

/// The limits of a sound's modes.
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
    /// Whether a mode is audible. Lower modes only explain drifts, and are no result.
    fn audible(&self, pole: Pole) -> bool {
        pole.theta * self.sample_rate >= 2.0 * PI * AUDIBLE
    }

    /// The amplitude of a mode at the onset, relative to the largest that the peak allows.
    fn excess(&self, pole: Pole, amplitude: f64) -> f64 {
        amplitude * exp((pole.decay * self.late).min(500.0)) / (LOUDEST * self.peak)
    }

    fn rings(&self, pole: Pole) -> bool {
        let longest = LN_60_DB / (SHORTEST * self.sample_rate);
        // The bandwidth at half power is decay / π cycles per sample.
        pole.decay <= longest && 2.0 * pole.decay * LEAST_QUALITY <= pole.theta
    }
}

/// Indices of modes that the sound cannot have, given the noise floor of each mode. Of neighbours that are too loud,
/// only the loudest is given, since the others may be plausible without it.
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
