//! Spectra: windowed magnitudes, their peaks, spectrograms and octave band levels.

use super::level::{SILENCE_DB, dbfs};
use libm::{cos, hypot, log10};
use sprung_fourier::{Complex, Forward, forward};
use std::f64::consts::PI;

/// Centres in Hz of the octaves that [`band_levels`] measures.
pub(crate) const BAND_CENTRES: [f64; 8] = [62.5, 125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0];

/// Magnitudes of the bins from 0 Hz to Nyquist, in dB: a full-scale sine shows 0 dB.
#[derive(Clone, Debug)]
pub struct Spectrum {
    /// Hz from one bin to the next.
    pub bin_width: f64,
    /// One level per bin, never below `SILENCE_DB`.
    pub levels: Vec<f64>,
}

/// A local maximum of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Hz, interpolated by the parabola through the levels of three bins.
    pub frequency: f64,
    /// dB, at the vertex of that parabola.
    pub(crate) level: f64,
}

/// Spectra of overlapping stretches.
#[derive(Clone, Debug)]
pub(crate) struct Spectrogram {
    /// Hz from one bin to the next.
    pub bin_width: f64,
    /// Seconds from one column to the next.
    pub hop_seconds: f64,
    /// Levels as in [`Spectrum::levels`], one list per column; the first column is centred on the first sample.
    pub columns: Vec<Vec<f64>>,
}

/// A planned transform with its window and buffers.
struct Transform {
    fft: Forward,
    window: Vec<f64>,
    input: Vec<f64>,
    output: Vec<Complex<f64>>,
}

impl Transform {
    fn new(window: Vec<f64>, length: usize) -> Self {
        let fft = forward(length);
        Self { input: fft.make_input_vec(), output: fft.make_output_vec(), fft, window }
    }

    /// Transforms a window of samples that begins at `start`. Samples outside the signal count as 0.
    fn run(&mut self, samples: &[f32], start: isize) -> &[Complex<f64>] {
        self.input.fill(0.0);
        for (n, (input, window)) in self.input.iter_mut().zip(&self.window).enumerate() {
            let sample = start.checked_add_unsigned(n).and_then(|index| samples.get(usize::try_from(index).ok()?));
            *input = window * f64::from(sample.copied().unwrap_or(0.0));
        }
        self.fft.process(&mut self.input, &mut self.output).expect("the buffers are the transform's own");
        &self.output
    }

    /// As [`Transform::run`], in dB.
    fn levels(&mut self, samples: &[f32], start: isize) -> Vec<f64> {
        let scale = 2.0 / self.window.iter().sum::<f64>();
        self.run(samples, start).iter().map(|bin| dbfs(hypot(bin.re, bin.im) * scale)).collect()
    }
}

/// Spectrum of all of `samples` under one window.
pub fn spectrum(samples: &[f32], sample_rate: f64) -> Spectrum {
    let length = samples.len().next_power_of_two().max(16);
    let mut transform = Transform::new(blackman_harris(samples.len().max(1)), length);
    Spectrum { bin_width: sample_rate / length as f64, levels: transform.levels(samples, 0) }
}

/// Spectra of windows of `length` samples (raised to an even number of at least 16), `hop` samples apart.
pub(crate) fn spectrogram(samples: &[f32], sample_rate: f64, length: usize, hop: usize) -> Spectrogram {
    let (length, hop) = (length.max(16).next_multiple_of(2), hop.max(1));
    let mut transform = Transform::new(blackman_harris(length), length);
    let columns = (0..samples.len().max(1))
        .step_by(hop)
        .map(|centre| transform.levels(samples, centre as isize - (length / 2) as isize))
        .collect();
    Spectrogram { bin_width: sample_rate / length as f64, hop_seconds: hop as f64 / sample_rate, columns }
}

/// The local maxima above `floor` dB, loudest first.
pub fn peaks(spectrum: &Spectrum, floor: f64) -> Vec<Peak> {
    let mut found: Vec<Peak> = spectrum
        .levels
        .windows(3)
        .enumerate()
        .filter(|(_, levels)| levels[1] > floor && levels[1] > levels[0] && levels[1] >= levels[2])
        .map(|(index, levels)| {
            let curvature = levels[0] - 2.0 * levels[1] + levels[2];
            let offset = 0.5 * (levels[0] - levels[2]) / curvature;
            Peak {
                frequency: (index as f64 + 1.0 + offset) * spectrum.bin_width,
                level: levels[1] - 0.25 * (levels[0] - levels[2]) * offset,
            }
        })
        .collect();
    found.sort_by(|a, b| b.level.total_cmp(&a.level));
    found
}

