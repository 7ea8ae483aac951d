//! The first draft of a sound: the modes that it was taken apart into.

use super::draft::{Draft, MOST_MODES, Noise, Partial, Sweep, T60};
use super::take::Prepared;
use super::{pitch, sweep};
use crate::analysis::log_mel::RATE;
use crate::analysis::modes::{self, Mode, Strike};
use crate::error::{Error, Result};
use libm::{asin, cos, fabs, pow, sin};
use std::f64::consts::PI;

/// Highest frequency in Hz.
const HIGHEST: f64 = 20_000.0;
/// A mode that is louder than the whole sound by this much in dB was not found, but made up.
const TOO_LOUD_DB: f64 = 12.0;
/// Modes below the loudest by this much in dB are left to the noise.
const FAINT_DB: f64 = 75.0;
/// dB by which a mode can have been louder at the onset than where it was found.
const MOST_BEFORE_DB: f64 = 40.0;
/// The same if it was not moved by noise before.
const MOST_OF_A_SWELL_DB: f64 = 6.0;
/// Seconds that are taken apart, at most.
const LONGEST: f64 = 5.0;
/// dB by which a mode is followed back to the onset, at most.
const MOST_FALLEN_DB: f64 = 30.0;
/// Seconds by which a strike may be felt after the onset, for the phases of modes.
const LATEST: f64 = 0.006;

/// Standard deviation in radians up to which a phase is known.
const SURE_PHASE: f64 = 0.5;

/// What a draft is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source {
    /// What moves the pitch, which is taken out.
    pub(super) swept: Sweep,
    /// Seconds after the onset from which on modes are looked for.
    pub(super) late: f64,
    /// Whether the modes that are found then are moved by a strike, and not by noise.
    pub(super) struck: bool,
}

/// A draft of a sound's modes alone, and the strike that they were found in. No modes are no error: noise has none.
pub(super) fn draft(
    take: &Prepared,
    Source { swept, late, struck }: Source,
    most_modes: usize,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<(Draft, Option<Strike>)> {
    let decay = sweep::decay(&take.mean);
    let start = (late * f64::from(RATE)) as usize;
    let still = |channel: &Vec<f32>| {
        let still = sweep::stilled(channel, &swept, decay);
        still[start.min(still.len())..].to_vec()
    };
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
        // What does not decay is heard all the same.
        let steady = strike.steady.iter().filter(|tone| tone.frequency < HIGHEST && tone.level_db < peak + TOO_LOUD_DB);
        let kept: Vec<&Mode> = strike.modes.iter().filter(known).chain(steady).collect();
        let loudest = kept.iter().map(|mode| mode.level_db).fold(f64::NEG_INFINITY, f64::max);
        let kept: Vec<&Mode> = kept.into_iter().filter(|mode| mode.level_db > loudest - FAINT_DB).collect();
        let after = strike.fitted_from - strike.onset;
        let amplitudes: Vec<f64> = kept.iter().map(|mode| at_onset(mode, after)).collect();
        let delay = delay(&kept, &amplitudes);
        let struck_so = |(mode, amplitude): (&&Mode, &f64)| {
            let partial = partial(mode, *amplitude, delay);
            let before = 60.0 * late / partial.t60;
            let most = if struck { MOST_OF_A_SWELL_DB } else { MOST_BEFORE_DB };
            let amplitude = partial.amplitude * pow(10.0, before.min(most) / 20.0);
            Partial { amplitude, struck, ..partial }
        };
        partials.extend(kept.iter().zip(&amplitudes).map(struck_so));
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
        swell: None,
        is_held: take.is_held,
    };
    Ok((draft, strike))
}

/// The amplitude at the onset of a mode that was found so many seconds after it. Where the exciter is at work for long, a short mode
/// is only seen when little is left of it, and would have been loud before if nothing had moved it meanwhile.
pub(super) fn at_onset(mode: &Mode, after: f64) -> f64 {
    let fallen = 60.0 * after / mode.t60;
    pow(10.0, (mode.level_db - (fallen - MOST_FALLEN_DB).max(0.0)) / 20.0)
}

/// The time in seconds between the onset and the moment from which modes of such amplitudes start as sines.
fn delay(modes: &[&Mode], amplitudes: &[f64]) -> f64 {
    let aligned = |delay: f64| {
        let cosine = |(mode, amplitude): (&&Mode, &f64)| {
            amplitude * amplitude * fabs(cos(mode.phase + 2.0 * PI * mode.frequency * delay))
        };
        modes.iter().zip(amplitudes).map(cosine).sum::<f64>()
    };
    let steps = (LATEST * f64::from(RATE)) as usize;
    let times = (0..steps).map(|n| (n as f64 - 0.2 * steps as f64) / f64::from(RATE));
    times.max_by(|a, b| aligned(*a).total_cmp(&aligned(*b))).unwrap_or(0.0)
}

fn partial(mode: &Mode, amplitude: f64, delay: f64) -> Partial {
    let turned = mode.phase + 2.0 * PI * mode.frequency * delay;
    let sign = if cos(turned) < 0.0 { -1.0 } else { 1.0 };
    // What is uncertain starts as a sine.
    let phase = if mode.uncertainty.phase < SURE_PHASE { asin(sin(turned) * sign) } else { 0.0 };
    let pan = match mode.channels[..] {
        [(left, _), (right, _)] => {
            let [left, right] = [left, right].map(|level| pow(10.0, level / 10.0));
            ((right - left) / (right + left)).clamp(-1.0, 1.0)
        }
        _ => 0.0,
    };
    let pan = if fabs(pan) < 0.02 || pan.is_nan() { 0.0 } else { pan };
    Partial {
        frequency: mode.frequency,
        t60: mode.t60.min(T60.1),
        amplitude: sign * amplitude,
        phase,
        pan,
        struck: true,
    }
}
