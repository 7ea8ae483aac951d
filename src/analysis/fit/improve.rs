//! One take becomes a draft: its modes, then a bed, then corrections.

use super::draft::Draft;
use super::refine::Listener;
use super::take::Prepared;
use super::{bed, start, sweep};
use crate::analysis::modes::Strike;
use crate::error::{Error, Result};

/// Shares of the work until the sweep and the modes are known.
const SEARCH: f64 = 0.15;
const ANALYSIS: f64 = 0.6;
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
    let sweep = sweep::find(&take.mean);
    tell(SEARCH)?;
    let mut listener = Listener::new(take);
    let count = most.div_ceil(2);
    let part = |from: f64, to: f64, share: f64| from + (to - from) * share;
    let middle = if sweep.semitones == 0.0 { ANALYSIS } else { 0.5 * (SEARCH + ANALYSIS) };
    let (mut draft, mut strike) =
        start::draft(take, sweep, count, &mut |share| tell(part(SEARCH, middle, share)).is_ok())?;
    if sweep.semitones != 0.0 {
        // What was found with a better sweep is better, too.
        listener.choose_hardness(&mut draft);
        listener.choose_sweep(&mut draft);
        let (mut other, other_strike) =
            start::draft(take, draft.sweep, count, &mut |share| tell(part(middle, ANALYSIS, share)).is_ok())?;
        listener.choose_hardness(&mut other);
        if listener.distance(&other, usize::MAX) < listener.distance(&draft, usize::MAX) {
            (draft, strike) = (other, other_strike);
        }
    }
    let draft = improved(draft, &mut listener, most, &mut |share| tell(part(ANALYSIS, 1.0, share)))?;
    Ok((draft, strike))
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
