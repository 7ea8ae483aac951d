//! Measures spectra over time in 48 mel bands, which follow human hearing, and the distance between two sounds.

use super::level::SILENCE_DB;
use libm::{cos, log10, pow};
use sprung_fourier::{Complex, Forward, forward};
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Sample rate in Hz of the sounds that are measured.
pub const RATE: u32 = 44_100;
/// Number of bands.
pub(crate) const BANDS: usize = 48;
/// Samples per window.
pub(crate) const WINDOW: usize = 2048;
/// Samples from one window to the next.
pub(crate) const HOP: usize = 256;
/// Range in dB below the loudest band in which differences count.
pub(crate) const SPAN_DB: f64 = 60.0;
/// Highest frequency in Hz.
const HIGHEST: f64 = 20_000.0;
/// A sound begins at its first sample above this share of its peak.
const AUDIBLE: f32 = 0.01;

/// Levels in dB of each band, a list per window; the first window is centred on the first sample.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LogMel {
    /// The windows.
    pub columns: Vec<[f64; BANDS]>,
}

/// A planned measurement. Not real-time safe.
pub(crate) struct MelBands {
    fft: Forward,
    window: Vec<f64>,
    input: Vec<f64>,
    output: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
    /// For each band its first bin, and the weights from there.
    filters: Vec<(usize, Vec<f64>)>,
}

/// Mel of a frequency in Hz (O'Shaughnessy, "Speech Communication", 1987).
pub(super) fn mel(frequency: f64) -> f64 {
    2595.0 * log10(1.0 + frequency / 700.0)
}

/// The frequency in Hz of a number of mel.
pub(super) fn hertz(mel: f64) -> f64 {
    700.0 * (pow(10.0, mel / 2595.0) - 1.0)
}

/// The lower edge of each band in Hz. A band ends where the next but one begins.
static EDGES: LazyLock<[f64; BANDS + 2]> =
    LazyLock::new(|| std::array::from_fn(|edge| hertz(mel(HIGHEST) * edge as f64 / (BANDS + 1) as f64)));

/// The frequency in Hz at which a band weighs most.
pub(crate) fn centre(band: usize) -> f64 {
    EDGES[band + 1]
}

/// The weights of a frequency in Hz in the bands: at most two are not 0.
pub(crate) fn weights(frequency: f64) -> [f64; BANDS] {
    std::array::from_fn(|band| {
        let [low, middle, high] = [EDGES[band], EDGES[band + 1], EDGES[band + 2]];
        let rise = (frequency - low) / (middle - low);
        let fall = (high - frequency) / (high - middle);
        rise.min(fall).max(0.0)
    })
}

impl Default for MelBands {
    fn default() -> Self {
        Self::new()
    }
}

impl MelBands {
    /// Plans the measurement: Hann windows, triangular bands.
    pub(crate) fn new() -> Self {
        let fft = forward(WINDOW);
        let bin_width = f64::from(RATE) / WINDOW as f64;
        let all: Vec<[f64; BANDS]> = (0..=WINDOW / 2).map(|bin| weights(bin as f64 * bin_width)).collect();
        let filter = |band: usize| {
            let weight = |bin: usize| all[bin][band];
            let first = (0..all.len()).find(|bin| weight(*bin) > 0.0).unwrap_or(0);
            (first, (first..all.len()).map(weight).take_while(|weight| *weight > 0.0).collect())
        };
        let hann = |n: usize| 0.5 - 0.5 * cos(2.0 * PI * n as f64 / WINDOW as f64);
        Self {
            window: (0..WINDOW).map(hann).collect(),
            input: fft.make_input_vec(),
            output: fft.make_output_vec(),
            scratch: fft.make_scratch_vec(),
            filters: (0..BANDS).map(filter).collect(),
            fft,
        }
    }

    /// Measures samples at [`RATE`]. A sine of full scale in the middle of a band shows about 0 dB.
    pub(crate) fn measure(&mut self, samples: &[f32]) -> LogMel {
        let scale = 2.0 / self.window.iter().sum::<f64>();
        let mut columns = Vec::with_capacity(samples.len() / HOP + 1);
        for middle in (0..samples.len().max(1)).step_by(HOP) {
            for (n, (input, window)) in self.input.iter_mut().zip(&self.window).enumerate() {
                let sample = (middle + n).checked_sub(WINDOW / 2).and_then(|at| samples.get(at));
                *input = window * f64::from(sample.copied().unwrap_or(0.0));
            }
            let done = self.fft.process_with_scratch(&mut self.input, &mut self.output, &mut self.scratch);
            done.expect("the buffers are the transform's own");
            columns.push(std::array::from_fn(|band| {
                let (first, weights) = &self.filters[band];
                let bins = self.output[*first..].iter().zip(weights);
                let power: f64 = bins.map(|(bin, weight)| weight * bin.norm_sqr()).sum();
                (10.0 * log10(power * scale * scale)).max(SILENCE_DB)
            }));
        }
        LogMel { columns }
    }
}

