//! Brings a draft nearer to its recording: plays it, compares both band by band, and corrects the draft.

use super::audition::{Audition, Played};
use super::correct::{by_bands, by_moments};
use super::draft::Draft;
use super::movement::Swell;
use super::prepared::Prepared;
use crate::analysis::log_mel::{HOP, LogMel, MelBands, WINDOW};
use crate::error::{Error, Result};
use crate::params::Param;

/// Hardnesses that are tried.
const HARDNESSES: [f64; 10] = [0.95, 0.85, 0.75, 0.65, 0.55, 0.45, 0.35, 0.25, 0.15, 0.05];
/// Swells that are tried: each of the seconds with each of the curves, at first with so many dB.
const SWELLS: [f64; 8] = [0.02, 0.04, 0.08, 0.15, 0.3, 0.6, 1.2, 2.4];
const CURVES: [f64; 3] = [0.0, 0.5, 0.9];
const SWELL_DB: f64 = 36.0;
/// Then the best one's seconds and dB are multiplied by these factors, and these seconds are tried for its fall.
const LONGER: [f64; 2] = [1.0, 1.6];
const DEEPER: [f64; 3] = [0.5, 1.4, 1.8];
const FALLS: [f64; 4] = [0.03, 0.1, 0.3, 1.0];
/// Distance in dB below which nothing nearer is looked for.
pub(super) const NEAR_DB: f64 = 0.4;
/// Windows of the attack: 150 ms.
const ATTACK: usize = 26;
/// Frames by which the onset of what is played may be late.
const LATE: usize = 1024;
/// Factors of the depths of oscillators that are tried, one after the other.
const DEPTHS: [f64; 4] = [1.4, 1.2, 1.1, 0.9];

/// Plays drafts and measures how far they are from a recording. Reports the progress each time.
pub(super) struct Listener<'a> {
    audition: Audition,
    bands: MelBands,
    pub(super) take: &'a Prepared,
    pub(super) target: LogMel,
    progress: &'a mut dyn FnMut(f64) -> bool,
    /// The share of the work that is done.
    share: f64,
}

impl<'a> Listener<'a> {
    pub(super) fn new(take: &'a Prepared, progress: &'a mut dyn FnMut(f64) -> bool) -> Self {
        let mut bands = MelBands::new();
        let heard = [&take.mean[..], &take.silence].concat();
        let target = bands.measure(&heard);
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
        let frames = (self.take.mean.len() + self.take.silence.len())
            .min(windows.saturating_mul(HOP).saturating_add(WINDOW / 2));
        let played = Played { key: draft.key(), velocity: draft.velocity, frames: frames + LATE, let_go: None };
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
    pub(super) fn best(
        &mut self,
        draft: &mut Draft,
        windows: usize,
        others: impl IntoIterator<Item = Draft>,
    ) -> Result<()> {
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

    /// Chooses the rise of a sound that is not struck, and its fall if it does not stay at its level.
    pub(super) fn choose_swell(&mut self, draft: &mut Draft) -> Result<()> {
        let fall = draft.swell.and_then(|swell| swell.fall);
        let swell = |seconds| CURVES.map(|curve| Swell { seconds, depth: SWELL_DB, curve, fall });
        self.best_swell(draft, SWELLS.into_iter().flat_map(swell))?;
        if let Some(swell) = draft.swell {
            let larger = |longer| {
                DEEPER.map(|deeper| Swell { seconds: longer * swell.seconds, depth: deeper * swell.depth, ..swell })
            };
            self.best_swell(draft, LONGER.into_iter().flat_map(larger))?;
        }
        for step in [0.35, 0.2, 0.1] {
            let factors = [1.0 - step, 1.0 + step];
            let Some(swell) = draft.swell else { break };
            let times = factors.map(|factor| Swell { seconds: factor * swell.seconds, ..swell });
            let depths = factors.map(|factor| Swell { depth: factor * swell.depth, ..swell });
            let curves = [-step, step].map(|by| Swell { curve: (swell.curve + by).clamp(-1.0, 1.0), ..swell });
            self.best_swell(draft, times.into_iter().chain(depths).chain(curves))?;
            let Some(swell) = draft.swell else { break };
            let falls = match swell.fall {
                // What is held stays at its level.
                None if draft.is_held => Vec::new(),
                None => FALLS.to_vec(),
                Some(fall) => factors.map(|factor| factor * fall).to_vec(),
            };
            self.best_swell(draft, falls.into_iter().map(|fall| Swell { fall: Some(fall), ..swell }))?;
        }
        Ok(())
    }

    /// Replaces the draft's swell by the best of some, if that is better.
    fn best_swell(&mut self, draft: &mut Draft, swells: impl Iterator<Item = Swell>) -> Result<()> {
        let before = draft.clone();
        self.best(draft, usize::MAX, swells.map(|swell| Draft { swell: Some(swell), ..before.clone() }))
    }

    /// Keeps the oscillators only if the sound is nearer with them, and changes the depths in which they move the level.
    pub(super) fn choose_oscillators(&mut self, draft: &mut Draft) -> Result<()> {
        if draft.oscillators.is_empty() {
            return Ok(());
        }
        let [least, most] = [Param::Gain.info().min, Param::Gain.info().max].map(f64::from);
        let mut nearest = self.distance(draft, usize::MAX)?;
        for n in 0..draft.oscillators.len() {
            for factor in DEPTHS {
                let mut other = draft.clone();
                other.oscillators[n].db *= factor;
                let sum: f64 = other.oscillators.iter().map(|oscillator| oscillator.db.abs()).sum();
                if other.oscillators[n].db == 0.0 || sum >= most - least {
                    continue;
                }
                let distance = self.distance(&other, usize::MAX)?;
                if distance < nearest {
                    (*draft, nearest) = (other, distance);
                }
            }
        }
        let without = Draft { oscillators: Vec::new(), ..draft.clone() };
        if self.distance(&without, usize::MAX)? < nearest {
            *draft = without;
        }
        Ok(())
    }

    /// Corrects level and decay of the modes, as long as the distance falls. Returns the distance.
    pub(super) fn correct(&mut self, draft: &mut Draft, rounds: usize) -> Result<f64> {
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
        Ok(least)
    }
}
