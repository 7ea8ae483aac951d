//! The possible drafts of a take: what its modes may be, and what may move and excite them.

use super::draft::Draft;
use super::drift::Drift;
use super::movement::Sweep;
use super::prepared::{Prepared, SLOW};
use super::start::{Found, Source};
use super::{held, oscillators, start, sweep};
use crate::error::Result;

/// Residual of the modes in dB above which noise may excite them.
const NOISE_DB: f64 = -10.0;
/// Residual of the modes in dB below which they tell where the sound is damped.
const TELLS_DAMPER_DB: f64 = -25.0;
/// Residual of the modes in dB above which the sound may be moved by oscillators. If these leave less of a held sound that modes alone
/// hardly explain, nothing else moves or excites it: wrong sweeps and noise would take most of the time of a fit.
const SWAYS_DB: f64 = -20.0;
/// Share of a sound after which modes that noise has excited ring freely.
const LATE: f64 = 0.2;
/// Residual of the modes in dB below which the pitch counts as constant.
const EXPLAINED_DB: f64 = -50.0;
/// Modes found without the drift replace those of a held sound as it is if they lower the residual by this many dB.
const WORTH_A_DRIFT_DB: f64 = 6.0;
/// Reduction of the residual in dB by which a sweep is kept.
const WORTH_A_SWEEP_DB: f64 = 2.0;

/// The possible drafts of a take. If it is damped while it rings, it ends there.
///
/// * Its modes.
/// * If it is held, or rises slowly and its modes do not explain it: the modes without its drift. Of a held sound they replace the first
///   ones if they explain much more.
/// * If its modes leave much of it: the modes without the movement of oscillators. If these explain a held sound that modes
///   alone do not, the next two are left out.
/// * Unless its modes explain it: those of each sweep that explains more.
/// * If its modes explain little: modes that noise excites, found after the noise is over.
pub(super) fn of(take: &mut Prepared, most: usize, tell: &mut dyn FnMut(f64) -> Result<()>) -> Result<Vec<Found>> {
    // Parts of the progress, one after the other. Parts of steps that are not needed are skipped.
    let [of_still, of_drift, of_modulated, of_search, first, second, of_noise] =
        [[0.0, 0.3], [0.3, 0.5], [0.5, 0.55], [0.55, 0.6], [0.6, 0.75], [0.75, 0.9], [0.9, 1.0]];
    let analysed = |take: &Prepared, source, part, tell: &mut dyn FnMut(f64) -> Result<()>| {
        start::draft(take, source, most.div_ceil(2), &mut within(part, tell))
    };
    let all = Source { swept: Sweep::NONE, late: 0.0, struck: true };
    let mut found = vec![analysed(take, all, of_still, tell)?];
    // Modes that explain little do not tell whether something damps them.
    let strike = found[0].1.as_ref().filter(|strike| !take.is_held && strike.residual_db < TELLS_DAMPER_DB);
    if let Some(seconds) = strike.and_then(|strike| strike.damped) {
        take.end_at(seconds);
    }
    let still = residual_db(&found[0]);
    let is_explained = still <= EXPLAINED_DB;
    let mut drifts = false;
    if take.is_held || !is_explained && take.rise > SLOW {
        let held = held::draft(take, None, most, &mut within(of_drift, tell))?;
        if let Some(held) = held {
            // What decays may have tones that end at different times, of which a residual tells little: let it be heard.
            // Modes that explain the sound may stay the nearest, however little the others leave.
            drifts = take.is_held && !is_explained && residual_db(&held) < still - WORTH_A_DRIFT_DB;
            if drifts {
                found.clear();
            }
            found.push(held);
        }
    }
    let modulated = if still > SWAYS_DB { modulated(take, most, &mut within(of_modulated, tell))? } else { None };
    // As of a drift: the residual of what decays tells little.
    let sways =
        take.is_held && still > NOISE_DB && modulated.as_ref().is_some_and(|found| residual_db(found) < SWAYS_DB);
    if !is_explained && !drifts && !sways {
        let sweeps = sweep::find(&take.mean, &mut || tell(of_search[0]))?;
        let mut swept = Vec::new();
        for (sweep, part) in sweeps.into_iter().zip([first, second]) {
            swept.push(analysed(take, Source { swept: sweep, ..all }, part, tell)?);
        }
        // The draft without a sweep is kept too: a wrong sweep can leave a smaller residual and still sound worse.
        swept.retain(|swept| residual_db(swept) < still - WORTH_A_SWEEP_DB);
        found.append(&mut swept);
        found.sort_by(|a, b| residual_db(a).total_cmp(&residual_db(b)));
    }
    if still > NOISE_DB && !drifts && !sways {
        let late = Source { late: LATE * take.seconds(), struck: false, ..all };
        let (driven, _) = analysed(take, late, of_noise, tell)?;
        found.push((driven, found[0].1.clone()));
    }
    found.extend(modulated);
    Ok(found)
}

/// Tells the share of a part of the work as that of all; false if the work is to end.
fn within([from, to]: [f64; 2], tell: &mut dyn FnMut(f64) -> Result<()>) -> impl FnMut(f64) -> bool {
    move |share| tell(from + (to - from) * share).is_ok()
}

/// The draft of a sound that oscillators move: the modes of the sound without that; none if it does not move regularly.
fn modulated(take: &Prepared, most: usize, tell: &mut dyn FnMut(f64) -> bool) -> Result<Option<Found>> {
    let (oscillators, swept) = oscillators::find(take, &mut || tell(0.0))?;
    if oscillators.is_empty() {
        return Ok(None);
    }
    let drift = Drift::by(&oscillators, swept.envelope(), take.mean.len());
    let still = take.replaced(take.channels.iter().map(|channel| drift.removed_from(channel)).collect());
    let found = held::draft(&still, Some(swept), most, tell)?;
    Ok(found.map(|(draft, strike)| (Draft { oscillators, ..draft }, strike)))
}

/// The residual of a strike in dB.
fn residual_db((_, strike): &Found) -> f64 {
    strike.as_ref().map_or(0.0, |strike| strike.residual_db)
}

#[cfg(test)]
mod tests {
    use super::super::prepared::tests::prepared;
    use super::*;
    use crate::analysis::log_mel::RATE;
    use std::f64::consts::TAU;

    #[test]
    #[ignore = "takes seconds"]
    fn a_vibrato_that_modes_explain_is_found_as_one() {
        let mut turn = 0.0;
        let mut sample = |n: usize| {
            let semitones = 0.15 * libm::sin(TAU * 5.5 * n as f64 / f64::from(RATE));
            turn += TAU * 523.0 * libm::exp2(semitones / 12.0) / f64::from(RATE);
            (0.3 * libm::sin(turn) + 0.02 * libm::sin(2.0 * turn)) as f32
        };
        let sound = (0..RATE as usize).map(&mut sample).collect();
        let mut take = prepared(sound, RATE);
        let found = of(&mut take, 60, &mut |_| Ok(())).unwrap();
        let is_found = |(draft, _): &Found| {
            let vibrato = draft.sweep.vibrato;
            (vibrato.semitones - 0.15).abs() < 0.03 && (vibrato.rate - 5.5).abs() < 0.2
        };
        assert!(found.iter().any(is_found), "{:?}", found.iter().map(|(draft, _)| draft.sweep).collect::<Vec<_>>());
    }
}
