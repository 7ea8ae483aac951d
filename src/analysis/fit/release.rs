//! The release of a key in a recording: where it is, and the damper that sounds most like it.

use super::audition::{Audition, Played};
use super::layers::slope;
use super::simplex;
use crate::analysis::level::{dbfs, rms};
use crate::analysis::log_mel::{MelBands, RATE, from_onset};
use crate::error::{Error, Result};
use crate::params::{Choice, NoteOff, Param};
use crate::patch::Patch;
use libm::exp;

/// Samples from one level to the next, 10 ms, and number of these steps over which a level is measured.
const STEP: usize = RATE as usize / 100;
const SMOOTH: usize = 3;
/// Range in dB below the loudest level in which the sound is played, and not over.
const PLAYED_DB: f64 = 20.0;
/// Levels in dB below the median between which the fall is measured, and the least depth of a fall that counts: in a held sound, and
/// where the modes show a damper.
const FALLEN_DB: f64 = 6.0;
const DEEP_DB: f64 = 30.0;
const LEAST_DB: f64 = 15.0;
const LEAST_OF_MODES_DB: f64 = 8.0;
/// Fewest steps before a release, and least number of steps before it over which its slope is compared.
const FEWEST: usize = 27;
const COMPARED: usize = 50;
/// Least ratio of the slopes after and before a release: otherwise it is the sound's own decay.
const STEEPER: f64 = 4.0;
/// The same if the modes that were found before it say so, too. The dampers of Tubular Bells C5 (1.7 and 1.9) were missed with 2.
const STEEPER_THAN_MODES: f64 = 1.4;
/// Seconds before the tuned part of a release that are compared, too.
const BEFORE: f64 = 0.1;
/// Steps of the search for the damper. One unit of the search moves its moment by this many seconds, or by this share of its T60
/// if that is more.
const SEARCHED: usize = 14;
const LATER: (f64, f64) = (0.1, 0.25);
/// One unit of the search multiplies the T60 by e to this power.
const LONGER: f64 = 2.0;

/// The release of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Release {
    /// Seconds from the strike until the key is let go.
    pub seconds: f64,
    /// T60 of the damper in seconds.
    pub t60: f64,
}

/// The level in dB of every step.
fn levels(samples: &[f32]) -> Vec<f64> {
    let whole = samples.len() / STEP;
    let level = |n: usize| dbfs(rms(&samples[n * STEP..((n + SMOOTH) * STEP).min(samples.len())]));
    (0..whole).map(level).collect()
}

/// How the levels fall after a step: by how many dB per step, and until which step; none if they fall by less than `least` dB.
fn fall(levels: &[f64], after: usize, top: f64, least: f64) -> Option<(f64, usize)> {
    let deep = levels[after..].iter().position(|level| *level < top - DEEP_DB).map(|n| after + n);
    let end = deep.unwrap_or(levels.len() - 1);
    let depth = (top - levels[end]).min(DEEP_DB);
    (depth >= least).then(|| ((depth - FALLEN_DB) / end.saturating_sub(after + 1).max(1) as f64, end))
}

impl Release {
    fn new(seconds: f64, rate: f64) -> Self {
        let t60 = 60.0 / rate * STEP as f64 / f64::from(RATE);
        Self { seconds, t60: Param::Release.info().clamp(t60 as f32).into() }
    }

    /// The release of samples at [`RATE`], from their onset on, whose level stays about the same until they suddenly fall for good.
    pub(super) fn of_held(samples: &[f32]) -> Option<Self> {
        let levels = levels(samples);
        let loudest = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut played: Vec<f64> = levels.iter().copied().filter(|level| *level > loudest - PLAYED_DB).collect();
        played.sort_by(f64::total_cmp);
        let top = *played.get(played.len() / 2)?;
        let last = levels.iter().rposition(|level| *level > top - FALLEN_DB)?;
        let (rate, end) = fall(&levels, last, top, LEAST_DB)?;
        // The corner is where the levels are highest above the line from some time before to the end of the fall.
        let start = last.saturating_sub(end - last + COMPARED / 5);
        let line = |n: usize| levels[start] + (levels[end] - levels[start]) * (n - start) as f64 / (end - start) as f64;
        let above = |n: &usize| levels[*n] - line(*n);
        let corner = (start..=last).max_by(|a, b| above(a).total_cmp(&above(b)))?;
        let reach = COMPARED.max(2 * (end - corner)).min(corner);
        let before = (corner - reach..corner).map(|n| (n as f64, levels[n]));
        let falls = -slope(before).unwrap_or(0.0);
        let is_sudden = rate > STEEPER * falls && 2 * (end - corner) < corner;
        let middle = (corner as f64 + 0.5 * SMOOTH as f64) * STEP as f64 / f64::from(RATE);
        (corner >= FEWEST && is_sudden).then(|| Self::new(middle, rate))
    }

    /// The release of samples at [`RATE`] whose modes are damped from some seconds on; none if the levels do not fall clearly faster
    /// from there on.
    pub(super) fn of_damped(samples: &[f32], seconds: f64) -> Option<Self> {
        let levels = levels(samples);
        let at = (seconds * f64::from(RATE)) as usize / STEP;
        let top = *levels.get(at.checked_sub(SMOOTH)?)?;
        let after = at + levels.get(at..)?.iter().position(|level| *level < top - FALLEN_DB)?;
        let (rate, _) = fall(&levels, after, top, LEAST_OF_MODES_DB)?;
        let before = (at.saturating_sub(COMPARED)..at).map(|n| (n as f64, levels[n]));
        let falls = -slope(before).unwrap_or(0.0);
        // Soon after a stroke, levels bend down by themselves.
        (at >= FEWEST && rate > STEEPER_THAN_MODES * falls).then(|| Self::new(seconds, rate))
    }

