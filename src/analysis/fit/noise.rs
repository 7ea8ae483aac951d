//! Drafts of noise that lasts as long as the sound, as of breath, a shaker or a scratched record.

use super::bed::{self, Lines};
use super::draft::{Draft, Noise};
use super::movement::Sweep;
use super::prepared::Prepared;
use super::refine::{Judged, Listener, NEAR_DB};
use super::sweep;
use crate::analysis::log_mel::{BANDS, LogMel, MelBands, RATE, time};
use crate::error::Result;

/// Powers relative to the greatest at which a noise has come to its level, and at which it is over: −3 and −30 dB.
const HALF: f64 = 0.5;
const OVER: f64 = 1e-3;
/// Sweeps of noise that are tried, in semitones and seconds; seconds of the longest sound for which they are, and the reduction of
/// the distance in dB for which one is kept.
const SEMITONES: [f64; 6] = [-22.0, -13.0, -6.0, 6.0, 13.0, 22.0];
const SECONDS: [f64; 5] = [0.05, 0.1, 0.2, 0.4, 0.8];
const LONGEST_SWEPT: f64 = 1.5;
const AUDIBLE_SWEEP_DB: f64 = 0.2;
/// Seed of the pans of the modes.
const SEED: u64 = 10;

/// Seconds from the onset until a sound has come to its level, and until it is over.
fn extent(target: &LogMel) -> (f64, f64) {
    let power = |column: &[f64; BANDS]| column.iter().map(|level| libm::pow(10.0, 0.1 * level)).sum::<f64>();
    let powers: Vec<f64> = target.columns.iter().map(power).collect();
    let loudest = powers.iter().copied().fold(0.0, f64::max);
    let seconds = |at: Option<usize>| time(at.unwrap_or(0));
    let attack = seconds(powers.iter().position(|power| *power > HALF * loudest));
    (attack, seconds(powers.iter().rposition(|power| *power > OVER * loudest)))
}

/// A draft of noise that goes on for as long as the sound, up to a second, as of breath or a shaker, through short modes.
pub(super) fn lasting(take: &Prepared, most: usize, draft: Draft) -> Draft {
    let target = MelBands::new().measure(&take.mean);
    let (attack, end) = extent(&target);
    // The engine's noise falls after its attack.
    let seconds = (end - attack).clamp(Noise::AUDIBLE, Noise::LONGEST);
    let noise = Noise { seconds, attack: attack.min(Noise::LONGEST), ..Noise::SHORT };
    through_short_modes(&target, &take.mean, most, Draft { noise, ..draft })
}

/// The draft with short modes at the levels `target` of samples whose pitch is constant.
fn through_short_modes(target: &LogMel, samples: &[f32], most: usize, draft: Draft) -> Draft {
    let mut partials = bed::short(target, &Lines::new(samples), most, SEED);
    bed::alternate(&mut partials);
    Draft { partials, ..draft }
}

/// The draft with its noise shaped, and with the sweep of its modes if it has one.
/// `tell` is called with the share of this that is done.
pub(super) fn shaped(
    draft: Draft,
    take: &Prepared,
    most: usize,
    listener: &mut Listener,
    tell: &dyn Fn(&mut Listener, f64) -> Result<()>,
) -> Result<Draft> {
    let mut best = draft;
    let still = listener.shape_lasting_noise(&mut best)?;
    tell(listener, 0.4)?;
    let is_short = take.mean.len() <= (LONGEST_SWEPT * f64::from(RATE)) as usize;
    let moving = if is_short && still > NEAR_DB { swept(&best, still, take, most, listener)? } else { None };
    tell(listener, 1.0)?;
    Ok(moving.unwrap_or(best))
}

