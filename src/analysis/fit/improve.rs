//! Fits a draft to one take: first its modes, then a bed, then corrections.

use super::audition::{Audition, Played};
use super::bed::Lines;
use super::draft::{Draft, Partial, longest_t60};
use super::drift::Drift;
use super::movement::{Sweep, Swell};
use super::refine::{Listener, NEAR_DB};
use super::start::Source;
use super::take::{Prepared, SLOW};
use super::{bed, bursts, held, noise, start, sway, sweep};
use crate::analysis::log_mel::{self, HOP, RATE};
use crate::analysis::modes::Strike;
use crate::error::{Error, Result};

/// Share of the work until the first drafts are made.
const ANALYSED: f64 = 0.45;
/// Residual of the modes in dB above which noise alone may explain the sound better.
const NOISE_DB: f64 = -10.0;
/// Residual of the modes in dB below which they tell where the sound is damped.
const TELLS_DAMPER_DB: f64 = -25.0;
/// Residual of the modes in dB above which the sound may be moved by oscillators.
const SWAYS_DB: f64 = -20.0;
/// Share of a sound after which modes that noise has excited ring freely.
const LATE: f64 = 0.2;
/// Residual of the modes in dB below which the pitch counts as constant.
const EXPLAINED_DB: f64 = -50.0;
/// Modes found without the drift replace those of a held sound as it is if they lower the residual by this many dB.
const WORTH_A_DRIFT_DB: f64 = 6.0;
/// Reduction of the residual in dB by which a sweep is kept.
const WORTH_A_SWEEP_DB: f64 = 2.0;
/// Reduction of the distance in dB for which a bed is kept.
const WORTH_A_BED: f64 = 0.02;
/// Octaves within which a mode of a swept sound lies near a stronger one.
const BESIDE: f64 = 0.3;
/// Share of its length for which a sound rises that is not held by a key, and seconds of a fall from which the search for it begins.
const MOSTLY: f64 = 0.6;
const FALL: f64 = 0.1;
/// Share of the work on a draft of noise in which that is shaped.
const SHAPED: f64 = 0.4;
/// Seeds of the pans of the modes of two beds.
const SEEDS: [u64; 2] = [11, 12];
/// Rounds of corrections at a time.
const ROUNDS: usize = 8;

/// A draft with the strike that its modes were found in.
type Found = (Draft, Option<Strike>);

/// The draft of a take with at most `most` modes, and the strike that its modes were found in.
pub(super) fn fit(take: &mut Prepared, most: usize, progress: &mut dyn FnMut(f64) -> bool) -> Result<Found> {
    let found = drafts(take, most, &mut |share| {
        if progress(ANALYSED * share) { Ok(()) } else { Err(Error::Interrupted) }
    })?;
    let mut listener = Listener::new(take, progress);
    let (count, mut best, mut least) = (found.len() as f64, None, f64::INFINITY);
    for (n, (draft, strike)) in found.into_iter().enumerate() {
        let lines = match &strike {
            Some(strike) if draft.partials.iter().any(|partial| partial.struck) => Lines::new(&strike.residual),
            _ => Lines::new(&take.mean),
        };
        let part = |share: f64| ANALYSED + (1.0 - ANALYSED) * (n as f64 + share) / count;
        let is_shaped = draft.noise.is_audible();
        let (draft, from) = if is_shaped {
            let tell = |listener: &mut Listener, share: f64| listener.tell(part(SHAPED * share));
            listener.tell(part(0.0))?;
            (noise::shaped(draft, take, most, &mut listener, &tell)?, SHAPED)
        } else {
            (draft, 0.0)
        };
        let part = |share: f64| part(from + (1.0 - from) * share);
        let (draft, distance) = improved(draft, &mut listener, &lines, most, is_shaped, &part)?;
        if distance < least {
            (best, least) = (Some((draft, strike)), distance);
        }
        if least < NEAR_DB {
            break;
        }
    }
    listener.tell(1.0)?;
    best.ok_or(Error::Interrupted)
}

