//! A recording to fit, with its key and velocity, and the part of it that is used.

use crate::analysis::level::{cancelling, mono, offset, peak};
use crate::analysis::log_mel::onset;
use crate::dsp::limiter::THRESHOLD;
use crate::error::Result;
use crate::io::sound_file::Recording;

/// A recording of one struck note.
#[derive(Clone, Debug)]
pub struct Take {
    /// Its name in errors and in the preset's comment.
    pub name: String,
    /// The sound, with one channel or two, at any rate.
    pub recording: Recording,
    /// The key that was struck, as a fractional MIDI key; none if it is to be estimated.
    pub key: Option<f64>,
    /// How hard it was struck, 1–127.
    pub velocity: f64,
}

/// Velocity of a take of unknown velocity, the same as that of `render`.
pub const VELOCITY: f64 = 100.0;
/// Longest stretch in seconds that is fitted.
pub(super) const LONGEST: f64 = 12.0;
/// Seconds before the onset and after the longest stretch that are kept, since resampling needs both sides of a sample.
const BEFORE: f64 = 0.05;
const AFTER: f64 = 0.1;
/// Seconds per block of levels.
pub(super) const BLOCK: f64 = 0.03;

/// The excerpts of some takes, and the gain that brings the loudest of them to where a preset's limiter begins; 1 if none is beyond.
///
/// # Errors
/// [`Error::Format`](crate::Error::Format) for samples that are not finite.
pub(super) fn excerpts(takes: &[Take]) -> Result<(Vec<Recording>, f64)> {
    takes.iter().try_for_each(|take| take.recording.check_finite(&take.name))?;
    let excerpts: Vec<Recording> = takes.iter().map(|take| excerpt(&take.recording)).collect();
    let limit = f64::from(THRESHOLD);
    let loudest =
        excerpts.iter().flat_map(|excerpt| &excerpt.channels).map(|channel| peak(channel)).fold(limit, f64::max);
    Ok((excerpts, limit / loudest))
}

/// A recording from shortly before its onset on, as long as is needed, without a constant; one channel or two. Of channels that cancel, it
/// is the loudest.
fn excerpt(recording: &Recording) -> Recording {
    let mut channels = match recording.channels.len() {
        0..=2 => match cancelling(&recording.channels) {
            Some(loudest) => vec![recording.channels[loudest].clone()],
            None => recording.channels.clone(),
        },
        _ => vec![mono(&recording.channels)],
    };
    for channel in &mut channels {
        let constant = offset(channel, (BLOCK * f64::from(recording.sample_rate)) as usize);
        channel.iter_mut().for_each(|sample| *sample -= constant as f32);
    }
    let middle = mono(&channels);
    let onset = onset(&middle);
    let frames = |seconds: f64| (seconds * f64::from(recording.sample_rate)) as usize;
    let kept = onset.saturating_sub(frames(BEFORE))..middle.len().min(onset + frames(LONGEST + AFTER));
    if kept.len() < middle.len() {
        channels.iter_mut().for_each(|channel| *channel = channel[kept.clone()].to_vec());
    }
    Recording { sample_rate: recording.sample_rate, channels, encoding: String::new(), warnings: Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: u32 = 8000;

    /// A take of one channel at [`RATE`].
    fn take(name: &str, seconds: f64, at: impl Fn(f64) -> f64) -> Take {
        let channel =
            (0..(seconds * f64::from(RATE)) as usize).map(|n| at(n as f64 / f64::from(RATE)) as f32).collect();
        let recording =
            Recording { sample_rate: RATE, channels: vec![channel], encoding: String::new(), warnings: Vec::new() };
        Take { name: name.to_owned(), recording, key: None, velocity: 100.0 }
    }

    fn ringing(t: f64) -> f64 {
        if t < 0.0 { 0.0 } else { libm::exp(-6.9 * t / 3.0) * libm::cos(2765.0 * t) }
    }

    #[test]
    fn little_of_a_long_recording_is_kept() {
        let kept = excerpt(&take("a", 600.0, |t| ringing(t - 300.0)).recording);
        assert!(kept.frames() < 13 * RATE as usize, "{}", kept.frames());
    }

    #[test]
    fn of_channels_that_cancel_one_is_kept() {
        let mut recording = take("a", 1.0, ringing).recording;
        recording.channels.push(recording.channels[0].iter().map(|sample| -0.99 * sample).collect());
        assert_eq!(excerpt(&recording).channels, recording.channels[..1]);
        recording.channels[1].iter_mut().for_each(|sample| *sample *= -1.0);
        assert_eq!(excerpt(&recording).channels.len(), 2);
    }

    #[test]
    fn takes_are_as_loud_as_the_limiter_lets_pass() {
        let of = |takes: &[Take]| excerpts(takes).unwrap().1;
        let quiet = || take("quiet", 2.0, |t| 0.8 * ringing(t) + 0.4);
        // A constant and what comes after twelve seconds do not count.
        assert_eq!(of(&[quiet(), take("click", 60.0, |t| ringing(t) * 0.5 + if t > 50.0 { 3.0 } else { 0.0 })]), 1.0);
        let gain = of(&[quiet(), take("loud", 2.0, |t| 3.6 * ringing(t))]);
        assert!((gain - 0.25).abs() < 0.001, "{gain}");
        let broken = [quiet(), take("broken", 2.0, |t| if t > 1.0 { f64::INFINITY } else { ringing(t) })];
        assert!(excerpts(&broken).unwrap_err().to_string().starts_with("broken: frame"));
    }
}
