//! Finds rows of bursts at equal spacings, as of the teeth of a guiro, by the regularity with which the level rises.

use super::draft::Noise;
use crate::analysis::log_mel::RATE;
use libm::{log, sqrt};

/// Samples per block of levels, half a millisecond, and shortest and longest spacing in seconds.
const BLOCK: usize = RATE as usize / 2000;
const SPACINGS: [f64; 2] = [0.004, 0.08];
/// Blocks before one over which its level rises.
const BEFORE: usize = 3;
/// Power, relative to the greatest, below which a rise is not heard.
const FAINT: f64 = 1e-4;
/// Fewest bursts, since a few rises may be chance, and the most that the engine plays.
const FEWEST: usize = 5;
const MOST: usize = Noise::MOST_HITS as usize;
/// Step between the spacings that are tried, in blocks.
const STEP: f64 = 0.25;
/// Smallest deviation of the rises, in nepers of power, that is assumed.
const LEAST_DEVIATION: f64 = 0.05;
/// How many of their standard deviations the rises of the bursts are above the mean.
const CLEARLY: f64 = 5.5;
/// Least rise of a burst, relative to the mean of all.
const RISES: f64 = 0.4;
/// Correlation of a sound with itself, a burst later, from which it is a tone whose periods look like bursts; and the samples by
/// which the distance may be off.
const TONE: f64 = 0.5;
const OFF: usize = 8;

/// How far the level of each block is above the mean of the blocks before it, or of one beside it if that rises more.
fn rises(samples: &[f32]) -> Vec<f64> {
    // Differences of samples raise the high frequencies, in which bursts are sharpest.
    let powers: Vec<f64> = samples
        .windows(BLOCK + 1)
        .step_by(BLOCK)
        .map(|samples| samples.windows(2).map(|pair| f64::from(pair[1]) - f64::from(pair[0])).map(|d| d * d).sum())
        .collect();
    let floor = FAINT * powers.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let levels: Vec<f64> = powers.iter().map(|power| log(power + floor)).collect();
    let rise = |n: usize| {
        let before = &levels[n.saturating_sub(BEFORE)..n];
        if before.is_empty() { 0.0 } else { (levels[n] - before.iter().sum::<f64>() / before.len() as f64).max(0.0) }
    };
    let rises: Vec<f64> = (0..levels.len()).map(rise).collect();
    let beside = |n: usize| rises[n.saturating_sub(1)..(n + 2).min(rises.len())].iter().copied().fold(0.0, f64::max);
    (0..rises.len()).map(beside).collect()
}

/// Whether samples repeat themselves after a distance, as a low tone does and noise does not.
fn repeats(samples: &[f32], distance: usize) -> bool {
    let correlation = |distance: usize| {
        let pairs = samples.iter().zip(samples.get(distance..).unwrap_or_default());
        let (product, first, second) = pairs.fold((0.0, 0.0, 0.0), |(product, first, second), (a, b)| {
            let (a, b) = (f64::from(*a), f64::from(*b));
            (product + a * b, first + a * a, second + b * b)
        });
        product / sqrt(first * second).max(f64::MIN_POSITIVE)
    };
    (distance.saturating_sub(OFF)..=distance + OFF).any(|distance| correlation(distance) > TONE)
}

/// The row of bursts with which samples at [`RATE`] begin, up to sixteen; none if their level does not rise regularly, or if they are
/// a low tone.
pub(super) fn train(samples: &[f32]) -> Option<Noise> {
    let row = row(samples)?;
    let spacing = (row.spacing * f64::from(RATE)) as usize;
    let end = samples.len().min(usize::from(row.hits) * spacing);
    (!repeats(&samples[..end], spacing)).then_some(row)
}

/// The row whose bursts rise most clearly above what is between them.
fn row(samples: &[f32]) -> Option<Noise> {
    let per_second = f64::from(RATE) / BLOCK as f64;
    let [shortest, longest] = SPACINGS.map(|seconds| seconds * per_second);
    let rises = rises(&samples[..samples.len().min(MOST * longest as usize * BLOCK)]);
    let steps = ((longest - shortest) / STEP).ceil() as usize;
    let mut best = (CLEARLY, None);
    for spacing in (0..=steps).map(|n| (shortest + STEP * n as f64).min(longest)) {
        for hits in FEWEST..=MOST {
            let Some(heard) = rises.get(..((hits as f64 - 0.5) * spacing) as usize) else { break };
            let mean = heard.iter().sum::<f64>() / heard.len() as f64;
            let square = heard.iter().map(|rise| (rise - mean) * (rise - mean)).sum::<f64>() / heard.len() as f64;
            // The first burst is the onset, which each sound has.
            let count = hits as f64 - 1.0;
            let burst = |n: usize| heard[(n as f64 * spacing).round() as usize];
            let of_bursts = (1..hits).map(burst).sum::<f64>() / count;
            let clearly = (of_bursts - mean) / (sqrt(square) + LEAST_DEVIATION) * sqrt(count);
            // Of a row that ends before, the last burst does not rise, and of one with twice the spacing every second one.
            let does_rise = |n: &usize| burst(*n) > RISES * of_bursts;
            if clearly > best.0 && does_rise(&(hits - 1)) && 2 * (1..hits).filter(does_rise).count() > hits {
                best = (clearly, Some(Noise { hits: hits as u8, spacing: spacing / per_second, ..Noise::SHORT }));
            }
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dsp::random::{key, uniform};

    /// Seconds since the last of a row of bursts.
    fn since_burst(time: f64, hits: u8, spacing: f64) -> f64 {
        time - libm::floor(time / spacing).min(f64::from(hits) - 1.0) * spacing
    }

    /// A second of noise whose level is set by `level`, from the time in seconds.
    fn noise(level: impl Fn(f64) -> f64) -> Vec<f32> {
        let chance = key(5, 0);
        let sample = |n: usize| level(n as f64 / f64::from(RATE)) as f32 * uniform(chance, n as u64);
        (0..RATE as usize).map(sample).collect()
    }

    #[test]
    fn the_teeth_of_a_guiro_are_counted() {
        for (hits, spacing) in [(7_u8, 0.031), (12, 0.0173), (16, 0.026)] {
            let found = train(&noise(|t| libm::exp(-since_burst(t, hits, spacing) / 0.006))).unwrap();
            assert_eq!(found.hits, hits, "{found:?}");
            assert!((found.spacing / spacing - 1.0).abs() < 0.01, "{found:?}, {spacing}");
        }
    }

    #[test]
    fn a_single_stroke_is_no_row() {
        for t60 in [0.05, 0.4, 10.0] {
            let stroke = noise(|t| libm::exp(-6.9 * t / t60));
            assert_eq!(train(&stroke), None, "{t60}");
        }
        let saw = |n: usize| (n as f32 * 55.0 / RATE as f32).fract() - 0.5;
        for sound in [Vec::new(), (0..RATE as usize).map(saw).collect()] {
            assert_eq!(train(&sound), None);
        }
    }
}
