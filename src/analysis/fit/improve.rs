//! Fits a draft to one take: first its modes, then a bed, then corrections.

use super::audition::{Audition, Played};
use super::bed::Lines;
use super::draft::{Draft, Partial, longest_t60};
use super::movement::Swell;
use super::prepared::{Prepared, SLOW};
use super::refine::{Listener, NEAR_DB};
use super::start::Found;
use super::{bed, candidates};
use crate::analysis::log_mel;
use crate::error::{Error, Result};

/// Share of the work until the first drafts are made.
const ANALYSED: f64 = 0.45;
/// Reduction of the distance in dB for which a bed is kept.
const WORTH_A_BED: f64 = 0.02;
/// Share of its length for which a sound rises that is not held by a key, and seconds of a fall from which the search for it begins.
const MOSTLY: f64 = 0.6;
const FALL: f64 = 0.1;
/// Most rounds in which the swell and the levels are found in turn, and reduction of the distance in dB for which there is another one.
const SWELL_ROUNDS: usize = 3;
const WORTH_A_ROUND: f64 = 0.01;
/// Seeds of the pans of the modes of two beds.
const SEEDS: [u64; 2] = [11, 12];
/// Rounds of corrections at a time.
const ROUNDS: usize = 8;

/// The draft of a take with at most `most` modes, and the strike that its modes were found in.
pub(super) fn fit(take: &mut Prepared, most: usize, progress: &mut dyn FnMut(f64) -> bool) -> Result<Found> {
    let found = candidates::of(take, most, &mut |share| {
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
        let (draft, distance) = improved(draft, &mut listener, &lines, most, &part)?;
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
    let mut distance = f64::INFINITY;
    // The best swell depends on the levels, and these on the swell.
    for _ in 0..SWELL_ROUNDS {
        let before = distance;
        listener.choose_swell(&mut other)?;
        distance = listener.correct(&mut other, ROUNDS)?;
        if distance > before - WORTH_A_ROUND {
            break;
        }
    }
    Ok((distance < let_go).then_some((whole, other)))
}

/// The draft with a bed, and corrected until it hardly comes nearer, and its distance.
fn improved(
    mut draft: Draft,
    listener: &mut Listener,
    lines: &Lines,
    most: usize,
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
        let more = bed::bed([&listener.target, &heard], lines, &draft.sweep, room, seed);
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
                None => listener.choose_noise(&mut other)?,
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
    let distance = listener.correct(&mut draft, ROUNDS)?;
    listener.tell(part(1.0))?;
    Ok((draft, distance))
}
