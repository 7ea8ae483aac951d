//! Brings a draft nearer to its recording: plays it, compares both band by band, and corrects the draft.

use super::audition::{Audition, Played};
use super::correct::{by_bands, by_moments};
use super::draft::{Draft, Noise};
use super::movement::Swell;
use super::simplex;
use super::take::Prepared;
use crate::analysis::log_mel::{HOP, LogMel, MelBands, WINDOW};
use crate::error::{Error, Result};
use crate::params::NoiseDecay;
use crate::units::key_from_frequency;

/// Hardnesses that are tried.
const HARDNESSES: [f64; 10] = [0.95, 0.85, 0.75, 0.65, 0.55, 0.45, 0.35, 0.25, 0.15, 0.05];
/// Lengths and rises in seconds of the noise that are tried.
const LENGTHS: [f64; 8] = [0.002, 0.006, 0.015, 0.04, 0.1, 0.23, 0.5, 1.0];
const RISES: [f64; 4] = [0.003, 0.01, 0.03, 0.1];
/// Factor of the lengths beside the best of these that are tried.
const NEARER: f64 = 1.35;
/// A burst longer than this many seconds affects the decay.
const SHORT: f64 = 0.02;
/// Ratio of the T60 of an exponential burst to the length of a quadratic burst of the same energy: the energies are T60
/// / (6 ln 10) and length / 5.
const EXPONENTIAL: f64 = 2.76;
/// Bursts that follow each other, and seconds between them, that are tried.
const HITS: [u8; 3] = [2, 3, 4];
const SPACINGS: [f64; 4] = [0.008, 0.0105, 0.0135, 0.018];
/// Reduction of the attack's distance in dB for which several bursts are kept.
const WORTH_HITS: f64 = 0.3;
/// Swells that are tried: seconds and curves, and dB.
const SWELLS: [f64; 8] = [0.02, 0.04, 0.08, 0.15, 0.3, 0.6, 1.2, 2.4];
const CURVES: [f64; 3] = [0.0, 0.5, 0.9];
const SWELL_DB: f64 = 36.0;
/// Windows of the attack: 150 ms.
const ATTACK: usize = 26;
/// Frames by which the onset of what is played may be late.
const LATE: usize = 1024;
/// Steps of the search for a sweep.
const SIMPLEX_STEPS: usize = 36;

/// Plays drafts and measures how far they are from a recording. Reports the progress each time.
pub(super) struct Listener<'a> {
    audition: Audition,
    bands: MelBands,
    take: &'a Prepared,
    pub(super) target: LogMel,
    progress: &'a mut dyn FnMut(f64) -> bool,
    /// The share of the work that is done.
    share: f64,
}

impl<'a> Listener<'a> {
    pub(super) fn new(take: &'a Prepared, progress: &'a mut dyn FnMut(f64) -> bool) -> Self {
        let mut bands = MelBands::new();
        let target = bands.measure(&take.mean);
        Self { audition: Audition::new(), bands, take, target, progress, share: 0.0 }
    }

    /// Reports the share of the work that is done.
    ///
    /// # Errors
    /// [`Error::Interrupted`] if the caller cancels the work.
    pub(super) fn tell(&mut self, share: f64) -> Result<()> {
        self.share = share;
        if (self.progress)(share) { Ok(()) } else { Err(Error::Interrupted) }
    }

    /// The bands of a draft over the first windows.
    fn listen(&mut self, draft: &Draft, windows: usize) -> Result<LogMel> {
        self.tell(self.share)?;
        // The last window reaches half of its length further than its middle.
        let frames = self.take.mean.len().min(windows.saturating_mul(HOP).saturating_add(WINDOW / 2));
        let key = key_from_frequency(draft.note, 440.0);
        let played = Played { key, velocity: draft.velocity, frames: frames + LATE, let_go: None };
        let sound = self.audition.mean(&draft.patch(), played);
        let sound = crate::analysis::log_mel::from_onset(&sound);
        let mut heard = self.bands.measure(&sound[..sound.len().min(frames)]);
        heard.columns.truncate(windows);
        Ok(heard)
    }

    /// All of a draft's bands.
    pub(super) fn hear(&mut self, draft: &Draft) -> Result<LogMel> {
        self.listen(draft, usize::MAX)
    }

    /// Distance of a draft over the first windows, in dB.
    pub(super) fn distance(&mut self, draft: &Draft, windows: usize) -> Result<f64> {
        let heard = self.listen(draft, windows)?;
        if windows >= self.target.columns.len() {
            return Ok(heard.distance(&self.target));
        }
        let start = LogMel { columns: self.target.columns[..windows].to_vec() };
        Ok(heard.distance(&start))
    }

    /// Replaces the draft by the best of `others` over the first windows, if that is better.
    fn best(&mut self, draft: &mut Draft, windows: usize, others: impl IntoIterator<Item = Draft>) -> Result<()> {
        let mut least = self.distance(draft, windows)?;
        for other in others {
            let distance = self.distance(&other, windows)?;
            if distance < least {
                (*draft, least) = (other, distance);
            }
        }
        Ok(())
    }

    /// Chooses the hardness of the mallet by the attack.
    pub(super) fn choose_hardness(&mut self, draft: &mut Draft) -> Result<()> {
        let with = |draft: &Draft, hardness| Draft { hardness, ..draft.clone() };
        let coarse: Vec<Draft> = HARDNESSES.iter().map(|hardness| with(draft, Some(*hardness))).collect();
        self.best(draft, ATTACK, coarse)?;
        for step in [0.05, 0.025, 0.012] {
            if let Some(hardness) = draft.hardness {
                let near = [-step, step].map(|by| with(draft, Some((hardness + by).clamp(0.0, 1.0))));
                self.best(draft, ATTACK, near)?;
            }
        }
        Ok(())
    }

