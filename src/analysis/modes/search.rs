//! The search: what stands out of the residual is resolved into poles, fitted together with all others, and kept if it
//! explains more than noise would.

use super::detect::Spectra;
use super::esprit::Band;
use super::fit::{Certainty, Fit};
use super::pole::{LN_60_DB, Pole, add};
use std::f64::consts::PI;

/// What a mode has to explain, in multiples of what noise explains near it on average. Noise alone exceeds it once in
/// e¹⁵ bins, 3 million.
const DETECTION: f64 = 15.0;
/// The same for its amplitude once all poles are unknown: lower, since a pole of its own costs a mode half of it.
const SIGNIFICANCE: f64 = 5.0;
/// Least share of the sound's energy: what rounding to single precision leaves.
const LEAST_SHARE: f64 = 1e-13;
/// Energies that are looked at in one round, relative to the strongest: the skirts of the strong hide the weak.
const ROUND_SPAN: f64 = 1e-4;
/// Lowest frequency of a mode in Hz.
const LOWEST: f64 = 10.0;

const MOST_ROUNDS: usize = 24;

/// Modes that were found, with what is known of them.
pub(super) struct Found {
    pub(super) fit: Fit,
    pub(super) certainty: Certainty,
    /// Average energy that noise explains for each mode.
    pub(super) floors: Vec<f64>,
}

/// Finds the modes of a sound that begins with its first sample. `progress` is told a share of the work and says whether
/// to go on. `None` if it was stopped, or nothing can be fitted.
pub(super) fn find(
    samples: &[f64],
    sample_rate: f64,
    most_modes: usize,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Option<Found> {
    let energy: f64 = samples.iter().map(|sample| sample * sample).sum();
    let least = LEAST_SHARE * energy;
    let range = (2.0 * PI * LOWEST / sample_rate, 0.99 * PI);
    let mut fit = Fit::new(samples, Vec::new())?;
    for round in 0..MOST_ROUNDS {
        if !progress(0.9 * round as f64 / (round as f64 + 4.0)) {
            return None;
        }
        let residual = fit.residual(samples);
        let spectra = Spectra::new(&residual, sample_rate);
        let reach = |pole: Pole| band(pole, samples.len()).half_width();
        let strongest = spectra.candidates(DETECTION, least, range, |_| PI).first().map_or(0.0, |first| first.energy);
        let mut candidates = spectra.candidates(DETECTION, least.max(ROUND_SPAN * strongest), range, reach);
        candidates.truncate(most_modes.saturating_sub(fit.poles.len()));
        if candidates.is_empty() {
            break;
        }
        let mut known: Vec<(Pole, bool)> = fit.poles.iter().map(|pole| (*pole, true)).collect();
        let mut amplitudes = fit.amplitudes.clone();
        for candidate in candidates {
            let band = band(candidate.pole, samples.len());
            let within = |pole: Pole| (pole.theta - candidate.pole.theta).abs() < band.half_width();
            let members: Vec<usize> = (0..known.len()).filter(|k| known[*k].1 && within(known[*k].0)).collect();
            let mut mixed = residual.clone();
            members.iter().for_each(|k| add(&mut mixed, known[*k].0, amplitudes[*k], 1.0));
            let poles = band.poles(&mixed);
            if poles.len() > members.len() {
                members.iter().rev().for_each(|k| {
                    known.remove(*k);
                    amplitudes.remove(*k);
                });
                known.extend(poles.into_iter().map(|pole| (pole, false)));
            } else {
                known.push((candidate.pole, false));
            }
            amplitudes.resize(known.len(), Default::default());
        }
        fit = Fit::new(samples, apart(known.into_iter().map(|(pole, _)| pole), samples.len()))?;
        fit = prune(fit, samples, sample_rate, least)?;
        let mut go_on = || progress(0.9 * round as f64 / (round as f64 + 4.0));
        fit = fit.refine(samples, 1e-2, 5, &mut go_on);
        fit = prune(fit, samples, sample_rate, least)?;
    }
    let mut share = 0.9;
    let mut go_on = || {
        share += 0.002;
        progress(share)
    };
    fit = fit.refine(samples, 1e-7, 40, &mut go_on);
    fit = prune(fit, samples, sample_rate, least)?;
    fit = fit.refine(samples, 1e-8, 20, &mut go_on);
    let certainty = fit.certainty(samples.len())?;
    let spectra = Spectra::new(&fit.residual(samples), sample_rate);
    let floors = fit.poles.iter().map(|pole| spectra.floor(*pole)).collect();
    progress(1.0).then_some(Found { fit, certainty, floors })
}

/// The band in which a pole is resolved: about as long as its T60.
fn band(pole: Pole, len: usize) -> Band {
    Band::new(pole.theta, ((1.2 * LN_60_DB / pole.decay) as usize).min(len))
}

/// The poles without those that coincide with an earlier one.
fn apart(poles: impl Iterator<Item = Pole>, len: usize) -> Vec<Pole> {
    let mut kept: Vec<Pole> = Vec::new();
    for pole in poles {
        let differs = |other: &Pole| {
            let distance = libm::hypot(pole.theta - other.theta, pole.decay - other.decay);
            distance > 0.05 * pole.width(len).min(other.width(len))
        };
        if kept.iter().all(differs) {
            kept.push(pole);
        }
    }
    kept
}

/// Removes modes that explain no more than noise would, the weakest of each neighbourhood first.
fn prune(mut fit: Fit, samples: &[f64], sample_rate: f64, least: f64) -> Option<Fit> {
    let len = samples.len();
    for _ in 0..30 {
        if fit.poles.is_empty() {
            break;
        }
        let certainty = fit.certainty(len)?;
        let spectra = Spectra::new(&fit.residual(samples), sample_rate);
        let worth = |k: usize| {
            let floor = spectra.floor(fit.poles[k]).max(1e-300);
            let (explained, significance) = (certainty.explained[k], certainty.significance[k]);
            (explained / (DETECTION * floor)).min(significance / (SIGNIFICANCE * floor)).min(explained / least)
        };
        let mut weak: Vec<(f64, usize)> =
            (0..fit.poles.len()).map(|k| (worth(k), k)).filter(|(worth, _)| *worth < 1.0).collect();
        if weak.is_empty() {
            break;
        }
        weak.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut removed: Vec<usize> = Vec::new();
        for (_, k) in weak {
            let near = |other: &usize| {
                let width = fit.poles[k].width(len).max(fit.poles[*other].width(len));
                (fit.poles[k].theta - fit.poles[*other].theta).abs() < 8.0 * width
            };
            if !removed.iter().any(near) {
                removed.push(k);
            }
        }
        let kept = (0..fit.poles.len()).filter(|k| !removed.contains(k)).map(|k| fit.poles[k]).collect();
        fit = Fit::new(samples, kept)?;
    }
    Some(fit)
}
