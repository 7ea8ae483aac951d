//! Searches for modes, round by round.
//!
//! Peaks that stand out of the residual are resolved into poles. These are fitted together with all others, and kept if
//! they explain more than noise would.

use super::detect::Spectra;
use super::fit::{Certainty, Fit};
use super::plausible::{Limits, implausible};
use super::prune::{join, prune};
use super::resolve::{Where, resolve};
use crate::analysis::level;
use crate::error::{Error, Result};
use sprung_fourier::Planner;

/// Least share of the sound's energy that counts: rounding to single precision leaves as much.
const LEAST_SHARE: f64 = 1e-13;

/// Least share of the unexplained energy that a round must explain.
const LEAST_GAIN: f64 = 1e-4;
/// The same share where all modes that are allowed explain nothing. It falls in proportion to the number of modes and to what they
/// leave. More modes always explain a little more of noise, which means nothing.
const GAIN_OF_NOISE: f64 = 0.05;

const MOST_ROUNDS: usize = 24;
/// Rounds without progress after which a sound counts as no sum of modes. When modes are resolved again with their
/// neighbours, a round or two may bring no progress.
const PATIENCE: usize = 3;
/// Factor by which the unexplained energy may rise when all doubtful modes are dropped: 10 dB.
const MOST_LOST: f64 = 10.0;
/// How many times modes that the sound cannot have are dropped. The remaining modes may become implausible by this.
const MOST_REMOVALS: usize = 12;

/// The modes that were found, and their certainty.
pub(super) struct Found {
    pub(super) fit: Fit,
    pub(super) certainty: Certainty,
    /// Average energy that noise explains for each mode.
    pub(super) floors: Vec<f64>,
}

/// Finds the modes of a sound that begins with its first sample. `progress` is called with the share of the work that
/// is done, and cancels the search by returning `false`.
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
    let energy = level::energy(samples, 0.0);
    let least = LEAST_SHARE * energy;
    let planner = Planner::default();
    let pruned = |fit, go_on: &mut dyn FnMut() -> bool| prune(fit, samples, sample_rate, least, &planner, go_on);
    let floors = |fit: &Fit| floors(fit, samples, sample_rate, &planner);
    let least_gain = |fit: &Fit| {
        let noise = fit.unexplained / energy.max(f64::MIN_POSITIVE);
        let of_noise = GAIN_OF_NOISE * noise * fit.poles.len() as f64 / most_modes as f64;
        of_noise.max(LEAST_GAIN) * fit.unexplained + least
    };
    let mut fit = Fit::new(samples, Vec::new()).ok_or_else(unsolvable)?;
    let (mut best, mut idle, mut split) = (fit.clone(), 0, false);
    for round in 0..MOST_ROUNDS {
        let share = 0.9 * round as f64 / (round as f64 + 4.0);
        if !progress(share) {
            return Err(Error::Interrupted);
        }
        let mut go_on = || progress(share);
        let place = if split { Where::Modes } else { Where::StandsOut(least) };
        let poles = resolve(&fit, samples, sample_rate, most_modes, place, &planner);
        let next = if split {
            // A mode that is hidden by another explains nothing before it is refined.
            Fit::new(samples, poles).map(|fit| fit.refine(samples, 1e-2, 8, &mut go_on))
        } else if poles.is_empty() || idle == PATIENCE {
            // Inaccurate modes leave more energy than hidden ones, so refine first.
            (best, idle, split) = (best.refine(samples, 1e-7, 40, &mut go_on), 0, true);
            let Some(refined) = pruned(best.clone(), &mut go_on) else { break };
            (fit, best) = (refined.clone(), refined);
            continue;
        } else {
            // Before they are refined, modes that are denser than their bandwidths seem useless.
            let next = Fit::new(samples, poles).map(|fit| fit.refine(samples, 1e-2, 8, &mut go_on));
            let next = next.and_then(|fit| pruned(fit, &mut go_on));
            next.map(|fit| fit.refine(samples, 1e-2, 5, &mut go_on))
        };
        // Poles that almost coincide can make the equations unsolvable: then keep the best fit so far.
        let Some(next) = next.and_then(|fit| pruned(fit, &mut go_on)) else { break };
        // If a round changes nothing, later rounds would change nothing either.
        let stands =
            next.poles.len() == fit.poles.len() && (next.unexplained - fit.unexplained).abs() < least_gain(&fit);
        fit = next;
        let better = fit.unexplained < best.unexplained - least_gain(&best);
        if better {
            best = fit.clone();
        } else if split {
            break;
        }
        idle = match (better, stands) {
            (true, _) => 0,
            (false, true) => PATIENCE,
            (false, false) => idle + 1,
        };
        split = false;
    }
    fit = best;
    let mut share = 0.9;
    let mut go_on = || {
        share = (share + 0.002_f64).min(1.0);
        progress(share)
    };
    fit = fit.refine(samples, 1e-7, 40, &mut go_on);
    fit = pruned(fit.clone(), &mut go_on).unwrap_or(fit);
    fit = join(fit, samples, least, &mut go_on);
    // Modes that are denser than their bandwidths can all be uncertain, and yet explain the sound together. So if much is lost
    // without all doubtful ones, only the worst of each neighbourhood are dropped.
    let without = |fit: &Fit, floors: &[f64], rounds: usize, go_on: &mut dyn FnMut() -> bool| {
        let (certainty, mut worst_only) = (fit.certainty(samples.len()), false);
        loop {
            let dropped = implausible(fit, certainty.as_ref(), floors, samples.len(), limits, worst_only);
            if dropped.is_empty() {
                return Ok(None);
            }
            if !go_on() {
                return Err(Error::Interrupted);
            }
            let left = (0..fit.poles.len()).filter(|k| !dropped.contains(k)).map(|k| fit.poles[k]).collect();
            let next = Fit::new(samples, left).ok_or_else(unsolvable)?.refine(samples, 1e-7, rounds, go_on);
            if worst_only || next.unexplained < MOST_LOST * fit.unexplained + least {
                return Ok(Some(next));
            }
            worst_only = true;
        }
    };
    for _ in 0..MOST_REMOVALS {
        let Some(next) = without(&fit, &floors(&fit), 20, &mut go_on)? else { break };
        fit = next;
    }
    fit = fit.refine(samples, 1e-8, 20, &mut go_on);
    // Dropping a mode changes the others, which may then be implausible. So repeat this until no mode is.
    let floors = loop {
        let floors = floors(&fit);
        let Some(next) = without(&fit, &floors, 0, &mut go_on)? else { break floors };
        fit = next;
    };
    let certainty = fit.certainty(samples.len()).ok_or_else(unsolvable)?;
    if progress(1.0) { Ok(Found { fit, certainty, floors }) } else { Err(Error::Interrupted) }
}

/// Average energy that noise explains for each mode.
fn floors(fit: &Fit, samples: &[f64], sample_rate: f64, planner: &Planner) -> Vec<f64> {
    let spectra = Spectra::new(&fit.residual(samples), sample_rate, planner);
    fit.poles.iter().map(|pole| spectra.floor(*pole)).collect()
}
