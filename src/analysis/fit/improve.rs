//! One take becomes a draft: its modes, then a bed, then corrections.

use super::draft::{Draft, Sweep};
use super::refine::Listener;
use super::take::Prepared;
use super::{bed, start, sweep};
use crate::analysis::modes::Strike;
use crate::error::{Error, Result};

/// Share of the work until a sweep is found.
const SEARCH: f64 = 0.15;
/// Residual of the modes in dB below which they explain the sound, and so the sweep that was taken out is one.
const EXPLAINS_DB: f64 = -6.0;
/// What a bed has to gain in dB to be kept.
const WORTH_A_BED: f64 = 0.02;
/// Rounds of corrections at a time.
const ROUNDS: usize = 8;

/// The draft of a take with at most `most` modes, and the strike that its modes were found in.
pub(super) fn fit(
    take: &Prepared,
    most: usize,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<(Draft, Option<Strike>)> {
    let mut tell = |share: f64| if progress(share) { Ok(()) } else { Err(Error::Interrupted) };
    let swept = sweep::find(&take.mean);
    tell(SEARCH)?;
    let mut listener = Listener::new(take);
    let mut drafts = Vec::new();
    if swept.semitones != 0.0 {
        let (mut draft, strike) = analysed(take, swept, most, [SEARCH, 0.3], &mut tell)?;
        if strike.as_ref().is_some_and(|strike| strike.residual_db < EXPLAINS_DB) {
            drafts.push((draft.clone(), strike));
            // What was found with a better sweep may be better, too.
            listener.choose_hardness(&mut draft);
            listener.choose_sweep(&mut draft);
            drafts.push(analysed(take, draft.sweep, most, [0.3, 0.45], &mut tell)?);
        }
    }
    if drafts.is_empty() {
        drafts.push(analysed(take, Sweep::NONE, most, [SEARCH, 0.45], &mut tell)?);
    }
    let (count, mut best, mut least) = (drafts.len() as f64, None, f64::INFINITY);
    for (n, (draft, strike)) in drafts.into_iter().enumerate() {
        let part = |share: f64| 0.45 + 0.55 * (n as f64 + share) / count;
        let draft = improved(draft, &mut listener, most, &mut |share| tell(part(share)))?;
        let distance = listener.distance(&draft, usize::MAX);
        if distance < least {
            (best, least) = (Some((draft, strike)), distance);
        }
    }
    best.ok_or(Error::Interrupted)
}

/// The draft of a take's modes alone, as [`start::draft`], which is from one share of the work to another.
fn analysed(
    take: &Prepared,
    sweep: Sweep,
    most: usize,
    [from, to]: [f64; 2],
    tell: &mut dyn FnMut(f64) -> Result<()>,
) -> Result<(Draft, Option<Strike>)> {
    start::draft(take, sweep, most.div_ceil(2), &mut |share| tell(from + (to - from) * share).is_ok())
}

fn improved(
    mut draft: Draft,
    listener: &mut Listener,
    most: usize,
    tell: &mut dyn FnMut(f64) -> Result<()>,
) -> Result<Draft> {
    listener.choose_hardness(&mut draft);
    tell(0.2)?;
    listener.choose_sweep(&mut draft);
    tell(0.3)?;
    // Twice: what decays in two stages gets two beds.
    for (pass, seed) in [(1.0, 11), (2.0, 12)] {
        let heard = listener.hear(&draft);
        let room = most.saturating_sub(draft.partials.len());
        let mut other = draft.clone();
        other.partials.extend(bed::bed(&listener.target, &heard, &draft.sweep, room, seed));
        if other.partials.is_empty() {
            break;
        }
        listener.choose_noise(&mut other);
        listener.correct(&mut other, ROUNDS);
        if listener.distance(&other, usize::MAX) < listener.distance(&draft, usize::MAX) - WORTH_A_BED {
            draft = other;
        }
        tell(0.3 + 0.2 * pass)?;
    }
    listener.correct(&mut draft, ROUNDS);
    listener.choose_hardness(&mut draft);
    listener.choose_sweep(&mut draft);
    listener.correct(&mut draft, ROUNDS);
    tell(1.0)?;
    Ok(draft)
}