/// Of a take whose level rises until its key seems to be let go, the draft of a swell that falls by itself, and the take as a whole,
/// if that is nearer than a damper.
pub(super) fn fallen(
    take: &Prepared,
    draft: &Draft,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<(Prepared, Draft)>> {
    let Some((ending, swell)) = take.ending.as_ref().zip(draft.swell) else { return Ok(None) };
    if take.rise < MOSTLY * ending.release.seconds {
        return Ok(None);
    }
    let key = draft.key();
    let (damped, found) =
        ending.release.tuned(&draft.patch(), &ending.mean, (key, draft.velocity), &mut || progress(1.0))?;
    let whole = take.not_let_go();
    let mut listener = Listener::new(&whole, progress);
    listener.tell(1.0)?;
    let note = Played { key, velocity: draft.velocity, frames: whole.mean.len(), let_go: Some(found.frames()) };
    let let_go = log_mel::distance(&Audition::new().mean(&damped, note), &whole.mean);
    let shorter = |partial: &Partial| Partial { t60: partial.t60.min(longest_t60(false)), ..*partial };
    let mut other = Draft {
        partials: draft.partials.iter().map(shorter).collect(),
        swell: Some(Swell { fall: Some(FALL), ..swell }),
        is_held: false,
        ..draft.clone()
    };
    listener.choose_swell(&mut other)?;
    let distance = listener.correct(&mut other, ROUNDS)?;
    Ok((distance < let_go).then_some((whole, other)))
}

/// The possible drafts of a take: its modes, without a sweep and with each sweep that explains more, of which also those with a
/// single mode for each tone. If it is held or rises slowly, the modes without its drift; of a held sound these in place of the
/// others, if they explain much more and the others do not explain it. If it is damped while it rings, the take ends there. If its
/// modes explain little, also drafts of noise: the row of bursts with which it begins, noise that goes on for as long as the sound,
/// and modes that noise excites, found after the noise is over. If they leave much of it, also the modes without the movement of
/// oscillators. If the sound rises slowly, also modes found after the rise.
fn drafts(take: &mut Prepared, most: usize, tell: &mut dyn FnMut(f64) -> Result<()>) -> Result<Vec<Found>> {
    // Parts of the progress, one after the other. Parts of steps that are not needed are skipped.
    let [of_still, of_drift, of_search, first, second, of_noise, of_sway, of_rest] =
        [[0.0, 0.25], [0.25, 0.45], [0.45, 0.5], [0.5, 0.6], [0.6, 0.7], [0.7, 0.8], [0.8, 0.9], [0.9, 1.0]];
    let analysed = |take: &Prepared, source, [from, to]: [f64; 2], tell: &mut dyn FnMut(f64) -> Result<()>| {
        start::draft(take, source, most.div_ceil(2), &mut |share| tell(from + (to - from) * share).is_ok())
    };
    let all = Source { swept: Sweep::NONE, late: 0.0, struck: true };
    let mut found = vec![analysed(take, all, of_still, tell)?];
    // Modes that explain little do not tell whether something damps them.
    let strike = found[0].1.as_ref().filter(|strike| !take.is_held && strike.residual_db < TELLS_DAMPER_DB);
    if let Some(seconds) = strike.and_then(|strike| strike.damped) {
        take.end_at(seconds);
    }
    let still = residual_db(&found[0]);
    let mut drifts = false;
    if take.is_held || still > EXPLAINED_DB && take.rise > SLOW {
        let [from, to] = of_drift;
        let held = held::draft(take, None, most, &mut |share| tell(from + (to - from) * share).is_ok())?;
        if let Some(first) = held.first() {
            // What decays may have tones that end at different times, of which a residual tells little: let it be heard.
            // Modes that explain the sound may stay the nearest, however little the others leave.
            drifts = take.is_held && still > EXPLAINED_DB && residual_db(first) < still - WORTH_A_DRIFT_DB;
            if drifts {
                found.clear();
            }
            found.extend(held);
        }
    }
    if still > EXPLAINED_DB && !drifts {
        let sweeps = sweep::find(&take.mean, &mut || tell(of_search[0]))?;
        let mut swept = Vec::new();
        for (sweep, part) in sweeps.into_iter().zip([first, second]) {
            swept.push(analysed(take, Source { swept: sweep, ..all }, part, tell)?);
        }
        // The draft without a sweep is kept too: a wrong sweep can leave a smaller residual and still sound worse.
        swept.retain(|swept| residual_db(swept) < still - WORTH_A_SWEEP_DB);
        let sparse: Vec<Found> =
            swept.iter().filter_map(|(draft, strike)| Some((sparse(draft)?, strike.clone()))).collect();
        found.extend(swept.into_iter().chain(sparse));
        // Stable, so that a sparse draft comes after that with all modes.
        found.sort_by(|a, b| residual_db(a).total_cmp(&residual_db(b)));
    }
    let strike = found[0].1.clone();
    if still > NOISE_DB && !drifts {
        let empty = || start::from(take, None, &Source { struck: false, ..all }, false);
        found.extend(bursts::find(&take.mean).map(|noise| (Draft { noise, ..empty() }, strike.clone())));
        found.push((noise::lasting(take, most, empty()), strike.clone()));
        let late = Source { late: LATE * take.seconds(), struck: false, ..all };
        let (driven, _) = analysed(take, late, of_noise, tell)?;
        found.push((driven, strike.clone()));
    }
    if still > SWAYS_DB {
        let [from, to] = of_sway;
        found.extend(swayed(take, most, &mut |share| tell(from + (to - from) * share))?);
    }
    if take.rise > SLOW {
        let swept = found[0].0.sweep;
        let (rung, _) = analysed(take, Source { late: take.rise, swept, ..all }, of_rest, tell)?;
        found.push((rung, strike));
    }
    Ok(found)
}

/// A draft without the modes that lie near a stronger one; none if there are no such modes. Where a sweep is not quite that of the
/// sound, or tones decay at different rates, several modes that almost cancel stand for each tone. When they are played, they do not.
fn sparse(draft: &Draft) -> Option<Draft> {
    let mut partials = draft.partials.clone();
    let energy = |partial: &Partial| partial.amplitude * partial.amplitude * partial.t60;
    partials.sort_by(|a, b| energy(b).total_cmp(&energy(a)));
    let mut kept: Vec<Partial> = Vec::new();
    for partial in partials {
        let is_far = |other: &Partial| libm::fabs(libm::log2(partial.frequency / other.frequency)) > BESIDE;
        if kept.iter().all(is_far) {
            kept.push(partial);
        }
    }
    (kept.len() < draft.partials.len()).then(|| Draft { partials: kept, ..draft.clone() })
}

/// Drafts of a sound that oscillators move: the modes of the sound without that; none if it does not move regularly.
fn swayed(take: &Prepared, most: usize, tell: &mut dyn FnMut(f64) -> Result<()>) -> Result<Vec<Found>> {
    let (oscillators, swept) = sway::find(take, &mut || tell(0.0))?;
    if oscillators.is_empty() {
        return Ok(Vec::new());
    }
    let drift = Drift::by(&oscillators, swept.envelope(), take.mean.len());
    let still = take.replaced(take.channels.iter().map(|channel| drift.removed_from(channel)).collect());
    let mut found = held::draft(&still, Some(swept), most, &mut |share| tell(share).is_ok())?;
    if found.iter().all(|held| residual_db(held) > NOISE_DB) {
        // Noise that moves so is left to the bed.
        found.push((start::from(take, None, &Source { swept, late: 0.0, struck: false }, false), None));
    }
    let swayed = |(draft, strike)| (Draft { oscillators: oscillators.clone(), ..draft }, strike);
    Ok(found.into_iter().map(swayed).collect())
}

/// The residual of a strike in dB.
fn residual_db((_, strike): &Found) -> f64 {
    strike.as_ref().map_or(0.0, |strike| strike.residual_db)
}

/// The draft with a bed, and corrected until it hardly comes nearer, and its distance. Noise that is shaped already stays as it is.
fn improved(
    mut draft: Draft,
    listener: &mut Listener,
    lines: &Lines,
    most: usize,
    is_shaped: bool,
    part: &dyn Fn(f64) -> f64,
) -> Result<(Draft, f64)> {
    let slow = listener.take.rise > SLOW;
    listener.tell(part(0.0))?;
    listener.choose_oscillators(&mut draft)?;
    if slow {
        listener.choose_swell(&mut draft)?;
    }
    listener.choose_hardness(&mut draft)?;
    listener.tell(part(0.3))?;
    // Two passes, so that a sound that decays in two stages gets two beds.
    for (pass, seed) in [(1.0, SEEDS[0]), (2.0, SEEDS[1])] {
        let heard = listener.hear(&draft)?;
        let room = most.saturating_sub(draft.partials.len());
        // Before the last burst, a band does not decay.
        let from = (draft.noise.last() * f64::from(RATE)) as usize / HOP;
        let [wanted, heard] = [&listener.target, &heard].map(|bands| bands.skipping(from));
        let more = bed::bed([&wanted, &heard], lines, &draft.sweep, room, seed);
        if more.is_empty() && draft.partials.is_empty() {
            break;
        }
        let (mut least, mut noise) = (listener.distance(&draft, usize::MAX)? - WORTH_A_BED, None);
        let mut with_bed = draft.clone();
        with_bed.partials.extend(more);
        let mut alternating = with_bed.clone();
        bed::alternate(&mut alternating.partials);
        // The same draft twice if nothing alternates.
        let is_other = alternating != with_bed;
        for mut other in [Some(alternating), is_other.then_some(with_bed)].into_iter().flatten() {
            match noise {
                // Choosing it anew brought nothing: twenty presets came 0.00 dB nearer in the mean.
                Some(noise) => other.noise = noise,
                None if !is_shaped => listener.choose_noise(&mut other)?,
                None => (),
            }
            noise = Some(other.noise);
            let distance = listener.correct(&mut other, ROUNDS)?;
            if distance < least {
                (draft, least) = (other, distance);
            }
        }
        listener.tell(part(0.3 + 0.2 * pass))?;
    }
    listener.correct(&mut draft, ROUNDS)?;
    if slow {
        listener.choose_swell(&mut draft)?;
    }
    listener.choose_oscillators(&mut draft)?;
    listener.choose_hardness(&mut draft)?;
    listener.shape_noise(&mut draft)?;
    listener.choose_sweep(&mut draft)?;
    let distance = listener.correct(&mut draft, ROUNDS)?;
    listener.tell(part(1.0))?;
    Ok((draft, distance))
}

#[cfg(test)]
mod tests {
    use super::super::correct;
    use super::super::take::tests::prepared;
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_sparse_draft_has_one_mode_for_each_tone() {
        let mode =
            |frequency, amplitude| Partial { frequency, t60: 0.5, amplitude, phase: 0.0, pan: 0.0, struck: true };
        let mut draft = correct::tests::draft([0.0; 2]);
        draft.partials = vec![mode(95.0, 0.1), mode(100.0, -0.4), mode(160.0, 0.05), mode(101.0, 0.3)];
        let found = sparse(&draft).unwrap();
        assert_eq!(found.partials, [mode(100.0, -0.4), mode(160.0, 0.05)]);
        assert_eq!(sparse(&found), None);
    }

    #[test]
    fn a_vibrato_that_modes_explain_is_found_as_one() {
        let mut turn = 0.0;
        let mut sample = |n: usize| {
            let semitones = 0.15 * libm::sin(TAU * 5.5 * n as f64 / f64::from(RATE));
            turn += TAU * 523.0 * libm::exp2(semitones / 12.0) / f64::from(RATE);
            (0.3 * libm::sin(turn) + 0.02 * libm::sin(2.0 * turn)) as f32
        };
        let sound = (0..RATE as usize).map(&mut sample).collect();
        let mut take = prepared(sound, RATE);
        let found = drafts(&mut take, 60, &mut |_| Ok(())).unwrap();
        let is_found = |(draft, _): &Found| {
            let vibrato = draft.sweep.vibrato;
            (vibrato.semitones - 0.15).abs() < 0.03 && (vibrato.rate - 5.5).abs() < 0.2
        };
        assert!(found.iter().any(is_found), "{:?}", found.iter().map(|(draft, _)| draft.sweep).collect::<Vec<_>>());
    }
}
