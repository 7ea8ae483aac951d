//! Finds modes of a fit that the sound cannot have: too loud for its peak, too uncertain, or masked by a neighbour.
//!
//! Sounds that are no sums of damped sinusoids, such as glides, are explained best by modes that almost cancel each
//! other. Such modes explain much, so they stand out of noise, but they have no meaning for the sound.

use super::fit::{Certainty, Fit};
use super::pole::{Pole, magnitude};
use crate::sound::bodies::LN_1000;
use libm::{exp, sqrt};
use std::f64::consts::PI;

/// Largest amplitude of a mode, relative to the sound's peak. Two equally loud modes, a bandwidth apart, may cancel at
/// the onset, and each have one and a half times the peak that is heard.
const LOUDEST: f64 = 2.0;
/// Shortest T60 in seconds.
const SHORTEST: f64 = 0.005;
/// Least frequency in bandwidths at half power: a mode that decays faster does not oscillate.
const LEAST_QUALITY: f64 = 1.0;
/// Distance within which modes are neighbours, as a multiple of the sum of their widths.
const NEIGHBOURS: f64 = 4.0;
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
        let longest = LN_1000 / (SHORTEST * self.sample_rate);
        // The bandwidth at half power is decay / π cycles per sample.
        pole.decay <= longest && 2.0 * pole.decay * LEAST_QUALITY <= pole.theta
    }
}

/// Indices of modes that the sound cannot have, given their certainty, if it is known, and the noise floor of each mode. Of
/// neighbours that are too loud, only the loudest is given, since the others may be plausible without it; if `worst_only`, so of
/// neighbours that are too uncertain.
pub(super) fn implausible(
    fit: &Fit,
    certainty: Option<&Certainty>,
    floors: &[f64],
    len: usize,
    limits: &Limits,
    worst_only: bool,
) -> Vec<usize> {
    // The largest deviation of a mode, relative to the largest that is allowed.
    let doubt = |k: usize| {
        let Some(certainty) = certainty else { return f64::INFINITY };
        let deviation = |index: usize| sqrt(certainty.variances[k][index] * floors[k] / 2.0);
        let width = fit.poles[k].width(len);
        let doubts = [deviation(0) / width, deviation(1) / width, deviation(2)];
        // What is not a number is not known.
        let is_known = doubts.iter().all(|doubt| doubt.is_finite());
        if is_known { doubts.into_iter().fold(0.0, f64::max) / DEVIATION } else { f64::INFINITY }
    };
    let reach = |k: usize, other: usize| fit.poles[k].width(len) + fit.poles[other].width(len);
    let distance = |k: usize, other: usize| (fit.poles[k].theta - fit.poles[other].theta).abs();
    let excess = |k: usize| limits.excess(fit.poles[k], magnitude(fit.amplitudes[k]));
    // What the sound cannot have itself, such as a short burst of a thousand times its peak, hides nothing.
    let hides = |k: usize| limits.rings(fit.poles[k]) && excess(k) <= 1.0;
    let is_on_a_skirt = |k: usize| {
        let is_of = |other: usize| {
            hides(other)
                && magnitude(fit.amplitudes[k]) < SKIRT * magnitude(fit.amplitudes[other])
                && distance(k, other) < BESIDE * reach(k, other)
        };
        (0..fit.poles.len()).any(is_of)
    };
    let audible = |k: &usize| limits.audible(fit.poles[*k]);
    let mut dropped: Vec<usize> =
        (0..fit.poles.len()).filter(audible).filter(|k| !limits.rings(fit.poles[*k]) || is_on_a_skirt(*k)).collect();
    let mut drop = |fault: &dyn Fn(usize) -> f64, worst_only: bool| {
        let mut faulty: Vec<(f64, usize)> = (0..fit.poles.len()).map(|k| (fault(k), k)).collect();
        faulty.retain(|(fault, k)| (*fault > 1.0 || fault.is_nan()) && !dropped.contains(k));
        faulty.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (_, k) in faulty {
            let beside = |other: &usize| distance(k, *other) < NEIGHBOURS * reach(k, *other);
            if !worst_only || !dropped.iter().any(beside) {
                dropped.push(k);
            }
        }
    };
    drop(&|k| if audible(&k) { doubt(k) } else { 0.0 }, worst_only);
    drop(&excess, true);
    dropped
}
