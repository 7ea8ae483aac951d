//! Levels of a signal: peak, RMS and programme loudness.

use crate::error::{Error, Result};
use ebur128::{EbuR128, Mode};

/// Measures a signal block by block. Memory use does not grow with the length: loudness is kept as a histogram of
/// gating blocks in steps of 0.1 LU.
pub struct Meter {
    channels: usize,
    peak: f32,
    sum_of_squares: f64,
    samples: u64,
    non_finite: u64,
    loudness: EbuR128,
}

/// The levels that a [`Meter`] has measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Levels {
    /// Largest absolute sample that is finite; 1 is full scale.
    pub peak: f64,
    /// Root of the mean square over all samples of all channels; samples that are not finite count as 0.
    pub rms: f64,
    /// Integrated loudness in LUFS (ITU-R BS.1770, EBU R 128), to about 0.1 LU. `None` for silence, for less than 400
    /// ms, and if a sample is not finite.
    pub lufs: Option<f64>,
    /// Samples that are infinite or not a number.
    pub non_finite: u64,
}

impl Levels {
    /// The same levels, plus a number of samples that were not finite before a limiter replaced them by 0.
    pub(crate) fn with_non_finite(mut self, more: u64) -> Self {
        self.non_finite += more;
        self.lufs = self.lufs.filter(|_| self.non_finite == 0);
        self
    }
}

impl Meter {
    /// A meter of one or two channels.
    ///
    /// # Errors
    /// [`Error::Value`] for a sample rate at which loudness is not defined.
    pub fn new(sample_rate: u32, channels: u16) -> Result<Self> {
        let loudness = EbuR128::new(channels.into(), sample_rate, Mode::I | Mode::HISTOGRAM)
            .map_err(|error| Error::value("loudness", error.to_string()))?;
        Ok(Self { channels: channels.into(), peak: 0.0, sum_of_squares: 0.0, samples: 0, non_finite: 0, loudness })
    }

    /// Measures a block. With one channel, only `left` is used.
    ///
    /// # Errors
    /// [`Error::Value`] if the loudness meter runs out of memory.
    pub fn add(&mut self, left: &[f32], right: &[f32]) -> Result<()> {
        let channels = &[left, right][..self.channels];
        for frame in 0..left.len() {
            for channel in channels {
                let sample = channel[frame];
                if !sample.is_finite() {
                    self.non_finite += 1;
                    continue;
                }
                self.peak = self.peak.max(sample.abs());
                self.sum_of_squares += f64::from(sample) * f64::from(sample);
            }
        }
        self.samples += (left.len() * self.channels) as u64;
        self.loudness.add_frames_planar_f32(channels).map_err(|error| Error::value("loudness", error.to_string()))
    }

    /// The levels of all blocks so far.
    pub fn levels(&self) -> Levels {
        let rms = if self.samples == 0 { 0.0 } else { (self.sum_of_squares / self.samples as f64).sqrt() };
        let lufs = self.loudness.loudness_global().ok().filter(|lufs| lufs.is_finite() && self.non_finite == 0);
        Levels { peak: self.peak.into(), rms, lufs, non_finite: self.non_finite }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(frames: usize, amplitude: f64) -> Vec<f32> {
        let theta = std::f64::consts::TAU * 997.0 / 48_000.0;
        (0..frames).map(|n| (amplitude * libm::sin(theta * n as f64)) as f32).collect()
    }

    #[test]
    fn a_sine_measures_as_the_standards_say() {
        // EBU Tech 3341, test 1: a 1 kHz sine of -23 dBFS peak in both channels is -23 LUFS.
        let amplitude = crate::units::gain_from_db(-23.0);
        let signal = sine(48_000 * 5, amplitude);
        let mut meter = Meter::new(48_000, 2).unwrap();
        for block in signal.chunks(1000) {
            meter.add(block, block).unwrap();
        }
        let levels = meter.levels();
        assert!((levels.lufs.unwrap() + 23.0).abs() < 0.1, "{levels:?}");
        assert!((levels.peak / amplitude - 1.0).abs() < 1e-4, "{levels:?}");
        assert!((levels.rms / amplitude - std::f64::consts::FRAC_1_SQRT_2).abs() < 1e-4, "{levels:?}");
    }

    #[test]
    fn silence_and_snippets_have_no_loudness() {
        let mut meter = Meter::new(48_000, 1).unwrap();
        assert_eq!(meter.levels(), Levels { peak: 0.0, rms: 0.0, lufs: None, non_finite: 0 });
        meter.add(&sine(19_000, 0.5), &[]).unwrap();
        assert_eq!(meter.levels().lufs, None);
        meter.add(&sine(1_000, 0.5), &[]).unwrap();
        assert!(meter.levels().lufs.is_some());
    }

    #[test]
    fn samples_that_are_not_finite_are_counted_and_leave_the_levels_alone() {
        let mut meter = Meter::new(48_000, 2).unwrap();
        let mut signal = sine(48_000, 0.5);
        let silence = vec![0.0; signal.len()];
        meter.add(&signal, &silence).unwrap();
        let finite = meter.levels();
        assert_eq!(finite.non_finite, 0);
        (signal[3], signal[4], signal[5]) = (f32::NAN, f32::INFINITY, f32::NEG_INFINITY);
        let mut meter = Meter::new(48_000, 2).unwrap();
        meter.add(&signal, &silence).unwrap();
        let levels = meter.levels();
        assert_eq!((levels.non_finite, levels.lufs, levels.peak), (3, None, finite.peak));
        assert!((levels.rms / finite.rms - 1.0).abs() < 1e-3, "{levels:?}");
    }
}
