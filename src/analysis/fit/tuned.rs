//! A body's levels and decays, moved to where it sounds most like the recording.
//!
//! The modes of a recording say where a body is struck and how it loses energy, but only as far as they were found, and one after
//! the other. What is heard is all of it together.

use super::audition::Audition;
use super::body;
use super::draft::{Draft, digits};
use super::simplex;
use super::take::Prepared;
use crate::analysis::level::{dbfs, rms};
use crate::analysis::log_mel::{MelBands, from_onset};
use crate::params::{Choice, MalletPulse, Param};
use crate::patch::Patch;
use crate::sound::bodies::{Body, Loss, Point};
use crate::units::gain_from_db;
use libm::exp;

/// Hardnesses of the mallet, 0–1, from which the search begins: it would not leave the slope of a wrong one.
const HARDNESSES: [f64; 3] = [0.4, 0.65, 0.9];
/// Steps of the search from each.
const STEPS: usize = 40;
/// By how much the first step moves the tilt in dB per octave; the others are shares.
const TILT: f64 = 15.0;
/// Least and greatest tilt.
const TILTS: (f64, f64) = (-24.0, 24.0);

/// The patch of a body, played on a fractional MIDI key, struck so, with such losses and such a mallet, that it is nearest to a take.
pub(super) fn patch(draft: &Draft, body: &Body, take: &Prepared, key: f64) -> Patch {
    let (mut audition, mut bands) = (Audition::new(), MelBands::new());
    let target = bands.measure(from_onset(&take.mean));
    let mut heard = |patch: &mut Patch| {
        let mut played = audition.mean(patch, key, draft.velocity, take.mean.len());
        // As loud as the recording.
        let before = f64::from(patch.get(Param::Gain));
        let more = dbfs(rms(&take.mean)) - dbfs(rms(&played));
        let gain = Param::Gain.info().clamp((before + (100.0 * more).round() / 100.0) as f32);
        patch.set(Param::Gain, gain);
        let factor = gain_from_db(f64::from(gain) - before) as f32;
        played.iter_mut().for_each(|sample| *sample *= factor);
        bands.measure(from_onset(&played)).distance(&target)
    };
    let mut best = (f64::INFINITY, draft.patch());
    for hardness in draft.hardness.into_iter().chain(HARDNESSES) {
        let at = |place: [f64; 5]| moved(draft, body, hardness, place);
        let (place, _) = simplex::least(STEPS, |place| heard(&mut at(place)));
        let mut found = at(place);
        let distance = heard(&mut found);
        if distance < best.0 {
            best = (distance, found);
        }
    }
    best.1
}

/// The patch of a body with its place of striking, tilt, losses and mallet moved.
fn moved(draft: &Draft, body: &Body, hardness: f64, [place, tilt, b0, b1, harder]: [f64; 5]) -> Patch {
    let mut body = body.clone();
    body.strike = Point { x: digits((body.strike.x + place).clamp(0.02, 0.98), 3), ..body.strike };
    body.tilt = digits((body.tilt + TILT * tilt).clamp(TILTS.0, TILTS.1), 3);
    let loss = body.material.loss;
    body.material.loss =
        Loss { b0: digits(loss.b0 * exp(2.0 * b0), 4), b1: digits(loss.b1 * exp(2.0 * b1), 4), ..loss };
    let mut patch = body::patch(draft, &body);
    patch.set(Param::MalletPulse, MalletPulse::Contact.value());
    patch.set(Param::MalletHardness, (1000.0 * (hardness + harder).clamp(0.0, 1.0)).round() as f32 / 10.0);
    patch
}