    /// Frames at [`RATE`] until the key is let go.
    pub(super) fn frames(&self) -> usize {
        (self.seconds * f64::from(RATE)) as usize
    }

    /// The patch with this damper.
    fn of(&self, mut patch: Patch) -> Patch {
        patch.set(Param::NoteOff, NoteOff::Damp.value());
        patch.set(Param::Release, Param::Release.info().clamp(super::draft::digits(self.t60, 3) as f32));
        patch
    }

    /// The release, later and longer by some numbers, but within `frames`.
    fn moved(&self, [later, longer]: [f64; 2], frames: usize) -> Self {
        let seconds = self.seconds + later * LATER.0.max(LATER.1 * self.t60);
        let seconds = seconds.clamp(0.0, frames as f64 / f64::from(RATE));
        let t60 = f64::from(Param::Release.info().clamp((self.t60 * exp(LONGER * longer)) as f32));
        Self { seconds, t60 }
    }

    /// The patch with the damper that brings it nearest to the end of a sound, and that release. `recording` is at [`RATE`],
    /// from its onset on; `key` is a fractional MIDI key, `velocity` 0–1. `go_on` is asked often.
    ///
    /// # Errors
    /// [`Error::Interrupted`] if `go_on` returns `false`.
    pub(super) fn tuned(
        &self,
        patch: &Patch,
        recording: &[f32],
        (key, velocity): (f64, f64),
        go_on: &mut dyn FnMut() -> bool,
    ) -> Result<(Patch, Self)> {
        let (mut audition, mut bands) = (Audition::new(), MelBands::new());
        let from = (((self.seconds - BEFORE).max(0.0) * f64::from(RATE)) as usize).min(recording.len());
        let end = |samples: &[f32]| samples[from.min(samples.len())..recording.len().min(samples.len())].to_vec();
        let target = bands.measure(&end(recording));
        let (place, _) = simplex::least(SEARCHED, |place| {
            let tried = self.moved(place, recording.len());
            let note = Played { key, velocity, frames: recording.len(), let_go: Some(tried.frames()) };
            let played = audition.mean(&tried.of(patch.clone()), note);
            if go_on() {
                Ok(bands.measure(&end(from_onset(&played))).distance(&target))
            } else {
                Err(Error::Interrupted)
            }
        })?;
        let found = self.moved(place, recording.len());
        Ok((found.of(patch.clone()), found))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Two seconds of tones that fall by a T60 of `own` seconds, and from `let_go` seconds on by one of `damper`.
    fn sound(own: f64, let_go: f64, damper: f64, level: impl Fn(f64) -> f64) -> Vec<f32> {
        let sample = |n: usize| {
            let t = n as f64 / f64::from(RATE);
            let fall = t.min(let_go) / own + (t - let_go).max(0.0) / damper.min(own);
            let tones = (1..=6).map(|h| libm::sin(TAU * 131.0 * f64::from(h) * t) / f64::from(h)).sum::<f64>();
            (0.2 * level(t) * exp(-6.907_755 * fall) * tones) as f32
        };
        (0..2 * RATE as usize).map(sample).collect()
    }

    #[test]
    fn the_key_of_a_held_sound_is_let_go_where_it_falls_for_good() {
        let beating = |t: f64| 0.75 + 0.25 * libm::cos(TAU * 1.7 * t);
        let trembling = |t: f64| 1.0 + 0.3 * libm::sin(TAU * 6.0 * t);
        for (let_go, damper) in [(0.6, 0.05), (1.2, 0.2), (1.0, 0.8), (1.95, 0.1)] {
            for (name, level) in
                [("still", &(|_: f64| 1.0) as &dyn Fn(f64) -> f64), ("beats", &beating), ("tremolo", &trembling)]
            {
                let found = Release::of_held(&sound(1e9, let_go, damper, level));
                if let_go > 1.9 && found.is_none() {
                    // The recording may end too soon to tell.
                    continue;
                }
                let found = found.unwrap_or_else(|| panic!("{name}: none at {let_go} s"));
                let near = (found.seconds - let_go).abs() < 0.04 + 0.1 * damper;
                assert!(
                    near && found.t60 > 0.5 * damper && found.t60 < 0.05 + 2.0 * damper,
                    "{name}, {let_go} s, {damper} s: {found:?}"
                );
            }
        }
    }

    #[test]
    fn a_damper_is_measured_where_it_is_steeper_than_what_comes_before() {
        for (own, damper) in [(6.0, 0.2), (6.0, 1.0), (3.8, 2.2)] {
            let found = Release::of_damped(&sound(own, 0.9, damper, |_| 1.0), 0.9).unwrap();
            assert!((0.7 * damper..1.4 * damper).contains(&found.t60), "{damper} s: {found:?}");
        }
        assert_eq!(Release::of_damped(&sound(2.64, 0.9, 2.2, |_| 1.0), 0.9), None);
        assert_eq!(Release::of_damped(&sound(1.0, 9.0, 1.0, |_| 1.0), 0.9), None);
        assert_eq!(Release::of_damped(&sound(6.0, 9.0, 1.0, |_| 1.0), 1.9), None);
    }

    #[test]
    fn a_sound_that_decays_by_itself_is_not_let_go() {
        for own in [0.5, 2.0, 10.0, 1e9] {
            assert_eq!(Release::of_held(&sound(own, 9.0, 1.0, |_| 1.0)), None, "{own}");
        }
        assert_eq!(Release::of_held(&[]), None);
    }
}
