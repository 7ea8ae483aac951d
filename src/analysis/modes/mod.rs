//! Analyses a recording of strikes into its modes.
//!
//! Modes are damped sinusoids, each with frequency, T60, level, phase and their uncertainties.
//!
//! Spectra matched to decays of all lengths have peaks where there is more than noise. ESPRIT resolves the bands around
//! these peaks into poles. All poles are refined together by least squares on the whole sound, and those that explain
//! no more than noise would are dropped. This is repeated with the residual, until it has no more peaks.
//!
//! 1. `contact` finds where the exciter has let go, and `damping` where something damps the sound. The stretch between
//!    them rings freely.
//! 2. `detect` transforms the residual times `e^(−d·n)` for a dozen decays `d`: a matched filter for every frequency.
//!    The noise floor is the running median of each such spectrum, so it is local in frequency and in time.
//! 3. `esprit` decimates the band around each peak, as long as that decay, to a hundred samples and resolves it into
//!    poles; their number is the one of least description length. If a band has more poles than a hundred samples can
//!    separate, bands of four hundred that reach to the end of the sound take its place: the modes of a drum head are
//!    closer to each other than they are wide.
//! 4. `fit` refines all poles together on the whole sound. Products of two modes are sums of `wⁿ`, `n·wⁿ` and `n²·wⁿ`,
//!    found by doubling. So an iteration costs one pass over the samples for each mode, and no matrix is as long as the
//!    sound.
//! 5. `prune` drops modes that explain less than 15 times what noise explains there on average.
//! 6. `search` repeats this. If nothing stands out, or three rounds have gained nothing, it refines the best fit to its
//!    end and resolves the bands of all its modes again, which separates modes that are closer to each other than their
//!    bandwidth.
//! 7. `plausible` drops what the sound cannot have had.
//!
//! Uncertainties are those of least squares in noise of the level of the floor; in tests, the errors in noise lie
//! within them. `tests` here analyses synthetic strikes, clean and in noise, and every factory preset with a release in
//! the sound.

mod common;
mod contact;
mod damping;
mod detect;
mod esprit;
mod fit;
mod groups;
mod mode;
mod plausible;
mod pole;
mod prune;
mod resolve;
mod search;
mod strikes;

pub use common::{Common, common};
pub use mode::{Group, Kind, Mode, Strike, Uncertainty};

use super::level::{cancelling, dbfs, energy, mean_of, offset};
use crate::error::{Error, Result};
use crate::sound::bodies::LN_1000;
use fit::Fit;
use groups::groups;
use libm::{log10, sqrt};
use plausible::{AUDIBLE, Limits};
use pole::{add, magnitude};
use std::f64::consts::{LN_10, PI};
use strikes::{BLOCK, Stretch, strikes};

/// Settings of an analysis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Maximum number of modes of a strike; the strongest are found first.
    pub most_modes: usize,
    /// Longest part of a strike, in seconds, that is analysed.
    pub longest: f64,
    /// Whether every strike is analysed, or only the first.
    pub all_strikes: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { most_modes: 256, longest: 12.0, all_strikes: false }
    }
}

/// The analysis of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// The strikes that were analysed.
    pub strikes: Vec<Strike>,
    /// Number of strikes that were found, analysed or not.
    pub strikes_found: usize,
    /// Doubts about the results.
    pub warnings: Vec<String>,
}

/// Lowest peak of a recording that is not silent: −100 dBFS.
const SILENCE: f64 = 1e-5;
/// T60 in seconds above which a tone does not decay, and standard deviations by which its decay must differ from 0.
const ENDLESS: f64 = 2000.0;
const DEVIATIONS: f64 = 2.0;
/// Residual in dB above which the sound is hardly made of modes.
const HARDLY_MODES_DB: f64 = -6.0;

