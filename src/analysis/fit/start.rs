//! Makes the first draft of a sound from its modes.

use super::draft::{A4, Draft, MOST_MODES, Noise, Partial, SHORTEST_T60, longest_t60};
use super::movement::Sweep;
use super::prepared::Prepared;
use super::{pitch, sweep};
use crate::analysis::log_mel::RATE;
use crate::analysis::modes::{self, Mode, Strike};
use crate::error::{Error, Result};
use crate::units::frequency_from_key;
use libm::{asin, cos, fabs, pow, sin};
use std::f64::consts::PI;

/// Highest frequency in Hz.
const HIGHEST: f64 = 20_000.0;
/// A mode this many dB louder than the sound's peak is an error of the analysis.
const TOO_LOUD_DB: f64 = 12.0;
/// Modes this many dB below the loudest are left to the bed.
const FAINT_DB: f64 = 75.0;
/// Largest level in dB that a mode gains by going back to the onset from where it was found.
const MOST_BEFORE_DB: f64 = 40.0;
/// Seconds of the sound that are analysed, at most.
const LONGEST: f64 = 5.0;
/// Largest decay in dB over which a mode's level is extrapolated back to the onset.
const MOST_FALLEN_DB: f64 = 30.0;
/// Range in seconds of the delays of the strike that are tried, a fifth of it before the onset.
const LATEST: f64 = 0.006;
/// Largest standard deviation in radians of a phase that is kept.
const SURE_PHASE: f64 = 0.5;

/// How the modes of a draft are found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source {
    /// The movement of the pitch, which is removed first.
    pub(super) swept: Sweep,
    /// Seconds after the onset at which the search for modes begins.
    pub(super) late: f64,
    /// Whether the modes are excited by a strike, and not by noise.
    pub(super) struck: bool,
}

/// A draft with the strike in which its modes were found, or of noise with that of the sound's first draft.
pub(super) type Found = (Draft, Option<Strike>);

