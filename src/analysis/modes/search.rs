//! The search for modes, round by round.
//!
//! What stands out of the residual is resolved into poles, fitted together with all others, and kept if it explains more
//! than noise would.

use super::detect::Spectra;
use super::esprit::Band;
use super::fit::{Certainty, Fit};
use super::plausible::{Limits, implausible};
use super::pole::{LN_60_DB, Pole, add};
use super::prune::{DETECTION, prune};
use crate::error::{Error, Result};
use std::f64::consts::PI;

/// Least share of the sound's energy: what rounding to single precision leaves.
const LEAST_SHARE: f64 = 1e-13;
/// Energies that are looked at in one round, relative to the strongest: the skirts of the strong hide the weak.
const ROUND_SPAN: f64 = 1e-4;
/// Lowest and highest frequency of a mode, in Hz and as a share of half the sample rate.
const LOWEST: f64 = 10.0;
const HIGHEST: f64 = 0.99;

const MOST_ROUNDS: usize = 24;
/// Rounds without progress after which a sound is taken for no sum of modes. Modes that are resolved anew with their
/// neighbours can cost a round or two.
const PATIENCE: usize = 3;
/// Times that modes which the sound cannot have had are dropped. What is left may be implausible then.
const MOST_REMOVALS: usize = 12;

/// Modes that were found, with what is known of them.
pub(super) struct Found {
    pub(super) fit: Fit,
    pub(super) certainty: Certainty,
    /// Average energy that noise explains for each mode.
    pub(super) floors: Vec<f64>,
}

