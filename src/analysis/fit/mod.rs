//! Fits a preset to recordings of a struck sound, which it then plays over the keyboard.
//!
//! The sweep of the pitch is found and removed; of a held sound, all drift that its tones have in common. The sound,
//! whose pitch is now constant, is analysed into modes. Their residual becomes a bed: modes that noise excites. If
//! modes explain a sound badly, another draft has noise in place of a strike, and its modes are looked for after the
//! first fifth of the sound; and regular movement becomes that of low-frequency oscillators. Then each draft is played
//! and compared with the recording, band by band ([`super::log_mel`]), to correct the mallet's hardness, the rise, fall
//! and length of swells and of noise, levels and decays. The nearest draft is the result.
//!
//! | file | does |
//! |---|---|
//! | `take`, `names`, `prepared`, `release` | reads a take: its key and velocity, its onset and end, and where its key is let go |
//! | `pitch`, `tones`, `pitch_track`, `sweep`, `drift`, `held`, `resample` | the pitch over time, and the sound without its movement |
//! | `start`, `bed`, `oscillators`, `movement` | first drafts: modes, noise for the rest, LFOs |
//! | `draft`, `audition` | a draft as a patch; plays it |
//! | `candidates`, `improve`, `refine`, `correct`, `shaping` | the possible drafts, and their corrections by what they sound like |
//! | `body`, `levels`, `tuned` | a physical model in place of a table of modes |
//! | `layers` | how the sound follows velocity and key |
//! | `warnings`, `summary`, `report` | warnings, words and the page that tell the result |
//! | `like` | the presets that sound most like a recording |
//! | `simplex` | minimises a function of a few numbers |

mod audition;
mod bed;
mod body;
mod candidates;
mod correct;
mod draft;
mod drift;
mod held;
mod improve;
mod layers;
mod levels;
mod like;
mod movement;
mod names;
mod oscillators;
mod pitch;
mod pitch_track;
mod prepared;
mod refine;
mod release;
#[cfg(feature = "analysis")]
pub mod report;
mod resample;
mod shaping;
mod simplex;
mod start;
mod summary;
mod sweep;
mod take;
mod tones;
mod tuned;
mod warnings;

pub use body::{Explained, Family};
pub use like::{LOOKED_AT, Model, Nearness};
pub use names::take_velocities_from_names;
pub use release::Release;
pub use take::{Take, VELOCITY};

use super::level::rms;
use super::log_mel::{self, RATE};
use super::modes::Strike;
use crate::error::{Error, Result};
use crate::patch::Patch;
use crate::preset::{Guide, Preset};
use audition::{Audition, Played};
use draft::MOST_MODES;
use layers::Layer;
use prepared::Prepared;

/// Share of the work that is done when only the release is left to be fitted.
const LAST: f64 = 0.98;

/// Settings of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Maximum number of modes, 1–256, including the bed of modes that noise excites.
    pub most_modes: usize,
    /// The kind of body that is to explain the modes.
    pub family: Family,
}

impl Default for Settings {
    fn default() -> Self {
        Self { most_modes: 192, family: Family::Table }
    }
}

/// The result of a fit.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The patch.
    pub patch: Patch,
    /// Index of the take whose sound the patch has. Velocity and key tracking come from all takes.
    pub base: usize,
    /// The key that this take was recorded on, as a fractional MIDI key: its own, or the estimated one.
    pub key: f64,
    /// Whether the key was estimated.
    pub is_estimated: bool,
    /// Distance of the patch's sound from each recording in dB ([`super::log_mel::distance`]).
    pub distances: Vec<f64>,
    /// The base take from its onset on, at [`super::log_mel::RATE`], a list per channel. If a take goes beyond the threshold of the
    /// limiter, all are softer by the same gain, in which they are fitted.
    pub recording: Vec<Vec<f32>>,
    /// The same note played by the patch, left and right.
    pub played: [Vec<f32>; 2],
    /// The strike in which the modes were found, if there are any. Its frequencies are those after the sweep.
    pub strike: Option<Strike>,
    /// When the key of the base take is let go, if that is heard in it. The patch was played so, and its damper fitted.
    pub release: Option<Release>,
    /// How well a body explains the modes, if one was asked for.
    pub explained: Option<Explained>,
    /// Doubts about the recordings and the result.
    pub warnings: Vec<String>,
}