/// The time in seconds of the middle of window `n`.
pub(super) fn time(n: usize) -> f64 {
    n as f64 * HOP as f64 / f64::from(RATE)
}

impl LogMel {
    /// The loudest band of all windows, in dB.
    pub(crate) fn loudest(&self) -> f64 {
        self.columns.iter().flatten().copied().fold(SILENCE_DB, f64::max)
    }

    /// Mean absolute difference from another sound in dB: see [`mean`].
    pub(crate) fn distance(&self, other: &LogMel) -> f64 {
        mean([self, other], |[a, b]| (a - b).abs())
    }

    /// How far this sound lies outside two others in dB: see [`mean`]. Where it is between them, that is 0.
    pub(crate) fn outside(&self, others: [&LogMel; 2]) -> f64 {
        mean([self, others[0], others[1]], |[own, a, b]| (a.min(b) - own).max(own - a.max(b)).max(0.0))
    }
}

/// Mean of what is measured of the levels of sounds, over all bands and windows in which at least one sound is within [`SPAN_DB`] of the
/// loudest band of all. Lower levels are raised to the lower end of that range. 0 if all are silent.
fn mean<const N: usize>(sounds: [&LogMel; N], measure: impl Fn([f64; N]) -> f64) -> f64 {
    let floor = sounds.map(LogMel::loudest).into_iter().fold(SILENCE_DB, f64::max) - SPAN_DB;
    let silence = [SILENCE_DB; BANDS];
    let (mut sum, mut count) = (0.0, 0);
    for n in 0..sounds.map(|sound| sound.columns.len()).into_iter().max().unwrap_or(0) {
        let columns = sounds.map(|sound| sound.columns.get(n).unwrap_or(&silence));
        for band in 0..BANDS {
            let levels = columns.map(|column| column[band]);
            if levels.iter().any(|level| *level > floor) {
                sum += measure(levels.map(|level| level.max(floor)));
                count += 1;
            }
        }
    }
    if count == 0 { 0.0 } else { sum / f64::from(count) }
}

/// The onset: the first sample above 1 % of the peak.
pub(super) fn onset(samples: &[f32]) -> usize {
    let peak = samples.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    samples.iter().position(|sample| sample.abs() > AUDIBLE * peak).unwrap_or(0)
}

/// The samples from the onset on, which is the first sample above 1 % of the peak.
pub(crate) fn from_onset(samples: &[f32]) -> &[f32] {
    &samples[onset(samples)..]
}

/// Distance in dB of two sounds at [`RATE`], each from its onset on: the mean difference over all bands and windows in which at
/// least one of them is within 60 dB of the loudest band of both. 0 if both are silent.
pub fn distance(first: &[f32], second: &[f32]) -> f64 {
    let mut bands = MelBands::new();
    let [first, second] = [first, second].map(|samples| bands.measure(from_onset(samples)));
    first.distance(&second)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(frequency: f64, amplitude: f64, len: usize) -> Vec<f32> {
        let sample = |n: usize| amplitude * libm::sin(2.0 * PI * frequency * n as f64 / f64::from(RATE));
        (0..len).map(|n| sample(n) as f32).collect()
    }

    #[test]
    fn a_sine_stands_in_its_band() {
        for band in [2, 20, 40] {
            let sound = MelBands::new().measure(&sine(centre(band), 0.1, 8192));
            let column = sound.columns[16];
            let loudest = (0..BANDS).max_by(|a, b| column[*a].total_cmp(&column[*b])).unwrap();
            assert!(loudest == band && (column[band] + 20.0).abs() < 3.0, "{band}: {column:?}");
        }
        assert_eq!(weights(30_000.0), [0.0; BANDS]);
        assert!((weights(1234.0).iter().sum::<f64>() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_change_of_level_is_the_distance_and_a_shift_is_none() {
        let sound = sine(1000.0, 0.5, 20_000);
        let louder: Vec<f32> = sound.iter().map(|sample| 1.122_018_5 * sample).collect();
        let found = distance(&sound, &louder);
        assert!((0.9..=1.0 + 1e-6).contains(&found), "{found}");
        let late: Vec<f32> = std::iter::repeat_n(0.0, 1000).chain(sound.iter().copied()).collect();
        assert!(distance(&sound, &late) < 1e-9);
        assert!(distance(&sound, &sine(3000.0, 0.5, 20_000)) > 10.0);
        assert_eq!(distance(&[], &[0.0; 100]), 0.0);
    }
}
