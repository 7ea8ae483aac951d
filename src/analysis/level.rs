//! Levels of a signal: peak, RMS and DC.

use crate::units::db_from_gain;
use libm::sqrt;

/// The level of silence, where a level in decibels must be a finite number.
pub(crate) const SILENCE_DB: f64 = -300.0;

/// Largest magnitude; NaN if a sample is NaN.
pub fn peak(samples: &[f32]) -> f64 {
    samples.iter().fold(0.0, |most, sample| maximum(most, f64::from(*sample).abs()))
}

/// Root of the mean square; 0 for no samples.
pub(crate) fn rms<S: Copy + Into<f64>>(samples: &[S]) -> f64 {
    sqrt(energy(samples, 0.0) / samples.len().max(1) as f64)
}

/// The mean of some channels. It is as long as the shortest of them.
pub(crate) fn mean_of<C: AsRef<[f32]>>(channels: &[C]) -> Vec<f64> {
    let len = channels.iter().map(|channel| channel.as_ref().len()).min().unwrap_or(0);
    let count = channels.len() as f64;
    (0..len).map(|n| channels.iter().map(|channel| f64::from(channel.as_ref()[n])).sum::<f64>() / count).collect()
}

/// The mean of some channels, as long as the shortest.
pub fn mono<C: AsRef<[f32]>>(channels: &[C]) -> Vec<f32> {
    mean_of(channels).into_iter().map(|sample| sample as f32).collect()
}

/// Share of the energy of unrelated channels below which the mean of channels has lost what they hold.
const CANCELLED: f64 = 0.1;

/// The loudest of some channels whose mean all but cancels; none if it does not.
pub(crate) fn cancelling(channels: &[Vec<f32>]) -> Option<usize> {
    if channels.len() < 2 {
        return None;
    }
    let energies: Vec<f64> = channels.iter().map(|channel| energy(channel, 0.0)).collect();
    // The mean of channels that have nothing in common has this energy.
    let unrelated = energies.iter().sum::<f64>() / (channels.len() * channels.len()) as f64;
    let loudest = (0..channels.len()).max_by(|a, b| energies[*a].total_cmp(&energies[*b]));
    loudest.filter(|_| energy(&mean_of(channels), 0.0) < CANCELLED * unrelated)
}

/// Sum of the squares of samples about a constant.
pub(crate) fn energy<S: Copy + Into<f64>>(samples: &[S], constant: f64) -> f64 {
    let distance = |sample: &S| (*sample).into() - constant;
    samples.iter().map(|sample| distance(sample) * distance(sample)).sum()
}

/// Mean; 0 for no samples.
pub(crate) fn dc(samples: &[f32]) -> f64 {
    samples.iter().map(|sample| f64::from(*sample)).sum::<f64>() / samples.len().max(1) as f64
}

/// How many of its standard errors a constant must be.
const SIGNIFICANT: f64 = 4.0;
/// Fewest blocks whose agreement says something.
const FEWEST_BLOCKS: usize = 4;
/// Standard deviation of normally distributed numbers in medians of their distance from the median, and the standard error of
/// the median of `n` numbers in their standard deviations, times √n.
const DEVIATION_OF_MEDIAN: f64 = 1.4826;
const ERROR_OF_MEDIAN: f64 = 1.2533;

/// The constant that is added to a strike: the median of the means of blocks of some samples; 0 if the blocks, where there are
/// four or more, do not agree on it, and for no samples. The mean of all samples is not it, since a strike can be asymmetric: taken
/// away, it would leave a constant in the quiet end.
pub(crate) fn offset<S: Copy + Into<f64>>(samples: &[S], block: usize) -> f64 {
    let median = |mut numbers: Vec<f64>| {
        numbers.sort_by(f64::total_cmp);
        numbers.get(numbers.len() / 2).copied().unwrap_or(0.0)
    };
    let mean = |block: &[S]| block.iter().map(|sample| (*sample).into()).sum::<f64>() / block.len() as f64;
    let means: Vec<f64> = samples.chunks(block.max(1)).map(mean).collect();
    let count = means.len();
    let middle = median(means.clone());
    let distance = median(means.iter().map(|mean| libm::fabs(mean - middle)).collect());
    let error = ERROR_OF_MEDIAN * DEVIATION_OF_MEDIAN * distance / sqrt(count.max(1) as f64);
    if count < FEWEST_BLOCKS || libm::fabs(middle) > SIGNIFICANT * error { middle } else { 0.0 }
}

/// An amplitude in dB relative to full scale (1.0), never below `SILENCE_DB`.
pub fn dbfs(amplitude: f64) -> f64 {
    if amplitude.is_nan() { f64::NAN } else { db_from_gain(amplitude).max(SILENCE_DB) }
}

/// The larger number, or NaN if one of them is NaN: a peak must not hide the NaN of a broken render.
fn maximum(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_of_known_signals() {
        let square = [0.5, -0.5, 0.5, -0.5];
        assert_eq!((peak(&square), rms(&square), dc(&square)), (0.5, 0.5, 0.0));
        let step = [0.0, 0.25, 0.25, 0.25];
        assert_eq!((peak(&step), dc(&step)), (0.25, 0.1875));
        assert_eq!((peak(&[]), rms::<f32>(&[]), dc(&[])), (0.0, 0.0, 0.0));
        assert_eq!((offset(&[0.9, 0.1, 0.1, 0.1, 0.1], 2), offset::<f64>(&[], 2)), (0.1, 0.0));
        assert_eq!(offset(&[0.9, 0.11, 0.1, 0.09, 0.1, 0.1, 0.1], 1), 0.1);
        // Blocks of a sound that swings slowly do not agree on a constant.
        assert_eq!(offset(&[0.9, -0.5, 0.4, -0.3, 0.2, -0.1, 0.1], 1), 0.0);
        assert_eq!((dbfs(1.0), dbfs(0.1), dbfs(0.0)), (0.0, -20.0, SILENCE_DB));
    }

    #[test]
    fn nan_is_not_hidden() {
        for samples in [[f32::NAN, 1.0, 0.0], [1.0, f32::NAN, 0.0], [0.0, 1.0, f32::NAN]] {
            assert!(peak(&samples).is_nan() && dbfs(rms(&samples)).is_nan());
        }
    }
}