/// A draft of a sound's modes alone, and the strike in which they were found. Finding no modes is no error: noise has none.
pub(super) fn draft(
    take: &Prepared,
    source: Source,
    most_modes: usize,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Found> {
    let decay = sweep::decay(&take.mean);
    let start = (source.late * f64::from(RATE)) as usize;
    let still = |channel: &Vec<f32>| {
        let still = sweep::stilled(channel, &source.swept, decay);
        still[start.min(still.len())..].to_vec()
    };
    let still: Vec<Vec<f32>> = take.channels.iter().map(still).collect();
    let strike = strike(&still, most_modes, progress)?;
    // In a held sound many modes can stand for one whose pitch moves. They would cancel with their measured phases once their levels
    // are corrected, so all start as sines.
    Ok((from(take, strike.as_ref(), &source, !take.is_held), strike))
}

/// The modes of a sound at [`RATE`], a list of samples per channel; none if it does not ring at all.
///
/// # Errors
/// [`Error::Interrupted`].
pub(super) fn strike(
    channels: &[Vec<f32>],
    most_modes: usize,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<Strike>> {
    let settings =
        modes::Settings { most_modes: most_modes.min(MOST_MODES), longest: LONGEST, ..modes::Settings::default() };
    match modes::modes(channels, RATE.into(), &settings, progress) {
        Ok(found) => Ok(found.strikes.into_iter().next()),
        Err(Error::Interrupted) => Err(Error::Interrupted),
        // A sound that does not ring at all is left to the bed.
        Err(_) => Ok(None),
    }
}

/// The draft of a strike's modes, with their phases at the onset or as sines.
pub(super) fn from(take: &Prepared, strike: Option<&Strike>, source: &Source, has_phases: bool) -> Draft {
    let Source { swept, late, struck } = *source;
    let peak = 20.0 * libm::log10(take.peak());
    let mut partials = Vec::new();
    if let Some(strike) = strike {
        let longest = longest_t60(take.is_held);
        let known = |mode: &&Mode| {
            let is_sure = mode.uncertainty.level_db < 9.0 && mode.uncertainty.t60 < mode.t60.min(longest);
            is_sure && mode.frequency < HIGHEST && mode.t60 > SHORTEST_T60 && mode.level_db < peak + TOO_LOUD_DB
        };
        // Tones that do not decay are heard too, so keep them.
        let steady = strike.steady.iter().filter(|tone| tone.frequency < HIGHEST && tone.level_db < peak + TOO_LOUD_DB);
        let kept: Vec<&Mode> = strike.modes.iter().filter(known).chain(steady).collect();
        let loudest = kept.iter().map(|mode| mode.level_db).fold(f64::NEG_INFINITY, f64::max);
        let kept: Vec<&Mode> = kept.into_iter().filter(|mode| mode.level_db > loudest - FAINT_DB).collect();
        let after = strike.fitted_from - strike.onset;
        let amplitudes: Vec<f64> = kept.iter().map(|mode| at_onset(mode, after)).collect();
        // They are moved to where most start as sines, since nobody hears a shift of all. Noise has no phases.
        let shift = delay(&kept, &amplitudes);
        let struck_so = |(mode, amplitude): (&&Mode, &f64)| {
            let partial = partial(mode, *amplitude, shift);
            let partial = Partial { t60: partial.t60.min(longest), ..partial };
            let phase = if has_phases && struck { partial.phase } else { 0.0 };
            Partial { phase, struck, ..partial }.earlier(late, MOST_BEFORE_DB)
        };
        partials.extend(kept.iter().zip(&amplitudes).map(struck_so));
    }
    let note = take.key.map_or_else(|| pitch::estimate(&partials), |key| frequency_from_key(key, A4));
    Draft {
        note,
        velocity: take.velocity,
        follow: 1.0,
        partials,
        hardness: None,
        sweep: swept,
        noise: Noise::SHORT,
        swell: None,
        oscillators: Vec::new(),
        is_held: take.is_held,
    }
}

/// The amplitude at the onset of a mode that was found `after` seconds later. If the exciter acts for long, a short
/// mode is only found when little of it is left. Its level, extrapolated back to the onset, would be too high, so the
/// extrapolation is limited.
pub(super) fn at_onset(mode: &Mode, after: f64) -> f64 {
    let fallen = 60.0 * after / mode.t60;
    pow(10.0, (mode.level_db - (fallen - MOST_FALLEN_DB).max(0.0)) / 20.0)
}

/// The time in seconds from the onset to the moment at which modes of these amplitudes start as sines.
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

/// A mode of this amplitude, turned to its phase so many seconds later.
fn partial(mode: &Mode, amplitude: f64, later: f64) -> Partial {
    let turned = mode.phase + 2.0 * PI * mode.frequency * later;
    let sign = if cos(turned) < 0.0 { -1.0 } else { 1.0 };
    // A mode of uncertain phase starts as a sine.
    let phase = if mode.uncertainty.phase < SURE_PHASE { asin(sin(turned) * sign) } else { 0.0 };
    let pan = match mode.channels[..] {
        [(left, _), (right, _)] => {
            let [left, right] = [left, right].map(|level| pow(10.0, level / 10.0));
            ((right - left) / (right + left)).clamp(-1.0, 1.0)
        }
        _ => 0.0,
    };
    let pan = if fabs(pan) < 0.02 || pan.is_nan() { 0.0 } else { pan };
    Partial { frequency: mode.frequency, t60: mode.t60, amplitude: sign * amplitude, phase, pan, struck: true }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::analysis::modes::Uncertainty;

    /// A mode of 440 Hz with this phase and its uncertainty.
    pub(crate) fn mode(phase: f64, uncertainty: f64) -> Mode {
        Mode {
            frequency: 440.0,
            t60: 1.0,
            level_db: 0.0,
            phase,
            uncertainty: Uncertainty { frequency: 0.01, t60: 0.01, level_db: 0.1, phase: uncertainty },
            snr_db: 40.0,
            channels: Vec::new(),
        }
    }

    #[test]
    fn modes_keep_their_phases_if_these_are_known() {
        for phase in [-3.0, -1.0, 0.0, 1.0, 2.5] {
            let known = partial(&mode(phase, 0.1), 0.5, 0.0);
            let played = [sin(known.phase), cos(known.phase)].map(|part| known.amplitude * part);
            let expected = [sin(phase), cos(phase)].map(|part| 0.5 * part);
            assert!((0..2).all(|n| fabs(played[n] - expected[n]) < 1e-12), "{phase}: {known:?}");
            assert_eq!(partial(&mode(phase, 1.0), 0.5, 0.0).phase, 0.0);
        }
    }
}
