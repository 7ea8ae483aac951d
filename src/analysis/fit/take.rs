//! A recording that is fitted: what is known of it, and its samples made ready.

use crate::analysis::level::{mean_of, rms};
use crate::analysis::log_mel::RATE;
use crate::error::{Error, Result};
use crate::io::sound_file::{Recording, resampled};
use crate::units::frequency_from_key;

/// A recording of one struck note.
#[derive(Clone, Debug)]
pub struct Take {
    /// What errors and the preset's comment call it.
    pub name: String,
    /// The sound, with one channel or two, at any rate.
    pub recording: Recording,
    /// The key that was struck, as a fractional MIDI key; none if it is to be estimated.
    pub key: Option<f64>,
    /// How hard it was struck, 1–127.
    pub velocity: f64,
}

/// Velocity of a take that nothing is known of, the same as that of `render`.
pub const VELOCITY: f64 = 100.0;
/// Longest stretch in seconds that is fitted.
const LONGEST: f64 = 12.0;
/// Shortest.
const SHORTEST: f64 = 0.03;
/// Quietest peak of what is no silence: −80 dBFS.
const SILENCE: f64 = 1e-4;
/// The onset is the first sample above this share of the peak.
const AUDIBLE: f32 = 0.01;
/// Seconds of a block whose level tells whether the sound is over, and that level in relation to the loudest: −64 dB.
const BLOCK: f64 = 0.03;
const OVER: f64 = 6e-4;
/// Energy of the last third of a sound over that of the first, from which on it does not decay: −3 dB.
const STEADY: f64 = 0.5;

/// Frames whose RMS is the level of a take: 50 ms.
pub(super) const LEVEL_FRAMES: usize = RATE as usize / 20;

/// A take at [`RATE`], from its onset to its end.
pub(super) struct Prepared {
    pub(super) channels: Vec<Vec<f32>>,
    /// The mean of the channels.
    pub(super) mean: Vec<f32>,
    pub(super) key: Option<f64>,
    /// 0–1.
    pub(super) velocity: f64,
    /// What is doubtful about it.
    pub(super) warning: Option<String>,
}

impl Prepared {
    /// # Errors
    /// [`Error::Format`] for silence, sounds that are too short or do not decay, and samples that are not finite.
    pub(super) fn new(take: &Take) -> Result<Self> {
        let wrong = |message: &str| Err(Error::format(&take.name, message));
        take.recording.check_finite(&take.name)?;
        let mut channels = resampled(&take.recording, RATE)?.channels;
        if channels.len() > 2 {
            channels = vec![mean(&channels)];
        }
        for channel in &mut channels {
            let constant = channel.iter().map(|sample| f64::from(*sample)).sum::<f64>() / channel.len().max(1) as f64;
            channel.iter_mut().for_each(|sample| *sample -= constant as f32);
        }
        let middle = mean(&channels);
        let peak = middle.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        if f64::from(peak) < SILENCE {
            return wrong("it is silent: expected a strike above −80 dBFS");
        }
        let onset = middle.iter().position(|sample| sample.abs() > AUDIBLE * peak).unwrap_or(0);
        let block = (BLOCK * f64::from(RATE)) as usize;
        let levels: Vec<f64> = middle[onset..].chunks(block).map(rms).collect();
        let loudest = levels.iter().copied().fold(0.0, f64::max);
        let blocks = levels.iter().rposition(|level| *level > OVER * loudest).map_or(0, |last| last + 1);
        let end = (onset + blocks * block).min(middle.len()).min(onset + (LONGEST * f64::from(RATE)) as usize);
        if ((end - onset) as f64) < SHORTEST * f64::from(RATE) {
            return wrong("it is shorter than 30 ms: expected a strike that rings");
        }
        let third = (blocks / 3).max(1);
        let energy = |levels: &[f64]| levels.iter().map(|level| level * level).sum::<f64>();
        let is_steady = blocks >= 9 && energy(&levels[blocks - third..blocks]) > STEADY * energy(&levels[..third]);
        let message = "the sound does not decay: expected something that is struck and rings; what is fitted is its mean \
                       spectrum";
        let channels: Vec<Vec<f32>> = channels.iter().map(|channel| channel[onset..end].to_vec()).collect();
        Ok(Self {
            mean: mean(&channels),
            channels,
            key: take.key,
            velocity: (take.velocity / 127.0).clamp(1.0 / 127.0, 1.0),
            warning: is_steady.then(|| format!("{}: {message}", take.name)),
        })
    }

    pub(super) fn peak(&self) -> f64 {
        self.mean.iter().fold(0.0, |peak, sample| f64::from(sample.abs()).max(peak))
    }

    /// Its length.
    pub(super) fn seconds(&self) -> f64 {
        self.mean.len() as f64 / f64::from(RATE)
    }

    /// RMS of its first 50 ms.
    pub(super) fn level(&self) -> f64 {
        rms(&self.mean[..self.mean.len().min(LEVEL_FRAMES)])
    }

    /// The frequency of a key in Hz, at the tuning of a new patch.
    pub(super) fn frequency_of(&self, key: f64) -> f64 {
        frequency_from_key(key, 440.0)
    }
}

fn mean(channels: &[Vec<f32>]) -> Vec<f32> {
    mean_of(channels).into_iter().map(|sample| sample as f32).collect()
}