/// RMS level in dBFS of each octave of [`BAND_CENTRES`] (from centre/√2 to centre·√2) over all of `samples`; octaves
/// above Nyquist have [`SILENCE_DB`].
pub(crate) fn band_levels(samples: &[f32], sample_rate: f64) -> [f64; 8] {
    // At most 6 Hz per bin, so that the lowest octave has at least seven bins.
    let length = ((sample_rate / 6.0) as usize).clamp(64, 1 << 20).next_power_of_two();
    // Hann windows a quarter of a length apart, the first of which ends a quarter of a length into the samples: the
    // squares of the four windows over each sample add up to 3/2, so that all samples have the same weight.
    let hann = (0..length).map(|n| 0.5 - 0.5 * cos(2.0 * PI * n as f64 / length as f64)).collect();
    let mut transform = Transform::new(hann, length);
    let mut energies = [0.0; 8];
    let hop = length / 4;
    for end in (hop..samples.len() + length).step_by(hop) {
        let bins = transform.run(samples, end as isize - length as isize);
        for (bin, value) in bins.iter().enumerate().skip(1) {
            let frequency = bin as f64 * sample_rate / length as f64;
            let sqrt_2 = std::f64::consts::SQRT_2;
            let band = BAND_CENTRES.iter().position(|c| (c / sqrt_2..c * sqrt_2).contains(&frequency));
            if let Some(band) = band {
                energies[band] += value.norm_sqr();
            }
        }
    }
    // Parseval's theorem; each bin but the first and last stands for two of the full transform.
    let scale = 2.0 / (1.5 * length as f64 * samples.len().max(1) as f64);
    energies.map(|energy| (10.0 * log10(energy * scale)).max(SILENCE_DB))
}

/// Four-term window of −92 dB side lobes (F. J. Harris, "On the Use of Windows for Harmonic Analysis with the
/// Discrete Fourier Transform", 1978, table 1).
fn blackman_harris(length: usize) -> Vec<f64> {
    let term = |k: f64, n: usize| cos(2.0 * PI * k * n as f64 / length as f64);
    (0..length)
        .map(|n| 0.358_75 - 0.488_29 * term(1.0, n) + 0.141_28 * term(2.0, n) - 0.011_68 * term(3.0, n))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(frequency: f64, amplitude: f64, sample_rate: f64, len: usize) -> Vec<f32> {
        let sample = |n: usize| amplitude * libm::sin(2.0 * PI * frequency * n as f64 / sample_rate);
        (0..len).map(|n| sample(n) as f32).collect()
    }

    #[test]
    fn peaks_stand_where_the_sines_are() {
        let mut samples = sine(1000.3, 0.5, 48_000.0, 30_000);
        for (sample, quiet) in samples.iter_mut().zip(sine(5000.0, 0.005, 48_000.0, 30_000)) {
            *sample += quiet;
        }
        let found = peaks(&spectrum(&samples, 48_000.0), -80.0);
        assert_eq!(found.len(), 2, "{found:?}");
        for (peak, frequency, level) in [(found[0], 1000.3, -6.02), (found[1], 5000.0, -46.02)] {
            assert!((peak.frequency - frequency).abs() < 0.1 && (peak.level - level).abs() < 0.1, "{peak:?}");
        }
    }

    #[test]
    fn bands_hold_the_energy_that_is_in_them() {
        for sample_rate in [8000.0, 44_100.0, 192_000.0] {
            for (band, centre) in BAND_CENTRES.into_iter().enumerate().filter(|(_, c)| *c < 0.49 * sample_rate) {
                let levels = band_levels(&sine(centre, 0.5, sample_rate, sample_rate as usize), sample_rate);
                let expected = 20.0 * log10(0.5 / libm::sqrt(2.0));
                assert!((levels[band] - expected).abs() < 0.05, "{centre} Hz at {sample_rate} Hz: {levels:?}");
                let louder = levels.iter().filter(|level| **level > expected - 25.0).count();
                assert_eq!(louder, 1, "{centre} Hz at {sample_rate} Hz: {levels:?}");
            }
        }
        assert_eq!(band_levels(&[], 48_000.0), [SILENCE_DB; 8]);
    }

    #[test]
    fn a_spectrogram_follows_the_sound_in_time() {
        let mut samples = vec![0.0; 4800];
        samples.extend(sine(2000.0, 1.0, 48_000.0, 4800));
        let grams = spectrogram(&samples, 48_000.0, 1024, 480);
        let level = |column: usize| grams.columns[column][(2000.0 / grams.bin_width).round() as usize];
        assert_eq!(grams.columns.len(), 20);
        assert!(level(3) <= -100.0 && level(15) > -1.0, "{} {}", level(3), level(15));
    }

    #[test]
    fn nothing_is_silence() {
        assert!(spectrum(&[], 48_000.0).levels.iter().all(|level| *level == SILENCE_DB));
        assert!(peaks(&spectrum(&[0.0; 100], 48_000.0), -200.0).is_empty());
        assert_eq!(spectrogram(&[], 48_000.0, 64, 0).columns.len(), 1);
    }
}
