//! The tones of a sound: peaks of its mean spectrum, each with the track of its pitch and level.

use crate::analysis::line::Line;
use crate::analysis::log_mel::RATE;
use libm::{atan2, cos, log, log10, sin};
use sprung_fourier::forward;
use std::f64::consts::TAU;

/// Samples from one moment of a track to the next.
pub(super) const HOP: usize = 128;
/// Samples per window of the mean spectrum, and points of its transform.
const WINDOW: usize = 4096;
const POINTS: usize = 2 * WINDOW;
/// Samples per window through which a tone is followed: it passes 22 Hz to both sides.
const FOLLOWED: usize = 2048;
/// Bins to each side among which a tone is the highest: 27 Hz.
const APART: usize = 5;
/// Least depth in dB of the valleys beside a tone, and greatest distance in dB from the strongest one.
const VALLEY_DB: f64 = 10.0;
const FAINT_DB: f64 = 55.0;
const MOST: usize = 64;

/// A tone and its track.
pub(super) struct Tone {
    /// Hz.
    pub(super) frequency: f64,
    /// Real and imaginary part of its amplitude at each moment, relative to a steady tone, with a weight: its power, up to the mean.
    track: Vec<([f64; 2], f64)>,
    /// Cycles of the tone from one moment to the next.
    turns: f64,
}

impl Tone {
    /// The tone near a frequency in Hz in samples at [`RATE`].
    pub(super) fn of(samples: &[f32], frequency: f64) -> Self {
        let followed = followed(samples, frequency);
        let power = |[re, im]: [f64; 2]| re * re + im * im;
        let mean = followed.iter().map(|own| power(*own)).sum::<f64>() / followed.len() as f64 + 1e-30;
        let track = followed.into_iter().map(|own| (own, (power(own) / mean).min(1.0))).collect();
        Self { frequency, track, turns: frequency * HOP as f64 / f64::from(RATE) }
    }

    /// The logarithm of its pitch at each moment, with its weight.
    pub(super) fn pitches(&self) -> Vec<[f64; 2]> {
        let last = self.track.len() - 1;
        let pitch = |n: usize| {
            let (before, after) = (n.saturating_sub(1), (n + 1).min(last));
            let (a, b) = (self.track[before].0, self.track[after].0);
            let turn = atan2(b[1] * a[0] - b[0] * a[1], b[0] * a[0] + b[1] * a[1]) / TAU;
            [turn / self.turns / (after - before).max(1) as f64, self.track[n].1]
        };
        (0..=last).map(pitch).collect()
    }

    /// Its mean frequency in Hz.
    pub(super) fn mean_frequency(&self) -> f64 {
        let (sum, all) = self
            .pitches()
            .iter()
            .fold((0.0, 1e-12), |(sum, all), [pitch, weight]| (sum + pitch * weight, all + weight));
        self.frequency * (1.0 + sum / all)
    }

    /// The line through the logarithm of its level from a moment on: the value at moment 0, and the change per moment; none if
    /// the sound is over before.
    pub(super) fn line(&self, from: usize) -> Option<[f64; 2]> {
        // Windows that reach beyond the end show a fall.
        let whole = self.track.len().saturating_sub(FOLLOWED / 2 / HOP);
        let points =
            self.levels().into_iter().enumerate().take(whole).skip(from).map(|(n, [level, _])| [n as f64, level, 1.0]);
        let line = Line::through(points)?;
        let line = Line { slope: line.slope.min(0.0), ..line };
        Some([line.at(0.0), line.slope])
    }

    /// The logarithm of its level at each moment, with its weight.
    pub(super) fn levels(&self) -> Vec<[f64; 2]> {
        let level = |([re, im], weight): &([f64; 2], f64)| [0.5 * log((re * re + im * im).max(1e-24)), *weight];
        self.track.iter().map(level).collect()
    }
}

/// The tones of samples at [`RATE`], followed every [`HOP`] samples.
pub(super) fn tones(samples: &[f32]) -> Vec<Tone> {
    let levels = mean_spectrum(samples);
    let loudest = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let is_tone = |bin: &usize| {
        let level = levels[*bin];
        let near = &levels[bin.saturating_sub(APART)..(bin + APART + 1).min(levels.len())];
        let valley = |side: &mut dyn Iterator<Item = usize>| {
            side.map(|other| levels[other]).take_while(|other| *other <= level).any(|other| other < level - VALLEY_DB)
        };
        level > loudest - FAINT_DB
            && near.iter().all(|other| *other <= level)
            && valley(&mut (0..*bin).rev())
            && valley(&mut (bin + 1..levels.len()))
    };
    let mut bins: Vec<usize> = (APART..levels.len()).filter(is_tone).collect();
    bins.sort_by(|a, b| levels[*b].total_cmp(&levels[*a]));
    bins.truncate(MOST);
    bins.into_iter().map(|bin| Tone::of(samples, bin as f64 * f64::from(RATE) / POINTS as f64)).collect()
}

/// The mean power of the sound in each bin, in dB.
fn mean_spectrum(samples: &[f32]) -> Vec<f64> {
    let transform = forward(POINTS);
    let (mut input, mut output) = (transform.make_input_vec(), transform.make_output_vec());
    let mut powers = vec![1e-30; output.len()];
    for start in (0..samples.len().saturating_sub(WINDOW).max(1)).step_by(WINDOW / 2) {
        input.fill(0.0);
        for (n, (input, sample)) in input.iter_mut().zip(&samples[start..]).take(WINDOW).enumerate() {
            *input = f64::from(*sample) * hann(n, WINDOW);
        }
        transform.process(&mut input, &mut output).expect("the buffers are the transform's own");
        powers.iter_mut().zip(&output).for_each(|(power, bin)| *power += bin.norm_sqr());
    }
    powers.into_iter().map(|power| 10.0 * log10(power)).collect()
}

fn hann(n: usize, len: usize) -> f64 {
    0.5 - 0.5 * cos(TAU * (n as f64 + 0.5) / len as f64)
}

/// Amplitude and phase of the tone near a frequency in Hz at each moment, relative to a steady tone.
fn followed(samples: &[f32], frequency: f64) -> Vec<[f64; 2]> {
    let theta = TAU * frequency / f64::from(RATE);
    let window: Vec<[f64; 2]> = (0..FOLLOWED)
        .map(|n| {
            let (weight, phase) = (2.0 * hann(n, FOLLOWED) / (0.5 * FOLLOWED as f64), theta * n as f64);
            [weight * cos(phase), -weight * sin(phase)]
        })
        .collect();
    let half = FOLLOWED / 2;
    let moment = |middle: usize| {
        let first = half.saturating_sub(middle);
        let last = (samples.len() + half).saturating_sub(middle).min(FOLLOWED);
        let mut sum = [0.0; 2];
        for (n, value) in window[first..last].iter().enumerate() {
            let sample = f64::from(samples[middle + first + n - half]);
            sum = [sum[0] + sample * value[0], sum[1] + sample * value[1]];
        }
        // Relative to a tone that starts with the sound.
        let turn = -libm::fmod(theta * (middle as f64 - half as f64), TAU);
        let (c, s) = (cos(turn), sin(turn));
        [sum[0] * c - sum[1] * s, sum[0] * s + sum[1] * c]
    };
    (0..=samples.len() / HOP).map(|n| moment(n * HOP)).collect()
}