/// Fits recordings of one instrument. Several takes of a key give the response to velocity; several keys give the
/// response of decay and loudness to the key. `progress` is called with the share of the work that is done, and cancels
/// the fit by returning `false`. Not real-time safe: a take needs seconds, a long held one up to two minutes.
///
/// # Errors
/// [`Error::Value`] without takes, [`Error::Format`] for one that is silent, too short or not finite, or has no modes
/// although a body is to explain them; [`Error::Interrupted`].
///
/// ```no_run
/// use sprung::analysis::fit::{Settings, Take, VELOCITY, fit};
/// use sprung::io::sound_file;
/// use std::fs::File;
///
/// # fn main() -> sprung::Result<()> {
/// let file = File::open("marimba.wav").map_err(|error| sprung::Error::io("marimba.wav", error))?;
/// let recording = sound_file::read(file, "marimba.wav")?;
/// let take = Take { name: "marimba.wav".to_owned(), recording, key: Some(60.0), velocity: VELOCITY };
/// let fitted = fit(&[take], &Settings::default(), &mut |_| true)?;
/// println!("{:.1} dB off", fitted.distances[0]);
/// print!("{}", fitted.preset("Marimba", "Fitted to marimba.wav.").to_toml());
/// # Ok(())
/// # }
/// ```
pub fn fit(takes: &[Take], settings: &Settings, progress: &mut dyn FnMut(f64) -> bool) -> Result<Fitted> {
    if takes.is_empty() {
        return Err(Error::value("recordings", "there are none: expected at least one"));
    }
    let (excerpts, gain) = take::excerpts(takes)?;
    let prepare = |(take, excerpt)| Prepared::new(take, excerpt, gain);
    let mut prepared: Vec<Prepared> = takes.iter().zip(&excerpts).map(prepare).collect::<Result<_>>()?;
    // Tuning a body takes about as long as a take.
    let count = takes.len() as f64 + if settings.family == Family::Table { 0.0 } else { 1.0 };
    let mut tell = |share: f64| progress(LAST * share);
    let mut fits = Vec::new();
    for (n, take) in prepared.iter_mut().enumerate() {
        let most = settings.most_modes.clamp(1, MOST_MODES);
        let mut tell = |share| tell((n as f64 + share) / count);
        let (mut draft, strike) = improve::fit(take, most, &mut tell)?;
        // Of several takes, those that are let go tell how the others end.
        let fallen = if takes.len() == 1 { improve::fallen(take, &draft, &mut tell)? } else { None };
        if let Some(fallen) = fallen {
            (*take, draft) = fallen;
        }
        fits.push((draft, strike));
    }
    let layer = |((draft, _), take): (&(draft::Draft, _), &Prepared)| Layer {
        draft: draft.clone(),
        level: take.level(),
        t60: take.t60(),
    };
    let mut layers: Vec<Layer> = fits.iter().zip(&prepared).map(layer).collect();
    let base = layers::base(&layers);
    let follow = layers::follow(&layers, base);
    layers[base].draft.follow = follow;
    let (take, draft) = (&prepared[base], layers[base].draft.clone());
    let (patch, explained) = match settings.family {
        Family::Table => (draft.patch(), None),
        family => {
            let strike = fits[base].1.as_ref();
            let (body, levels, explained) = body::find(&draft, strike, family).ok_or_else(|| {
                Error::format(
                    &takes[base].name,
                    "no mode rings in it: expected a sound that a body can explain, or the body table",
                )
            })?;
            let told = &mut |share| tell((takes.len() as f64 + share) / count);
            (tuned::patch(&draft, &body, &levels, take, draft.key(), told)?, Some(explained))
        }
    };
    let (mut audition, key) = (Audition::new(), draft.key());
    let patch = layers::route(patch, &layers, base);
    let patch = layers::route_gain(patch, &layers, base, &mut |patch, layer| {
        let (key, velocity) = (layer.key(), layer.draft.velocity);
        rms(&audition.mean(patch, Played { key, velocity, frames: prepared::LEVEL_FRAMES, let_go: None }))
    });
    // From here on, what is measured is what a player hears: the limiter is on.
    let mut heard = Audition::with_limiter();
    let (mut patch, mut release) = (patch, None);
    if let Some(ending) = &take.ending {
        let (damped, found) =
            ending.release.tuned(&patch, &ending.mean, (key, draft.velocity), &mut || progress(LAST))?;
        // What falls by itself, or comes back, is nearer without.
        let mut distance = |patch: &Patch, let_go| {
            let note = Played { key, velocity: draft.velocity, frames: ending.mean.len(), let_go };
            log_mel::distance(&heard.mean(patch, note), &ending.mean)
        };
        if distance(&damped, Some(found.frames())) <= distance(&patch, None) {
            (patch, release) = (damped, Some(found));
        }
    }
    let (_, whole) = take.whole();
    let let_go = release.map(|release| release.frames());
    let played = heard.play(&patch, Played { key, velocity: draft.velocity, frames: whole.len(), let_go });
    let distance = |(index, (layer, take)): (usize, (&Layer, &Prepared))| {
        let key = layer.key();
        let (_, whole) = take.whole();
        let own = take.ending.as_ref().map(|ending| ending.release);
        let let_go = if index == base { release } else { own }.map(|release| release.frames());
        let note = Played { key, velocity: take.velocity, frames: whole.len(), let_go };
        log_mel::distance(&heard.mean(&patch, note), whole)
    };
    let distances: Vec<f64> = layers.iter().zip(&prepared).enumerate().map(distance).collect();
    let mut warnings: Vec<String> = prepared.iter().flat_map(|take| take.warnings.clone()).collect();
    warnings.extend(warnings::softer(takes, gain));
    warnings.extend(warnings::of_takes(takes, &layers));
    let each = takes.iter().zip(&fits);
    warnings.extend(each.filter_map(|(take, (draft, strike))| warnings::hum(take, draft, strike.as_ref()?)));
    if draft.partials.iter().all(|partial| !partial.struck) {
        let guess = if take.key.is_none() { ", and its pitch is a guess" } else { "" };
        let message = "it was fitted as noise, as no mode that is struck comes nearer";
        warnings.push(format!("{}: {message}{guess}", takes[base].name));
    }
    warnings.extend(warnings::of_distances(takes, &distances, base, explained.is_some()));
    if !progress(1.0) {
        return Err(Error::Interrupted);
    }
    Ok(Fitted {
        patch,
        base,
        key,
        is_estimated: take.key.is_none(),
        distances,
        recording: take.whole().0.to_vec(),
        played,
        strike: fits.swap_remove(base).1,
        release,
        explained,
        warnings,
    })
}

impl Fitted {
    /// The preset. Allocates.
    pub fn preset(&self, name: &str, comment: &str) -> Preset {
        Preset {
            tags: vec!["fitted".to_owned()],
            comment: comment.to_owned(),
            guide: Guide { home: self.key.round().clamp(0.0, 127.0) as u8, ..Guide::default() },
            ..Preset::new(name, self.patch.clone())
        }
    }

    /// Sample rate in Hz of its sounds.
    pub(crate) fn sample_rate(&self) -> f64 {
        RATE.into()
    }
}