/// Finds the modes of a sound that begins with its first sample. `progress` is told a share of the work and says whether
/// to go on.
///
/// # Errors
/// [`Error::Interrupted`] if it was stopped; [`Error::Value`] if the equations of the fit have no solution.
pub(super) fn find(
    samples: &[f64],
    sample_rate: f64,
    most_modes: usize,
    limits: &Limits,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Found> {
    let unsolvable = || {
        let message = "the equations of its modes cannot be solved: expected something that is struck and rings freely";
        Error::value("sound", message)
    };
    let energy: f64 = samples.iter().map(|sample| sample * sample).sum();
    let least = LEAST_SHARE * energy;
    let pruned = |fit| prune(fit, samples, sample_rate, least);
    let mut fit = Fit::new(samples, Vec::new()).ok_or_else(unsolvable)?;
    let (mut best, mut idle, mut split) = (fit.clone(), 0, false);
    for round in 0..MOST_ROUNDS {
        let share = 0.9 * round as f64 / (round as f64 + 4.0);
        if !progress(share) {
            return Err(Error::Interrupted);
        }
        let mut go_on = || progress(share);
        let place = if split { Where::Modes } else { Where::StandsOut(least) };
        let poles = resolve(&fit, samples, sample_rate, most_modes, place);
        let next = if split {
            // What hides beneath another mode explains nothing before it has found its place.
            Fit::new(samples, poles).map(|fit| fit.refine(samples, 1e-2, 8, &mut go_on))
        } else if poles.is_empty() || idle == PATIENCE {
            // Modes that are a little off leave more than what is hidden beneath.
            (best, idle, split) = (best.refine(samples, 1e-7, 40, &mut go_on), 0, true);
            let Some(refined) = pruned(best.clone()) else { break };
            (fit, best) = (refined.clone(), refined);
            continue;
        } else {
            let next = Fit::new(samples, poles).and_then(pruned);
            next.map(|fit| fit.refine(samples, 1e-2, 5, &mut go_on))
        };
        // Poles that all but coincide can make equations without a solution: then the best so far is what is found.
        let Some(next) = next.and_then(pruned) else { break };
        fit = next;
        let better = fit.unexplained < best.unexplained;
        if better {
            best = fit.clone();
        } else if split {
            break;
        }
        (idle, split) = (if better { 0 } else { idle + 1 }, false);
    }
    fit = best;
    let mut share = 0.9;
    let mut go_on = || {
        share = (share + 0.002_f64).min(1.0);
        progress(share)
    };
    fit = fit.refine(samples, 1e-7, 40, &mut go_on);
    fit = pruned(fit.clone()).unwrap_or(fit);
    for _ in 0..MOST_REMOVALS {
        let dropped = implausible(&fit, &floors(&fit, samples, sample_rate), samples.len(), limits);
        if dropped.is_empty() {
            break;
        }
        if !go_on() {
            return Err(Error::Interrupted);
        }
        let left = (0..fit.poles.len()).filter(|k| !dropped.contains(k)).map(|k| fit.poles[k]).collect();
        fit = Fit::new(samples, left).ok_or_else(unsolvable)?.refine(samples, 1e-7, 20, &mut go_on);
    }
    fit = fit.refine(samples, 1e-8, 20, &mut go_on);
    let dropped = implausible(&fit, &floors(&fit, samples, sample_rate), samples.len(), limits);
    if !dropped.is_empty() {
        let left = (0..fit.poles.len()).filter(|k| !dropped.contains(k)).map(|k| fit.poles[k]).collect();
        fit = Fit::new(samples, left).ok_or_else(unsolvable)?;
    }
    let certainty = fit.certainty(samples.len()).ok_or_else(unsolvable)?;
    let floors = floors(&fit, samples, sample_rate);
    if progress(1.0) { Ok(Found { fit, certainty, floors }) } else { Err(Error::Interrupted) }
}

/// Average energy that noise explains for each mode.
fn floors(fit: &Fit, samples: &[f64], sample_rate: f64) -> Vec<f64> {
    let spectra = Spectra::new(&fit.residual(samples), sample_rate);
    fit.poles.iter().map(|pole| spectra.floor(*pole)).collect()
}

/// Which bands are resolved into poles anew.
enum Where {
    /// Those in which more than so much energy stands out of what the modes leave.
    StandsOut(f64),
    /// That of every mode, which may be two that are hard to tell apart.
    Modes,
}

/// The poles of a fit together with those of bands that are resolved anew; none if nothing stands out.
fn resolve(fit: &Fit, samples: &[f64], sample_rate: f64, most_modes: usize, place: Where) -> Vec<Pole> {
    let range = (2.0 * PI * LOWEST / sample_rate, HIGHEST * PI);
    let residual = fit.residual(samples);
    let reach = |pole: Pole| band(pole, samples.len()).half_width();
    let candidates: Vec<Pole> = match place {
        Where::StandsOut(least) => {
            let spectra = Spectra::new(&residual, sample_rate);
            let strongest = spectra.strongest(DETECTION, least, range);
            let mut candidates = spectra.candidates(DETECTION, least.max(ROUND_SPAN * strongest), range, reach);
            candidates.truncate(most_modes.saturating_sub(fit.poles.len()));
            candidates.into_iter().map(|candidate| candidate.pole).collect()
        }
        Where::Modes => fit.poles.clone(),
    };
    let split = matches!(place, Where::Modes);
    let mut known: Vec<(Pole, bool)> = fit.poles.iter().map(|pole| (*pole, true)).collect();
    let mut amplitudes = fit.amplitudes.clone();
    for candidate in candidates {
        if known.len() >= most_modes {
            break;
        }
        // A band that was resolved anew already has this mode, too.
        if split && !known.contains(&(candidate, true)) {
            continue;
        }
        let band = band(candidate, samples.len());
        let within = |pole: Pole| (pole.theta - candidate.theta).abs() < band.half_width();
        let members: Vec<usize> = (0..known.len()).filter(|k| known[*k].1 && within(known[*k].0)).collect();
        let mut mixed = residual[..band.reach().min(residual.len())].to_vec();
        members.iter().for_each(|k| add(&mut mixed, known[*k].0, amplitudes[*k], 1.0));
        let mut poles = band.poles(&mixed);
        poles.retain(|pole| (range.0..=range.1).contains(&pole.theta));
        let resolved = poles.len() > members.len();
        if resolved {
            members.iter().rev().for_each(|k| {
                known.remove(*k);
                amplitudes.remove(*k);
            });
            known.extend(poles.iter().map(|pole| (*pole, false)));
        }
        // The order of a band may be too low for a faint mode beside strong ones, or a short one beside long ones.
        let width = candidate.width(samples.len());
        let met = |pole: &Pole| (pole.theta - candidate.theta).abs() < width;
        let has_pole = split || resolved && poles.iter().any(met);
        if !has_pole {
            known.push((candidate, false));
        }
        amplitudes.resize(known.len(), Default::default());
    }
    if !split && known.iter().all(|(_, before)| *before) {
        return Vec::new();
    }
    known.truncate(most_modes);
    apart(known.into_iter().map(|(pole, _)| pole), samples.len())
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
