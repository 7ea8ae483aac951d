//! Shapes the hardness, swell, noise and oscillators of a draft by ear: what is tried, of which the nearest is kept.

use super::draft::{Draft, Noise};
use super::movement::Swell;
use super::refine::{Judged, Listener};
use crate::error::Result;
use crate::params::{NoiseDecay, Param};

/// Hardnesses that are tried.
const HARDNESSES: [f64; 10] = [0.95, 0.85, 0.75, 0.65, 0.55, 0.45, 0.35, 0.25, 0.15, 0.05];
/// Change of a hardness by a step of 1: all steps together reach the next one that was tried.
const HARDER: f64 = 0.12;
/// Swells that are tried: each of the seconds with each of the curves and dB.
const SWELLS: [f64; 8] = [0.02, 0.04, 0.08, 0.15, 0.3, 0.6, 1.2, 2.4];
const CURVES: [f64; 3] = [0.0, 0.5, 0.9];
const DEPTHS_DB: [f64; 3] = [18.0, 36.0, 60.0];
/// Seconds that are tried for the fall of one that is not held.
const FALLS: [f64; 4] = [0.03, 0.1, 0.3, 1.0];
/// Lengths and rises in seconds of the noise that are tried.
const LENGTHS: [f64; 8] = [0.002, 0.006, 0.015, 0.04, 0.1, 0.23, 0.5, 1.0];
const RISES: [f64; 4] = [0.003, 0.01, 0.03, 0.1];
/// Step to the lengths beside the best of these that are tried.
const NEARER: f64 = 0.35;
/// Rise in seconds from which the search for one begins.
const LEAST_RISE: f64 = 0.002;
/// Ratio of the T60 of an exponential burst to the length of a quadratic burst of the same energy: the energies are T60
/// / (6 ln 10) and length / 5.
const EXPONENTIAL: f64 = 2.76;

fn factors(step: f64) -> [f64; 2] {
    [1.0 / (1.0 + step), 1.0 + step]
}

/// A noise of the same energy that falls in the other way.
fn otherwise(noise: Noise) -> Noise {
    match noise.decay {
        NoiseDecay::Quadratic => Noise {
            seconds: (EXPONENTIAL * noise.seconds).min(Noise::LONGEST),
            decay: NoiseDecay::Exponential,
            ..noise
        },
        NoiseDecay::Exponential => {
            Noise { seconds: noise.seconds / EXPONENTIAL, decay: NoiseDecay::Quadratic, ..noise }
        }
    }
}

/// A shorter and a longer noise.
fn lengthened(noise: Noise, step: f64) -> [Noise; 2] {
    factors(step).map(|factor| Noise { seconds: (factor * noise.seconds).min(Noise::LONGEST), ..noise })
}

/// Drafts whose noise is shorter and longer, and rises faster and more slowly.
fn noises(draft: &Draft, step: f64) -> Vec<Draft> {
    let noise = draft.noise;
    let rises = factors(step)
        .map(|factor| Noise { attack: (factor * noise.attack.max(LEAST_RISE)).min(Noise::LONGEST), ..noise });
    lengthened(noise, step).into_iter().chain(rises).map(|noise| Draft { noise, ..draft.clone() }).collect()
}

/// Drafts whose swell is faster and slower, less deep and deeper, bent less and more, and falls sooner and later.
fn swells(draft: &Draft, step: f64) -> Vec<Draft> {
    let Some(swell) = draft.swell else { return Vec::new() };
    let of = |factor: f64| {
        let curve = (swell.curve + factor - 1.0).clamp(-1.0, 1.0);
        [
            Swell { seconds: factor * swell.seconds, ..swell },
            Swell { depth: factor * swell.depth, ..swell },
            Swell { curve, ..swell },
            Swell { fall: swell.fall.map(|fall| factor * fall), ..swell },
        ]
    };
    [1.0 - step, 1.0 + step]
        .into_iter()
        .flat_map(of)
        .map(|swell| Draft { swell: Some(swell), ..draft.clone() })
        .collect()
}

