//! A sound as it was read: samples, rate, and what was wrong with the file.

use crate::error::{Error, Result};

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
    /// What was wrong with the file and did not keep it from being read.
    pub warnings: Vec<String>,
}

impl Recording {
    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.channels.first().map_or(0, Vec::len)
    }

    /// Length in seconds.
    pub fn seconds(&self) -> f64 {
        self.frames() as f64 / f64::from(self.sample_rate)
    }

    /// Refuses samples that are infinite or not a number; `name` is what the error calls the file.
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
