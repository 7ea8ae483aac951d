//! The first draft of a sound: the modes that it was taken apart into.

use super::draft::{Draft, MOST_MODES, Noise, Partial, Sweep, T60};
use super::take::Prepared;
use super::{pitch, sweep};
use crate::analysis::log_mel::RATE;
use crate::analysis::modes::{self, Mode, Strike};
use crate::error::{Error, Result};
use libm::{cos, fabs, pow};
use std::f64::consts::PI;

/// Highest frequency in Hz.
const HIGHEST: f64 = 20_000.0;
/// A mode that is louder than the whole sound by this much in dB was not found, but made up.
const TOO_LOUD_DB: f64 = 12.0;
/// Modes below the loudest by this much in dB are left to the noise.
const FAINT_DB: f64 = 75.0;
/// dB by which a mode can have been louder at the onset than where it was found.
const MOST_BEFORE_DB: f64 = 40.0;
/// Seconds that are taken apart, at most.
const LONGEST: f64 = 5.0;
/// Seconds by which a strike may be felt after the onset, for the phases of modes.
const LATEST: f64 = 0.006;

/// A draft of a sound's modes alone when a sweep is taken out, and the strike that they were found in. Modes of what sounds
/// `late` seconds after the onset were not struck, if these are not 0. No modes are no error: noise has none.
pub(super) fn draft(
    take: &Prepared,
    swept: Sweep,
    late: f64,
    most_modes: usize,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<(Draft, Option<Strike>)> {
    let decay = sweep::decay(&take.mean);
    let start = (late * f64::from(RATE)) as usize;
    let still = |channel: &Vec<f32>| sweep::stilled(&channel[start..], &swept, decay);
    let still: Vec<Vec<f32>> = take.channels.iter().map(still).collect();
    let settings =
        modes::Settings { most_modes: most_modes.min(MOST_MODES), longest: LONGEST, ..modes::Settings::default() };
    let strike = match modes::modes(&still, RATE.into(), &settings, progress) {
        Ok(found) => found.strikes.into_iter().next(),
        Err(Error::Interrupted) => return Err(Error::Interrupted),
        // What does not ring at all is left to the noise.
        Err(_) => None,
    };
    let peak = 20.0 * libm::log10(take.peak());
    let mut partials = Vec::new();
    if let Some(strike) = &strike {
        let known = |mode: &&Mode| {
            let is_sure = mode.uncertainty.level_db < 9.0 && mode.uncertainty.t60 < mode.t60.min(T60.1);
            is_sure && mode.frequency < HIGHEST && mode.t60 > T60.0 && mode.level_db < peak + TOO_LOUD_DB
        };
        let kept: Vec<&Mode> = strike.modes.iter().filter(known).collect();
        let loudest = kept.iter().map(|mode| mode.level_db).fold(f64::NEG_INFINITY, f64::max);
        let kept: Vec<&Mode> = kept.into_iter().filter(|mode| mode.level_db > loudest - FAINT_DB).collect();
        let delay = delay(&kept);
        let at_onset = |mode: &&Mode| {
            let partial = partial(mode, delay);
            let before = 60.0 * late / partial.t60;
            let amplitude = partial.amplitude * pow(10.0, before.min(MOST_BEFORE_DB) / 20.0);
            Partial { amplitude, struck: late == 0.0, ..partial }
        };
        partials.extend(kept.iter().map(at_onset));
    }
    let note = take.key.map_or_else(|| pitch::estimate(&partials), |key| take.frequency_of(key));
    let draft = Draft {
        note,
        velocity: take.velocity,
        follow: 1.0,
        partials,
        hardness: None,
        sweep: swept,
        noise: Noise::SHORT,
    };
    Ok((draft, strike))
}

/// The time in seconds between the onset and the moment from which the modes start as sines.
fn delay(modes: &[&Mode]) -> f64 {
    let power = |mode: &Mode| pow(10.0, 0.1 * mode.level_db);
    let aligned = |delay: f64| {
        let cosine = |mode: &&Mode| power(mode) * fabs(cos(mode.phase + 2.0 * PI * mode.frequency * delay));
        modes.iter().map(cosine).sum::<f64>()
    };
    let steps = (LATEST * f64::from(RATE)) as usize;
    let times = (0..steps).map(|n| (n as f64 - 0.2 * steps as f64) / f64::from(RATE));
    times.max_by(|a, b| aligned(*a).total_cmp(&aligned(*b))).unwrap_or(0.0)
}

fn partial(mode: &Mode, delay: f64) -> Partial {
    let amplitude = pow(10.0, mode.level_db / 20.0);
    let sign = if cos(mode.phase + 2.0 * PI * mode.frequency * delay) < 0.0 { -1.0 } else { 1.0 };
    let pan = match mode.channels[..] {
        [(left, _), (right, _)] => {
            let [left, right] = [left, right].map(|level| pow(10.0, level / 10.0));
            ((right - left) / (right + left)).clamp(-1.0, 1.0)
        }
        _ => 0.0,
    };
    let pan = if fabs(pan) < 0.02 || pan.is_nan() { 0.0 } else { pan };
    Partial { frequency: mode.frequency, t60: mode.t60.min(T60.1), amplitude: sign * amplitude, pan, struck: true }
}
