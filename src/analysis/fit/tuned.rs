//! Tunes a body's strike, pickup, tilt, losses and mallet until it sounds most like the recording.
//!
//! The modes of a recording show where a body is struck and how it loses energy, but only those modes that were found,
//! and one by one. Here the whole sound is compared.

use super::audition::{Audition, Played};
use super::body;
use super::draft::{Draft, digits};
use super::levels::Levels;
use super::prepared::Prepared;
use super::simplex;
use crate::analysis::level::{dbfs, rms};
use crate::analysis::log_mel::{MelBands, from_onset};
use crate::error::{Error, Result};
use crate::params::{Choice, MalletPulse, Param};
use crate::patch::Patch;
use crate::sound::bodies::{Body, Loss, Point};
use crate::units::gain_from_db;
use libm::exp;

/// Number of steps in which hardnesses of the mallet are tried, and how many of the best the search starts from. From a
/// wrong hardness, the search does not reach the right one.
const HARDNESSES: u32 = 20;
const STARTS: usize = 3;
/// Steps of the search from each start.
const STEPS: usize = 120;
/// dB of distance that are as bad as a deviation of the modes' levels by 1 dB.
const WORTH_OF_LEVELS: f64 = 2.0;
/// Tilt in dB per octave per unit of the search.
const TILT: f64 = 15.0;
/// Least and greatest tilt.
const TILTS: (f64, f64) = (-24.0, 24.0);

/// The patch of a body with the strike, pickup, tilt, losses and mallet that bring it nearest to a take, played on a
/// fractional MIDI key. The deviation of its modes from their levels in the recording counts too. `progress` is called
/// with the share of the work that is done.
///
/// # Errors
/// [`Error::Interrupted`] if `progress` returns `false`.
pub(super) fn patch(
    draft: &Draft,
    body: &Body,
    levels: &Levels,
    take: &Prepared,
    key: f64,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Patch> {
    let (mut audition, mut bands) = (Audition::new(), MelBands::new());
    let recording = from_onset(&take.mean);
    let (target, amplitudes) = (bands.measure(recording), levels.amplitudes_in(recording));
    let note = Played { key, velocity: draft.velocity, frames: take.mean.len(), let_go: None };
    let mut heard = |body: &Body, patch: &mut Patch| {
        let mut played = audition.mean(patch, note);
        // Make it as loud as the recording.
        let before = f64::from(patch.get(Param::Gain));
        let more = dbfs(rms(&take.mean)) - dbfs(rms(&played));
        let gain = Param::Gain.info().clamp((before + (100.0 * more).round() / 100.0) as f32);
        patch.set(Param::Gain, gain);
        let factor = gain_from_db(f64::from(gain) - before) as f32;
        played.iter_mut().for_each(|sample| *sample *= factor);
        let played = from_onset(&played);
        bands.measure(played).distance(&target) + WORTH_OF_LEVELS * levels.off_db(body, &amplitudes, played)
    };
    let grid: Vec<f64> = (1..HARDNESSES).map(|step| f64::from(step) / f64::from(HARDNESSES)).collect();
    let hardnesses: Vec<Option<f64>> = grid.iter().copied().map(Some).collect();
    let placed = levels.placed(body, &hardnesses);
    let mut starts: Vec<(f64, f64, Body)> =
        placed.into_iter().zip(grid).map(|((off, body), hardness)| (off, hardness, body)).collect();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    starts.truncate(STARTS);
    let mut best = (f64::INFINITY, draft.patch());
    // A step of the simplex mostly tries one or two places.
    let most = (starts.len() * 2 * STEPS) as f64;
    let mut tried = 0.0;
    for (_, hardness, body) in starts {
        let mut error = |place: [f64; 6]| {
            tried += 1.0;
            if !progress((tried / most).min(1.0)) {
                return Err(Error::Interrupted);
            }
            let (body, hardness) = moved(&body, hardness, place);
            let mut patch = struck(draft, &body, hardness);
            Ok((heard(&body, &mut patch), patch))
        };
        let (place, _) = simplex::least(STEPS, |place| Ok(error(place)?.0))?;
        let found = error(place)?;
        if found.0 < best.0 {
            best = found;
        }
    }
    Ok(best.1)
}

/// A body with changed strike and pickup positions, tilt and losses, and a changed hardness.
fn moved(body: &Body, hardness: f64, [strike, pickup, tilt, b0, b1, harder]: [f64; 6]) -> (Body, f64) {
    let mut body = body.clone();
    let at = |point: Point, by: f64| Point { x: digits((point.x + by).clamp(0.02, 0.98), 3), ..point };
    (body.strike, body.pickup) = (at(body.strike, strike), at(body.pickup, pickup));
    body.tilt = digits((body.tilt + TILT * tilt).clamp(TILTS.0, TILTS.1), 3);
    let loss = body.material.loss;
    body.material.loss =
        Loss { b0: digits(loss.b0 * exp(2.0 * b0), 4), b1: digits(loss.b1 * exp(2.0 * b1), 4), ..loss };
    (body, (1000.0 * (hardness + harder).clamp(0.0, 1.0)).round() / 1000.0)
}

/// The patch of a body that is struck by a mallet of some hardness.
fn struck(draft: &Draft, body: &Body, hardness: f64) -> Patch {
    let mut patch = body::patch(draft, body);
    patch.set(Param::MalletPulse, MalletPulse::Contact.value());
    patch.set(Param::MalletHardness, (100.0 * hardness) as f32);
    patch
}
