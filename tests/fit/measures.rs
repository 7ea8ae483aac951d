//! What real instruments measure: numbers of an attack and of what follows, and what nine of ten recordings reach.
//!
//! All are taken at 44.1 kHz from the onset of the mean of both channels: the first sample above 3 % of the peak.

use crate::played::{Stereo, mean};
use realfft::RealFftPlanner;
use sprung::analysis::log_mel::{BANDS, HOP, MelBands, RATE, WINDOW};
use std::f64::consts::PI;

/// Measures of one sound.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measures {
    /// Geometric over arithmetic mean of the power from 300 Hz to 12 kHz in the first 25 ms, in dB.
    pub(crate) flatness_db: f64,
    /// Energy above 2 kHz over all in the first 50 ms, in dB.
    pub(crate) high_db: f64,
    /// RMS deviation in dB of each mel band from its own best parabola, 50 to 850 ms after the onset; none for what is shorter
    /// than 120 ms.
    pub(crate) motion_db: Option<f64>,
    /// Peaks within 55 dB of the highest that stand out by 12 dB, in the first 0.6 s.
    pub(crate) partials: usize,
}

/// The least of each measure: the 10th percentile of 249 recordings.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Least {
    flatness_db: f64,
    high_db: f64,
    motion_db: f64,
    partials: usize,
}

/// Of mallets, plucks and bells.
pub(crate) const TUNED: Least = Least { flatness_db: -48.0, high_db: -42.0, motion_db: 0.48, partials: 6 };
/// Of drums and percussion.
pub(crate) const DRUM: Least = Least { flatness_db: -29.0, high_db: -39.0, motion_db: 1.2, partials: 9 };

const ONSET: f32 = 0.03;
/// Levels in dB below the loudest band at which motion is measured no more.
const QUIET_DB: f64 = -40.0;

impl Measures {
    pub(crate) fn of(sound: &Stereo) -> Self {
        let samples = mean(sound);
        let peak = samples.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
        let onset = samples.iter().position(|sample| sample.abs() > ONSET * peak).unwrap_or(0);
        let samples = &samples[onset..];
        Self {
            flatness_db: flatness_db(samples),
            high_db: high_db(samples),
            motion_db: motion_db(samples),
            partials: partials(samples),
        }
    }

    /// Names of the measures that a recording reaches, and this does not.
    pub(crate) fn short_of(&self, recording: &Self, least: &Least) -> Vec<&'static str> {
        let of = |measures: &Self| {
            let Self { flatness_db, high_db, motion_db, partials } = measures;
            [
                ("flatness", *flatness_db >= least.flatness_db),
                ("high frequencies", *high_db >= least.high_db),
                ("motion", motion_db.is_none_or(|motion| motion >= least.motion_db)),
                ("partials", *partials >= least.partials),
            ]
        };
        let both = of(self).into_iter().zip(of(recording));
        both.filter(|((_, own), (_, wanted))| *wanted && !own).map(|((name, _), _)| name).collect()
    }
}

fn first(samples: &[f32], seconds: f64) -> &[f32] {
    &samples[..samples.len().min((seconds * f64::from(RATE)) as usize)]
}

/// Power over frequency, from weighted samples in a transform of so many points, and Hz from one value to the next.
fn spectrum(samples: &[f32], weight: impl Fn(f64) -> f64, points: usize) -> (Vec<f64>, f64) {
    let transform = RealFftPlanner::new().plan_fft_forward(points);
    let mut input = transform.make_input_vec();
    for (n, (input, sample)) in input.iter_mut().zip(samples).enumerate() {
        *input = weight(n as f64 / samples.len() as f64) * f64::from(*sample);
    }
    let mut output = transform.make_output_vec();
    transform.process(&mut input, &mut output).unwrap();
    (output.iter().map(|bin| bin.norm_sqr() + 1e-30).collect(), f64::from(RATE) / points as f64)
}

fn hann(share: f64) -> f64 {
    0.5 - 0.5 * libm::cos(2.0 * PI * share)
}