impl Listener<'_> {
    /// Chooses the hardness of the mallet by the attack.
    pub(super) fn choose_hardness(&mut self, draft: &mut Draft) -> Result<()> {
        let with = |draft: &Draft, hardness| Draft { hardness: Some(hardness), ..draft.clone() };
        let coarse = HARDNESSES.map(|hardness| with(draft, hardness));
        self.keep(draft, Judged::ByAttack, coarse)?;
        self.descend(draft, Judged::ByAttack, |draft, step| {
            let beside = |hardness: f64| [-step, step].map(|by| (hardness + HARDER * by).clamp(0.0, 1.0));
            draft.hardness.into_iter().flat_map(beside).map(|hardness| with(draft, hardness)).collect()
        })
    }

    /// Chooses the rise of a sound that is not struck, and its fall if it does not stay at its level.
    pub(super) fn choose_swell(&mut self, draft: &mut Draft) -> Result<()> {
        let fall = draft.swell.and_then(|swell| swell.fall);
        let with = |draft: &Draft, swell| Draft { swell: Some(swell), ..draft.clone() };
        let coarse: Vec<Draft> = SWELLS
            .into_iter()
            .flat_map(|seconds| CURVES.map(|curve| (seconds, curve)))
            .flat_map(|(seconds, curve)| DEPTHS_DB.map(|depth| Swell { seconds, depth, curve, fall }))
            .map(|swell| with(draft, swell))
            .collect();
        self.keep(draft, Judged::AsItIs, coarse)?;
        if let Some(swell) = draft.swell.filter(|swell| swell.fall.is_none() && !draft.is_held) {
            let falls = FALLS.map(|fall| with(draft, Swell { fall: Some(fall), ..swell }));
            self.keep(draft, Judged::AsItIs, falls)?;
        }
        self.descend(draft, Judged::AsItIs, swells)
    }

    /// Keeps the oscillators only if the sound is nearer with them, and changes the depths in which they move the level.
    pub(super) fn choose_oscillators(&mut self, draft: &mut Draft) -> Result<()> {
        let most = f64::from(Param::Gain.info().max - Param::Gain.info().min);
        for n in 0..draft.oscillators.len() {
            self.descend(draft, Judged::AsItIs, |draft, step| {
                let deeper = |factor: f64| {
                    let mut other = draft.clone();
                    other.oscillators[n].db *= factor;
                    other
                };
                let is_playable =
                    |other: &Draft| other.oscillators.iter().map(|oscillator| oscillator.db.abs()).sum::<f64>() < most;
                factors(step).map(deeper).into_iter().filter(is_playable).collect()
            })?;
        }
        let without = (!draft.oscillators.is_empty()).then(|| Draft { oscillators: Vec::new(), ..draft.clone() });
        self.keep(draft, Judged::AsItIs, without)
    }

    /// Chooses length, fall and rise of the noise burst.
    pub(super) fn choose_noise(&mut self, draft: &mut Draft) -> Result<()> {
        if draft.partials.iter().all(|partial| partial.struck) {
            return Ok(());
        }
        let with = |draft: &Draft, noise| Draft { noise, ..draft.clone() };
        let noise = draft.noise;
        let lengths = LENGTHS.map(|seconds| with(draft, Noise { seconds, ..noise }));
        self.keep(draft, Judged::ByModes, lengths)?;
        let other = with(draft, otherwise(draft.noise));
        self.keep(draft, Judged::ByModes, [other])?;
        if draft.noise.is_audible() {
            let near = lengthened(draft.noise, NEARER).map(|noise| with(draft, noise));
            self.keep(draft, Judged::ByModes, near)?;
        }
        let rises = RISES.map(|attack| with(draft, Noise { attack, ..draft.noise }));
        self.keep(draft, Judged::AsItIs, rises)
    }

    /// Changes length and rise of a noise that is heard as such, as long as the sound comes nearer.
    pub(super) fn shape_noise(&mut self, draft: &mut Draft) -> Result<()> {
        if draft.noise.is_audible() && draft.partials.iter().any(|partial| !partial.struck) {
            self.descend(draft, Judged::ByModes, noises)?;
        }
        Ok(())
    }
}