    /// Chooses the rise of a sound that is not struck.
    pub(super) fn choose_swell(&mut self, draft: &mut Draft) -> Result<()> {
        let with = |draft: &Draft, swell| Draft { swell, ..draft.clone() };
        let swell = |seconds| CURVES.map(|curve| Swell { seconds, depth: SWELL_DB, curve });
        let swells: Vec<Draft> = SWELLS.into_iter().flat_map(swell).map(|swell| with(draft, Some(swell))).collect();
        self.best(draft, usize::MAX, swells)?;
        for step in [0.35, 0.2, 0.1] {
            let Some(swell) = draft.swell else { break };
            let times = [1.0 - step, 1.0 + step].map(|factor| Swell { seconds: factor * swell.seconds, ..swell });
            let depths = [1.0 - step, 1.0 + step].map(|factor| Swell { depth: factor * swell.depth, ..swell });
            let curves = [-step, step].map(|by| Swell { curve: (swell.curve + by).clamp(-1.0, 1.0), ..swell });
            let near: Vec<Draft> =
                times.into_iter().chain(depths).chain(curves).map(|swell| with(draft, Some(swell))).collect();
            self.best(draft, usize::MAX, near)?;
        }
        Ok(())
    }

    /// Keeps the oscillators only if the sound is nearer with them.
    pub(super) fn choose_oscillators(&mut self, draft: &mut Draft) -> Result<()> {
        let without = (!draft.oscillators.is_empty()).then(|| Draft { oscillators: Vec::new(), ..draft.clone() });
        self.best(draft, usize::MAX, without)
    }

    /// Chooses length and rise of the noise burst.
    pub(super) fn choose_noise(&mut self, draft: &mut Draft) -> Result<()> {
        if draft.partials.iter().all(|partial| partial.struck) {
            return Ok(());
        }
        let with = |draft: &Draft, noise| Draft { noise, ..draft.clone() };
        let noise = draft.noise;
        // The decays of the modes were measured together with the burst, so they are corrected for each burst.
        let bursts = LENGTHS.map(|seconds| Noise { seconds, ..noise });
        self.best_corrected(draft, bursts)?;
        let noise = draft.noise;
        self.best_corrected(
            draft,
            [Noise { seconds: (EXPONENTIAL * noise.seconds).min(1.0), decay: NoiseDecay::Exponential, ..noise }],
        )?;
        if draft.noise.seconds > SHORT {
            let noise = draft.noise;
            let near = [1.0 / NEARER, NEARER].map(|factor| (factor * noise.seconds).min(1.0));
            self.best_corrected(draft, near.map(|seconds| Noise { seconds, ..noise }))?;
        }
        let noise = draft.noise;
        let rises: Vec<Draft> = RISES.map(|attack| with(draft, Noise { attack, ..noise })).into();
        self.best(draft, usize::MAX, rises)?;
        let noise = draft.noise;
        let several = HITS.map(|hits| SPACINGS.map(|spacing| with(draft, Noise { hits, spacing, ..noise })));
        let mut other = draft.clone();
        self.best(&mut other, ATTACK, several.into_iter().flatten())?;
        if self.distance(&other, ATTACK)? < self.distance(draft, ATTACK)? - WORTH_HITS {
            *draft = other;
        }
        Ok(())
    }

    /// Replaces the noise of the draft by the best of `bursts`, with levels and decays corrected for it, if that is better.
    fn best_corrected(&mut self, draft: &mut Draft, bursts: impl IntoIterator<Item = Noise>) -> Result<()> {
        let mut least = self.distance(draft, usize::MAX)?;
        let before = draft.clone();
        for noise in bursts {
            let mut other = Draft { noise, ..before.clone() };
            if noise.seconds > SHORT {
                self.correct(&mut other, 2)?;
            }
            let distance = self.distance(&other, usize::MAX)?;
            if distance < least {
                (*draft, least) = (other, distance);
            }
        }
        Ok(())
    }

    /// Moves the sweep to where the distance is least.
    pub(super) fn choose_sweep(&mut self, draft: &mut Draft) -> Result<()> {
        if draft.sweep.semitones == 0.0 {
            return Ok(());
        }
        let start = draft.sweep;
        let (place, _) = simplex::least(SIMPLEX_STEPS, |place| {
            self.distance(&Draft { sweep: start.moved(place), ..draft.clone() }, usize::MAX)
        })?;
        draft.sweep = start.moved(place);
        Ok(())
    }

    /// Corrects level and decay of the modes, as long as the distance falls.
    pub(super) fn correct(&mut self, draft: &mut Draft, rounds: usize) -> Result<()> {
        let mut heard = self.hear(draft)?;
        let (mut least, mut share, mut idle) = (heard.distance(&self.target), 0.8, 0);
        for round in 0..rounds {
            // Alternate between the two corrections: each can remove errors that the other cannot.
            let other = match round % 2 {
                0 => by_bands(draft, &self.target, &heard, share),
                _ => by_moments(draft, &self.target, &heard, share),
            };
            let other_heard = self.hear(&other)?;
            let distance = other_heard.distance(&self.target);
            if distance < least {
                idle = if distance > least - 0.005 { idle + 1 } else { 0 };
                (*draft, heard, least) = (other, other_heard, distance);
            } else {
                idle += 1;
                share *= 0.7;
            }
            if idle == 2 && share > 0.3 {
                share *= 0.5;
            } else if idle > 2 {
                break;
            }
        }
        Ok(())
    }
}