fn flatness_db(samples: &[f32]) -> f64 {
    let (power, step) = spectrum(first(samples, 0.025), hann, 4096);
    let range = &power[(300.0 / step).ceil() as usize..=(12_000.0 / step) as usize];
    let count = range.len() as f64;
    let geometric = range.iter().map(|power| libm::log10(*power)).sum::<f64>() / count;
    10.0 * (geometric - libm::log10(range.iter().sum::<f64>() / count))
}

fn high_db(samples: &[f32]) -> f64 {
    // The falling half of a window: the onset counts in full.
    let (power, step) = spectrum(first(samples, 0.05), |share| hann(0.5 + 0.5 * share), 4096);
    let high: f64 = power[(2000.0 / step).ceil() as usize..].iter().sum();
    10.0 * libm::log10(high / power.iter().sum::<f64>())
}

fn motion_db(samples: &[f32]) -> Option<f64> {
    let rate = f64::from(RATE);
    let loudest = samples.iter().fold(0.0_f32, |peak, sample| peak.max(sample.abs()));
    let end = samples.iter().rposition(|sample| sample.abs() > 1e-4 * loudest)?.min((0.85 * rate) as usize);
    // Windows that lie within.
    let (from, to) = ((0.05 * rate) as usize + WINDOW / 2, end.saturating_sub(WINDOW / 2));
    let columns = MelBands::new().measure(&samples[..=end]).columns;
    let columns = columns.get(from.div_ceil(HOP)..to / HOP).filter(|columns| columns.len() >= 12)?;
    let means: [f64; BANDS] = std::array::from_fn(|band| {
        columns.iter().map(|column| libm::pow(10.0, 0.1 * column[band])).sum::<f64>() / columns.len() as f64
    });
    let most = means.iter().copied().fold(0.0, f64::max);
    let heard = (0..BANDS).filter(|band| 10.0 * libm::log10(means[*band] / most) >= QUIET_DB);
    let deviations: Vec<f64> =
        heard.map(|band| deviation(&columns.iter().map(|column| column[band]).collect::<Vec<_>>())).collect();
    Some(deviations.iter().sum::<f64>() / deviations.len() as f64)
}

/// RMS deviation of some values from their best parabola.
fn deviation(values: &[f64]) -> f64 {
    let count = values.len();
    // Gram's orthogonal polynomials.
    let x = |n: usize| 2.0 * n as f64 / (count - 1) as f64 - 1.0;
    let mean = |value: &dyn Fn(usize) -> f64| (0..count).map(value).sum::<f64>() / count as f64;
    let square = mean(&|n| x(n) * x(n));
    let functions: [&dyn Fn(usize) -> f64; 3] = [&|_| 1.0, &x, &|n| x(n) * x(n) - square];
    let mut left = values.to_vec();
    for function in functions {
        let factor = mean(&|n| function(n) * values[n]) / mean(&|n| function(n) * function(n));
        left.iter_mut().enumerate().for_each(|(n, left)| *left -= factor * function(n));
    }
    libm::sqrt(mean(&|n| left[n] * left[n]))
}

fn partials(samples: &[f32]) -> usize {
    let (power, step) = spectrum(first(samples, 0.6), hann, 1 << 16);
    let levels: Vec<f64> = power[..(18_000.0 / step) as usize].iter().map(|power| 10.0 * libm::log10(*power)).collect();
    let top = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // Prominence: how far one has to go down to either side before it goes up higher.
    let below = |from: &mut dyn Iterator<Item = &f64>, peak: f64| {
        from.take_while(|level| **level <= peak).copied().fold(peak, f64::min)
    };
    let is_partial = |n: &usize| {
        let peak = levels[*n];
        let is_peak = peak > levels[n - 1] && peak >= levels[n + 1] && peak >= top - 55.0;
        is_peak && {
            let sides = [below(&mut levels[..*n].iter().rev(), peak), below(&mut levels[n + 1..].iter(), peak)];
            peak - sides[0].max(sides[1]) >= 12.0
        }
    };
    (1..levels.len() - 1).filter(is_partial).count()
}
