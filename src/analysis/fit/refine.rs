//! Brings a draft nearer to its recording: plays it, compares both band by band, and corrects the draft.

use super::audition::{Audition, Played};
use super::correct::{by_bands, by_moments};
use super::draft::Draft;
use super::prepared::Prepared;
use crate::analysis::log_mel::{HOP, LogMel, MelBands, WINDOW, from_onset};
use crate::error::{Error, Result};

/// Distance in dB below which nothing nearer is looked for.
pub(super) const NEAR_DB: f64 = 0.4;
/// Windows of the attack: 150 ms.
const ATTACK: usize = 26;
/// Frames by which the onset of what is played may be late.
const LATE: usize = 1024;
/// Shares by which the numbers of a draft are changed, one after the other.
const STEPS: [f64; 3] = [0.4, 0.2, 0.1];
/// Corrections of a draft with its noise before it is judged.
const FEW_ROUNDS: usize = 2;

/// What of a draft is judged, and corrected before.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Judged {
    /// Its attack.
    ByAttack,
    /// All of it.
    AsItIs,
    /// All of it with corrected modes if its noise is audible, since their decays are measured together with that.
    ByModes,
}

impl Judged {
    /// Windows of a draft that are judged.
    fn windows(self) -> usize {
        if self == Self::ByAttack { ATTACK } else { usize::MAX }
    }
}

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
        let sound = from_onset(&sound);
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

    /// The distance of a draft that is judged so, and corrected before.
    fn judge(&mut self, draft: &mut Draft, by: Judged) -> Result<f64> {
        match by {
            Judged::ByModes if draft.noise.is_audible() => self.correct(draft, FEW_ROUNDS),
            _ => self.distance(draft, by.windows()),
        }
    }

    /// Replaces the draft by the nearest of `others`, if that is nearer.
    pub(super) fn keep(
        &mut self,
        draft: &mut Draft,
        by: Judged,
        others: impl IntoIterator<Item = Draft>,
    ) -> Result<()> {
        let least = self.distance(draft, by.windows())?;
        self.nearest(draft, least, by, others).map(drop)
    }

    /// Changes a draft by steps of [`STEPS`] as long as it comes nearer: `near` gives the drafts that are a step from one.
    pub(super) fn descend(
        &mut self,
        draft: &mut Draft,
        by: Judged,
        near: impl Fn(&Draft, f64) -> Vec<Draft>,
    ) -> Result<()> {
        let mut least = self.distance(draft, by.windows())?;
        for step in STEPS {
            least = self.nearest(draft, least, by, near(draft, step))?;
        }
        Ok(())
    }

    /// Replaces a draft at a distance by the nearest of `others`, if that is nearer. Returns the distance.
    fn nearest(
        &mut self,
        draft: &mut Draft,
        mut least: f64,
        by: Judged,
        others: impl IntoIterator<Item = Draft>,
    ) -> Result<f64> {
        for mut other in others {
            let distance = self.judge(&mut other, by)?;
            if distance < least {
                (*draft, least) = (other, distance);
            }
        }
        Ok(least)
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
