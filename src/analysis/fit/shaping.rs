//! Shapes the noise of a draft by ear: its length, rise and fall.

use super::correct::by_levels;
use super::draft::{Draft, Noise};
use super::refine::Listener;
use crate::error::Result;
use crate::params::NoiseDecay;

/// Lengths and rises in seconds of the noise that are tried.
const LENGTHS: [f64; 8] = [0.002, 0.006, 0.015, 0.04, 0.1, 0.23, 0.5, 1.0];
const RISES: [f64; 4] = [0.003, 0.01, 0.03, 0.1];
/// Step to the lengths beside the best of these that are tried.
const NEARER: f64 = 0.35;
/// Steps by which a noise is changed: one that lasts as long as the sound, and any.
const COARSE: [f64; 3] = [0.5, 0.25, 0.12];
const FINE: [f64; 3] = [0.4, 0.2, 0.1];
/// Rise in seconds from which the search for one begins.
const LEAST_RISE: f64 = 0.002;
/// Ratio of the T60 of an exponential burst to the length of a quadratic burst of the same energy: the energies are T60
/// / (6 ln 10) and length / 5.
const EXPONENTIAL: f64 = 2.76;
/// Corrections of levels at a time.
const LEVELLINGS: usize = 3;

/// A shorter and a longer noise.
fn lengthened(noise: Noise, step: f64) -> [Noise; 2] {
    factors(step).map(|factor| Noise { seconds: (factor * noise.seconds).min(Noise::LONGEST), ..noise })
}

/// Noises whose rise is shorter and longer.
fn risen(noise: Noise, step: f64) -> [Noise; 2] {
    factors(step).map(|factor| Noise { attack: (factor * noise.attack.max(LEAST_RISE)).min(Noise::LONGEST), ..noise })
}

/// Rows of bursts that follow each other faster and more slowly.
fn spaced(noise: Noise, step: f64) -> [Noise; 2] {
    factors(step).map(|factor| Noise { spacing: (factor * noise.spacing).min(Noise::FARTHEST), ..noise })
}

/// A noise of the same energy that falls exponentially.
fn exponential(noise: Noise) -> Noise {
    Noise { seconds: (EXPONENTIAL * noise.seconds).min(Noise::LONGEST), decay: NoiseDecay::Exponential, ..noise }
}

fn factors(step: f64) -> [f64; 2] {
    [1.0 / (1.0 + step), 1.0 + step]
}

impl Listener<'_> {
    /// Chooses length and rise of the noise burst.
    pub(super) fn choose_noise(&mut self, draft: &mut Draft) -> Result<()> {
        if draft.partials.iter().all(|partial| partial.struck) {
            return Ok(());
        }
        let noise = draft.noise;
        // The decays of the modes were measured together with the burst, so they are corrected for each burst.
        let bursts = LENGTHS.map(|seconds| Noise { seconds, ..noise });
        self.best_corrected(draft, bursts)?;
        self.best_corrected(draft, [exponential(draft.noise)])?;
        if draft.noise.is_audible() {
            self.best_corrected(draft, lengthened(draft.noise, NEARER))?;
        }
        let noise = draft.noise;
        let rises = RISES.map(|attack| Draft { noise: Noise { attack, ..noise }, ..draft.clone() });
        self.best(draft, usize::MAX, rises)
    }

    /// Corrects the levels alone of the modes of a draft, and returns its distance.
    pub(super) fn correct_levels(&mut self, draft: &mut Draft) -> Result<f64> {
        let mut heard = self.hear(draft)?;
        let mut least = heard.distance(&self.target);
        for _ in 0..LEVELLINGS {
            let other = by_levels(draft, &self.target, &heard);
            heard = self.hear(&other)?;
            let distance = heard.distance(&self.target);
            if distance >= least {
                break;
            }
            (*draft, least) = (other, distance);
        }
        Ok(least)
    }

    /// Changes length, rise and fall of a noise that lasts as long as the sound, with the levels alone corrected for each: decays
    /// would take over what is wrong in the noise. Returns the distance.
    pub(super) fn shape_lasting_noise(&mut self, draft: &mut Draft) -> Result<f64> {
        let mut least = self.correct_levels(draft)?;
        for step in COARSE {
            let before = draft.clone();
            let noise = before.noise;
            let others = if noise.hits > 1 { spaced(noise, step) } else { risen(noise, step) };
            let fall = match noise.decay {
                NoiseDecay::Quadratic => exponential(noise),
                NoiseDecay::Exponential => {
                    Noise { seconds: (1.0 / EXPONENTIAL) * noise.seconds, decay: NoiseDecay::Quadratic, ..noise }
                }
            };
            for noise in lengthened(noise, step).into_iter().chain(others).chain([fall]) {
                let mut other = Draft { noise, ..before.clone() };
                let distance = self.correct_levels(&mut other)?;
                if distance < least {
                    (*draft, least) = (other, distance);
                }
            }
        }
        Ok(least)
    }

    /// Changes length and rise of a noise that is heard as such, as long as the sound comes nearer.
    pub(super) fn shape_noise(&mut self, draft: &mut Draft) -> Result<()> {
        if !draft.noise.is_audible() || draft.partials.iter().all(|partial| partial.struck) {
            return Ok(());
        }
        for step in FINE {
            let near = [lengthened(draft.noise, step), risen(draft.noise, step)];
            self.best_corrected(draft, near.into_iter().flatten())?;
        }
        Ok(())
    }

    /// Replaces the noise of the draft by the best of `bursts`, with levels and decays corrected for it, if that is better.
    fn best_corrected(&mut self, draft: &mut Draft, bursts: impl IntoIterator<Item = Noise>) -> Result<()> {
        let mut least = self.distance(draft, usize::MAX)?;
        let before = draft.clone();
        for noise in bursts {
            let mut other = Draft { noise, ..before.clone() };
            let distance =
                if noise.is_audible() { self.correct(&mut other, 2)? } else { self.distance(&other, usize::MAX)? };
            if distance < least {
                (*draft, least) = (other, distance);
            }
        }
        Ok(())
    }
}