/// Analyses a recording: a list of samples for each channel, at `sample_rate` Hz. `progress` is called with the share
/// of the work that is done, and cancels the analysis by returning `false`.
///
/// # Errors
/// [`Error::Value`] for silence, samples that are not finite, sounds too short and fits that have no solution;
/// [`Error::Interrupted`].
pub fn modes(
    channels: &[Vec<f32>],
    sample_rate: f64,
    settings: &Settings,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Analysis> {
    let mut warnings = Vec::new();
    let wrong = |message: &str| Error::value("sound", message);
    if channels.iter().flatten().any(|sample| !sample.is_finite()) {
        return Err(wrong("some samples are not finite: expected numbers"));
    }
    if channels.windows(2).any(|pair| pair[0].len() != pair[1].len()) {
        return Err(wrong("its channels differ in length: expected as many samples in each"));
    }
    let mut rest = mono(channels, &mut warnings);
    let constant = offset(&rest, (BLOCK * sample_rate) as usize);
    let peak = rest.iter().fold(0.0_f64, |peak, sample| peak.max((sample - constant).abs()));
    if peak < SILENCE {
        return Err(wrong("it is silent, or a constant: expected a strike above −100 dBFS"));
    }
    warnings.extend(clipping(channels));
    let stretches = strikes(&rest, sample_rate, settings.longest);
    if stretches.is_empty() {
        return Err(wrong("there is no strike of at least 30 ms in it: expected something that is struck and rings"));
    }
    // What is left of each channel, if there are several.
    let several = if channels.len() > 1 { channels } else { &[] };
    let mut rests: Vec<Vec<f64>> =
        several.iter().map(|channel| channel.iter().map(|sample| f64::from(*sample)).collect()).collect();
    let count = if settings.all_strikes { stretches.len() } else { 1 };
    let mut found = Vec::new();
    for (index, stretch) in stretches.iter().copied().take(count).enumerate() {
        let mut told = |share: f64| progress((index as f64 + share) / count as f64);
        let (stretch, damped, modes) = search(&rest, stretch, sample_rate, settings.most_modes, &mut told)?;
        let in_channel = |rest: &Vec<f64>| Fit::new(&rest[stretch.start..stretch.end], modes.fit.poles.clone());
        let fits: Vec<Option<Fit>> = rests.iter().map(in_channel).collect();
        let mut strike = strike(&modes, &fits, &rest, &stretch, sample_rate);
        if damped.is_none() {
            end_ringing(&mut rest, &modes.fit, &stretch);
            rests.iter_mut().zip(&fits).for_each(|(rest, fit)| {
                fit.iter().for_each(|fit| end_ringing(rest, fit, &stretch));
            });
        }
        strike.damped = damped.map(|frame| frame as f64 / sample_rate);
        if let Some(seconds) = strike.damped {
            warnings.push(format!(
                "the strike at {:.3} s is damped soon after {seconds:.3} s: its modes are those of what comes before",
                strike.onset
            ));
        }
        warnings.extend(steady(&strike));
        if strike.residual_db > HARDLY_MODES_DB {
            warnings.push(format!(
                "the modes of the strike at {:.3} s explain little of it ({:.1} dB are left): expected something that is \
                 struck and rings freely",
                strike.onset, strike.residual_db
            ));
        }
        found.push(strike);
    }
    Ok(Analysis { strikes: found, strikes_found: stretches.len(), warnings })
}

/// Takes what still rings after a stretch out of the sound, so that it is no part of the next strike.
fn end_ringing(sound: &mut [f64], fit: &Fit, stretch: &Stretch) {
    for (pole, amplitude) in fit.poles.iter().zip(&fit.amplitudes) {
        add(&mut sound[stretch.end..], *pole, *amplitude * pole.power(stretch.end - stretch.start), -1.0);
    }
}

/// The modes of a stretch: of all of it, or of the part before the frame at which it is damped.
fn search(
    sound: &[f64],
    stretch: Stretch,
    sample_rate: f64,
    most_modes: usize,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<(Stretch, Option<usize>, search::Found)> {
    let samples = &sound[stretch.start..stretch.end];
    let peak = sound[stretch.onset..stretch.end].iter().fold(0.0_f64, |peak, sample| peak.max(sample.abs()));
    let limits = Limits { peak, late: (stretch.start - stretch.onset) as f64, sample_rate };
    let mut begun = 0.0;
    for damper in damping::dampers(samples, sample_rate) {
        let part = 0.5 * (1.0 - begun);
        let told = &mut |share| progress(begun + part * share);
        let found = search::find(&samples[..damper.from], sample_rate, most_modes, &limits, told)?;
        if damping::confirmed(&found.fit, damper, samples, sample_rate) {
            let end = stretch.start + damper.from;
            return Ok((Stretch { end, ..stretch }, Some(end), found));
        }
        begun += part;
    }
    let mut told = |share: f64| progress(begun + (1.0 - begun) * share);
    Ok((stretch, None, search::find(samples, sample_rate, most_modes, &limits, &mut told)?))
}

/// The mean of the channels, or the loudest channel if they almost cancel.
fn mono(channels: &[Vec<f32>], warnings: &mut Vec<String>) -> Vec<f64> {
    match cancelling(channels) {
        Some(index) => {
            warnings.push(format!("the channels all but cancel: channel {} alone was taken apart", index + 1));
            channels[index].iter().map(|sample| f64::from(*sample)).collect()
        }
        None => mean_of(channels),
    }
}

/// A warning of successive samples that all have the peak value.
fn clipping(channels: &[Vec<f32>]) -> Option<String> {
    let mut count = 0;
    for channel in channels {
        let peak = channel.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        let flat = |run: &&[f32]| run.len() >= 3 && run[0].abs() == peak;
        count += if peak > 0.5 { channel.chunk_by(|a, b| a == b).filter(flat).count() } else { 0 };
    }
    let places = if count == 1 { "place" } else { "places" };
    (count > 0).then(|| format!("the sound is clipped in {count} {places}: levels and high modes are doubtful"))
}

/// A warning of tones that do not decay.
fn steady(strike: &Strike) -> Option<String> {
    let (first, more) = (strike.steady.first()?, strike.steady.len() - 1);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let (onset, verb) = (strike.onset, if more.is_empty() { "does" } else { "do" });
    Some(format!(
        "a tone of {:.2} Hz{more} {verb} not decay measurably: not listed among the modes of the strike at {onset:.3} s",
        first.frequency
    ))
}

/// The strike whose modes were found in a stretch of the sound, with their fits to each of several channels.
fn strike(found: &search::Found, fits: &[Option<Fit>], sound: &[f64], stretch: &Stretch, sample_rate: f64) -> Strike {
    let samples = &sound[stretch.start..stretch.end];
    let residual = found.fit.residual(samples);
    // The modes have been ringing since the onset, but the fit begins where the exciter has let go.
    let late = (stretch.start - stretch.onset) as f64;
    // The floor contains both quadratures of the noise.
    let variance = |k: usize| found.floors[k] / 2.0;
    let deviation = |k: usize, index: usize| sqrt(found.certainty.variances[k][index] * variance(k));
    let frequency = |k: usize| found.fit.poles[k].theta * sample_rate / (2.0 * PI);
    let decays = |k: &usize| {
        let decay = found.fit.poles[*k].decay;
        decay > DEVIATIONS * deviation(*k, 0) && LN_1000 / (decay * sample_rate) < ENDLESS
    };
    let (decaying, steady): (Vec<usize>, Vec<usize>) =
        (0..found.fit.poles.len()).filter(|k| frequency(*k) >= AUDIBLE).partition(decays);
    let mode = |k: usize| {
        let pole = found.fit.poles[k];
        let at_onset = |fit: &Fit| {
            let amplitude = fit.amplitudes[k];
            let level = dbfs(magnitude(amplitude)) + 20.0 / LN_10 * pole.decay * late;
            let cosine = libm::atan2(amplitude.im, amplitude.re) - pole.theta * late;
            (level, libm::remainder(cosine + 0.5 * PI, 2.0 * PI))
        };
        let (level_db, phase) = at_onset(&found.fit);
        let decay = pole.decay.max(LN_1000 / (ENDLESS * sample_rate));
        let t60 = LN_1000 / (decay * sample_rate);
        Mode {
            frequency: frequency(k),
            t60,
            level_db,
            phase,
            uncertainty: Uncertainty {
                frequency: deviation(k, 1) * sample_rate / (2.0 * PI),
                t60: deviation(k, 0) / decay * t60,
                level_db: 20.0 / LN_10 * deviation(k, 2),
                phase: deviation(k, 3),
            },
            snr_db: 10.0 * log10(found.certainty.explained[k] / variance(k).max(1e-300)),
            channels: fits.iter().flatten().map(at_onset).collect(),
        }
    };
    let by_frequency = |places: Vec<usize>| {
        let mut modes: Vec<Mode> = places.into_iter().map(mode).filter(Mode::is_finite).collect();
        modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        modes
    };
    let modes = by_frequency(decaying);
    let single = |samples: &[f64]| samples.iter().map(|sample| *sample as f32).collect();
    Strike {
        onset: stretch.onset as f64 / sample_rate,
        damped: None,
        seconds: (stretch.end - stretch.onset) as f64 / sample_rate,
        steady: by_frequency(steady),
        groups: groups(&modes),
        modes,
        residual_db: 10.0
            * log10((energy(&residual, 0.0) / energy(samples, found.fit.constant).max(1e-300)).max(1e-30)),
        samples: single(samples),
        residual: single(&residual),
        fitted_from: stretch.start as f64 / sample_rate,
    }
}

#[cfg(test)]
mod tests;