/// The draft with the sweep that brings it nearer than `still` dB, if there is one: found by ear, since noise has no pitch to follow.
fn swept(draft: &Draft, still: f64, take: &Prepared, most: usize, listener: &mut Listener) -> Result<Option<Draft>> {
    let decay = sweep::decay(&take.mean);
    let with = |sweep| {
        let samples = sweep::stilled(&take.mean, &sweep, decay);
        through_short_modes(&MelBands::new().measure(&samples), &samples, most, Draft { sweep, ..draft.clone() })
    };
    let mut found = draft.clone();
    let coarse = SEMITONES.iter().flat_map(|semitones| SECONDS.map(|seconds| (*semitones, seconds)));
    let coarse = coarse.map(|(semitones, seconds)| with(Sweep { semitones, seconds, curve: 0.0, ..Sweep::NONE }));
    listener.keep(&mut found, Judged::ByLevels, coarse)?;
    if found.sweep.is_none() {
        return Ok(None);
    }
    listener.descend(&mut found, Judged::ByLevels, |found, step| {
        let near = [[step, 0.0, 0.0], [0.0, step, 0.0], [0.0, 0.0, step]];
        near.iter().flat_map(|by| [*by, by.map(|by| -by)]).map(|by| with(found.sweep.moved(by))).collect()
    })?;
    let distance = listener.shape_lasting_noise(&mut found)?;
    Ok((distance < still - AUDIBLE_SWEEP_DB).then_some(found))
}

#[cfg(test)]
mod tests {
    use super::super::audition::{Audition, Played};
    use super::super::correct;
    use super::super::draft::Partial;
    use super::super::prepared::tests::prepared;
    use super::*;

    /// A draft of noise through forty modes, and what it sounds like.
    fn sound(noise: Noise, sweep: Sweep) -> (Draft, Prepared) {
        let partial = |n: usize| Partial {
            frequency: 300.0 * libm::pow(1.08, n as f64),
            t60: 0.04,
            amplitude: if n.is_multiple_of(2) { 0.02 } else { -0.02 },
            phase: 0.0,
            pan: 0.0,
            struck: false,
        };
        let partials = (0..40).map(partial).collect();
        let draft = Draft { noise, sweep, partials, ..correct::tests::draft([0.0; 2]) };
        let note = Played { key: 69.0, velocity: draft.velocity, frames: RATE as usize, let_go: None };
        let samples = Audition::new().mean(&draft.patch(), note);
        (draft, prepared(samples, RATE))
    }

    /// The shaped draft of a sound, and by how many dB it is nearer than before.
    fn found((draft, take): &(Draft, Prepared)) -> (Draft, f64) {
        let mut go_on = |_: f64| true;
        let mut listener = Listener::new(take, &mut go_on);
        let first = lasting(take, 96, Draft { partials: Vec::new(), sweep: Sweep::NONE, ..draft.clone() });
        assert!(first.noise.is_audible());
        let before = listener.distance(&first, usize::MAX).unwrap();
        let shaped = shaped(first, take, 96, &mut listener, &|listener, share| listener.tell(share)).unwrap();
        let distance = listener.distance(&shaped, usize::MAX).unwrap();
        assert!(distance < 3.0, "{distance:.2} dB, {:?}, {:?}", shaped.noise, shaped.sweep);
        (shaped, before - distance)
    }

    /// How far two numbers are apart, in octaves.
    fn octaves(found: f64, known: f64) -> f64 {
        libm::fabs(libm::log2(found / known))
    }

    #[test]
    fn a_breath_is_found_with_its_rise_and_its_length() {
        let breath = Noise { attack: 0.1, seconds: 0.4, ..Noise::SHORT };
        let (Draft { noise, .. }, nearer) = found(&sound(breath, Sweep::NONE));
        assert!(noise.hits == 1 && nearer > 5.0, "{nearer:.2} dB nearer, {noise:?}");
        assert!(
            octaves(noise.attack, breath.attack) < 0.4 && octaves(noise.seconds, breath.seconds) < 0.3,
            "{noise:?}"
        );
    }

    #[test]
    fn the_sweep_of_noise_is_heard() {
        let known = Sweep { semitones: -14.0, seconds: 0.2, curve: 0.0, ..Sweep::NONE };
        let (Draft { sweep, .. }, _) = found(&sound(Noise { attack: 0.02, seconds: 0.3, ..Noise::SHORT }, known));
        // Modes at other frequencies can make up for a pitch that is wrong by a constant, so compare how far it falls.
        let fall = |sweep: &Sweep| sweep.envelope().at(0.02) - sweep.envelope().at(0.12);
        assert!(octaves(fall(&sweep), fall(&known)) < 0.5, "{sweep:?}");
    }
}
