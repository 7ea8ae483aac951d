//! Finds when the exciter of a strike has let go.
//!
//! Each sample of freely ringing modes is a weighted sum of those that come after it (backward linear prediction;
//! Makhoul 1975): for `M` modes, of `2M` samples. This is not so while a mallet or a burst of noise drives the modes.
//! So the exciter still acts wherever the error of the best prediction is much larger than shortly after.

use crate::analysis::level::energy;
use nalgebra::{Cholesky, DMatrix};

/// Number of samples from which the one before them is predicted.
const ORDER: usize = 160;
/// Seconds of the strike to which the predictions are fitted.
const FITTED: f64 = 0.2;
/// Seconds within which exciters let go.
const LONGEST: f64 = 0.06;
/// Seconds per block of errors.
const BLOCK: f64 = 0.0005;
/// Blocks before and after a block over which the level of the sound is measured.
const AROUND: usize = 5;
/// An error is compared with the mean of later errors: blocks between, and blocks of the mean.
const PAUSE: usize = 2;
const FOLLOWING: usize = 6;
/// Least energy of an error, relative to the sound, as a multiple of that of later errors: 15 dB.
const STANDS_OUT: f64 = 30.0;
/// The same relative to the sound itself: smaller errors come from rounding.
const LEAST: f64 = 1e-9;
/// Least energy of an error as a multiple of those that follow: 6 dB. Errors of modes that are not predicted fall more
/// slowly.
const FALLS: f64 = 4.0;
/// Most predictions that are fitted one after the other.
const ROUNDS: usize = 12;
/// Energy of a block, relative to the loudest one, below which it is silent.
const FAINTEST: f64 = 1e-9;
/// Median of a prediction's errors, relative to that of the prediction before, above which predictions do not improve any more.
const SETTLED: f64 = 0.8;
/// Samples whose products are added up at a time.
const ROWS: usize = 1024;
/// Ridge of the normal equations, relative to their diagonal.
const RIDGE: f64 = 1e-12;

/// Number of samples after which the modes ring freely; 0 if they do from the beginning.
pub(super) fn let_go(samples: &[f64], sample_rate: f64) -> usize {
    let block = ((BLOCK * sample_rate) as usize).max(8);
    let samples = &samples[..samples.len().min((FITTED * sample_rate) as usize)];
    let (blocks, latest) = (samples.len().saturating_sub(ORDER) / block, (LONGEST / BLOCK) as usize);
    if blocks < 2 * latest {
        return 0;
    }
    let energies = |values: &[f64]| -> Vec<f64> {
        values.chunks_exact(block).map(|block| energy(block, 0.0).max(1e-300)).collect()
    };
    let sound = energies(&samples[..blocks * block]);
    // After the end of the sound, only rounding errors are left.
    let least = FAINTEST * sound.iter().copied().fold(0.0, f64::max);
    let levels: Vec<f64> = (0..blocks)
        .map(|index| {
            let around = &sound[index.saturating_sub(AROUND)..(index + AROUND + 1).min(blocks)];
            (around.iter().sum::<f64>() / around.len() as f64).max(least)
        })
        .collect();
    let mut weights: Vec<f64> = levels.iter().map(|level| 1.0 / level).collect();
    let (mut work, mut before) = (None, f64::INFINITY);
    for _ in 0..ROUNDS {
        let Some(errors) = errors(samples, |n| weights[(n / block).min(blocks - 1)]) else { break };
        let errors = energies(&errors);
        let mut later: Vec<f64> = (latest..blocks).map(|index| errors[index] / levels[index]).collect();
        let middle = later.len() / 2;
        let median = *later.select_nth_unstable_by(middle, f64::total_cmp).1;
        let at_work = |index: &usize| {
            let following = &errors[index + PAUSE..index + PAUSE + FOLLOWING];
            let mean = following.iter().sum::<f64>() / following.len() as f64;
            errors[*index] > FALLS * mean && errors[*index] > (STANDS_OUT * median).max(LEAST) * levels[*index]
        };
        let last = (0..latest).rfind(at_work);
        if last == work && median > SETTLED * before {
            break;
        }
        (work, before) = (last, median);
        // Blocks that are predicted badly get little weight in the next prediction.
        let weight = |(error, level): (&f64, &f64)| 1.0 / error.max(1e-12 * level);
        weights = errors.iter().zip(&levels).map(weight).collect();
    }
    // The exciter may let go within the next block.
    work.map_or(0, |index| (index + 2) * block)
}

/// Errors of the prediction with the least sum of squares, weighted by `weight` of each sample. There is an error for
/// each sample that is followed by enough others.
fn errors(samples: &[f64], weight: impl Fn(usize) -> f64) -> Option<Vec<f64>> {
    let count = samples.len() - ORDER;
    // Lag 0 is the sample that is predicted.
    let mut products = DMatrix::<f64>::zeros(ORDER + 1, ORDER + 1);
    for from in (0..count).step_by(ROWS) {
        let rows = ROWS.min(count - from);
        let weighted = DMatrix::from_fn(rows, ORDER + 1, |row, lag| weight(from + row) * samples[from + row + lag]);
        let rows = DMatrix::from_fn(ORDER + 1, rows, |lag, row| samples[from + row + lag]);
        products.gemm(1.0, &rows, &weighted, 1.0);
    }
    let mut normal = products.view((1, 1), (ORDER, ORDER)).into_owned();
    let ridge = RIDGE * normal.diagonal().max();
    (0..ORDER).for_each(|lag| normal[(lag, lag)] += ridge);
    let right = products.column(0).rows(1, ORDER).into_owned();
    let predictor = Cholesky::new(normal)?.solve(&right);
    let error = |n: usize| samples[n] - (0..ORDER).map(|lag| predictor[lag] * samples[n + 1 + lag]).sum::<f64>();
    Some((0..count).map(error).collect())
}

#[cfg(test)]
mod tests {
    use super::super::tests::driven;
    use super::*;

    const MODES: [(f64, f64); 2] = [(0.05, 0.9995), (0.21, 0.999)];

    #[test]
    fn a_burst_of_noise_is_waited_for_and_a_strike_is_not() {
        for len in [100, 500, 1000] {
            let found = let_go(&driven(&MODES, len, 12_000), 48_000.0);
            assert!((len..len + 72).contains(&found), "{len}: {found}");
        }
        let free: Vec<f64> = driven(&MODES, 500, 12_000).split_off(600);
        assert!(let_go(&free, 48_000.0) < 48, "{}", let_go(&free, 48_000.0));
    }
}
