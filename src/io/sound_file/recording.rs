//! A sound read from a file: samples, rate, and warnings about faults of the file.

use crate::engine::synth::check_rate;
use crate::error::{Error, Result};

/// Most channels that a sound can have. What works on a sound takes time and memory for each of its channels, and a file of some
/// kilobytes can claim to have 65,535 of them.
pub(super) const MOST_CHANNELS: usize = 64;

/// A sound in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Frames per second.
    pub sample_rate: u32,
    /// The samples of each channel, 1.0 being full scale; all of one length. Integers of up to 24 bits are exact, longer
    /// ones and 64-bit floats are rounded to single precision.
    pub channels: Vec<Vec<f32>>,
    /// How the file stored them: `24-bit PCM`, `FLAC`.
    pub encoding: String,
    /// Faults of the file that did not prevent reading it.
    pub warnings: Vec<String>,
}

impl Recording {
    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.channels.first().map_or(0, Vec::len)
    }

    /// The mean of the channels. The sound must have this sample rate, since nothing is resampled here. `name` is the
    /// file's name in errors.
    ///
    /// # Errors
    /// [`Error::Format`] for another rate, and for samples that are not finite.
    pub(crate) fn mono_at(&self, sample_rate: u32, name: &str) -> Result<Vec<f32>> {
        if self.sample_rate != sample_rate {
            let message = format!("its rate is {} Hz: expected {sample_rate} Hz, that of the output", self.sample_rate);
            return Err(Error::format(name, message));
        }
        self.check_finite(name)?;
        let mean = |frame| self.channels.iter().map(|samples| samples[frame]).sum::<f32>() / self.channels.len() as f32;
        Ok((0..self.frames()).map(mean).collect())
    }

    /// Returns an error if the rate is not one of the engine's ([`SAMPLE_RATES`](crate::engine::SAMPLE_RATES)), or if there are no channels or
    /// more than 64. What works on a sound takes time and memory by both. `name` is the file's name in the error.
    ///
    /// # Errors
    /// [`Error::Format`] that says what would be right.
    pub fn check_layout(&self, name: &str) -> Result<()> {
        check_layout(self.sample_rate, self.channels.len()).map_err(|message| Error::format(name, message))
    }

    /// Returns an error if a sample is infinite or not a number; `name` is the file's name in the error.
    ///
    /// # Errors
    /// [`Error::Format`] that names the first of them.
    pub fn check_finite(&self, name: &str) -> Result<()> {
        for frame in 0..self.frames() {
            for (channel, samples) in self.channels.iter().enumerate() {
                let sample = samples[frame];
                if !sample.is_finite() {
                    let message = format!(
                        "frame {frame} ({:.3} s) of channel {} is {}: expected finite samples",
                        frame as f64 / f64::from(self.sample_rate),
                        channel + 1,
                        if sample.is_nan() { "not a number" } else { "infinite" },
                    );
                    return Err(Error::format(name, message));
                }
            }
        }
        Ok(())
    }
}

/// Checks a rate in Hz and a number of channels. The error says what would be right.
pub(super) fn check_layout(sample_rate: u32, channels: usize) -> std::result::Result<(), String> {
    check_rate(sample_rate).map_err(|message| format!("its sample rate of {message}"))?;
    if !(1..=MOST_CHANNELS).contains(&channels) {
        return Err(format!("it has {channels} channels: expected 1 to {MOST_CHANNELS}"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mono_sound_is_the_mean_of_the_channels_at_its_own_rate() {
        let sound = |channels: Vec<Vec<f32>>| Recording {
            sample_rate: 48_000,
            channels,
            encoding: "float".to_owned(),
            warnings: vec![],
        };
        assert_eq!(sound(vec![vec![-1.0, 0.5], vec![0.0, 0.5]]).mono_at(48_000, "a").unwrap(), [-0.5, 0.5]);
        let error = sound(vec![vec![0.0]]).mono_at(44_100, "a").unwrap_err().to_string();
        assert_eq!(error, "a: its rate is 48000 Hz: expected 44100 Hz, that of the output");
        assert!(sound(vec![vec![f32::NAN]]).mono_at(48_000, "a").unwrap_err().to_string().contains("not a number"));
    }
}
