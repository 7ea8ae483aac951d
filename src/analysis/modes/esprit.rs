//! Finds the poles of a narrow band by ESPRIT (Roy & Kailath 1989).
//!
//! The band is shifted to zero, filtered and decimated, so that a few dozen samples contain few modes. From one sample
//! to the next, its signal subspace is multiplied by the poles.
//!
//! The filter only uses samples after the first one, where a sum of damped sinusoids stays such a sum.

use super::pole::{Pole, magnitude};
use libm::{atan2, log, log2, sqrt};
use nalgebra::{DMatrix, Schur, SymmetricEigen};
use sprung_fourier::Complex;
use std::f64::consts::PI;

/// Number of samples after decimation, of a band and of a long band.
const SAMPLES: usize = 104;
const SAMPLES_OF_LONG: usize = 416;
/// Rows of the data matrix, as a share of the samples.
const ROWS: f64 = 0.425;
/// Maximum number of poles of a band, as a share of the rows.
const MOST_POLES: f64 = 0.42;
/// Half-width of a band, and frequency at which its filter's stop band begins, as shares of the decimated rate.
const PASS: f64 = 0.3;
const STOP: f64 = 0.7;
/// Attenuation beyond the band in dB.
const ATTENUATION: f64 = 110.0;

/// A narrow band of a sound: its centre, the number of samples from one output to the next, and the number of outputs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Band {
    pub(super) theta: f64,
    hop: usize,
    count: usize,
}

impl Band {
    /// The band around `theta` that resolves modes which ring for about `len` samples.
    pub(super) fn new(theta: f64, len: usize) -> Self {
        Self { theta, hop: (len / (SAMPLES + Self::taps(1))).max(1), count: SAMPLES }
    }

    /// A band about as wide, but of `len` samples, which are several times as many. Each mode then has several times as
    /// many samples, so that modes denser than their bandwidths can be resolved.
    pub(super) fn long(theta: f64, len: usize) -> Self {
        Self { theta, hop: (len / (SAMPLES_OF_LONG + Self::taps(1))).max(1), count: SAMPLES_OF_LONG }
    }

    /// Half of its width in radians per sample.
    pub(super) fn half_width(&self) -> f64 {
        PASS * 2.0 * PI / self.hop as f64
    }

    /// Length of the filter (Kaiser 1974).
    fn taps(hop: usize) -> usize {
        ((ATTENUATION - 7.95) / (2.285 * 2.0 * PI * (STOP - PASS) / hop as f64)) as usize | 1
    }

    /// The band's samples at its own rate.
    fn decimate(&self, samples: &[f64]) -> Vec<Complex<f64>> {
        let filter = self.filter();
        let taps = filter.len();
        let count = samples.len().saturating_sub(taps) / self.hop;
        let shift = Pole { decay: 0.0, theta: -self.theta };
        let (re, im): (Vec<f64>, Vec<f64>) = filter.iter().map(|tap| (tap.re, tap.im)).unzip();
        (0..count.min(self.count))
            .map(|m| {
                let stretch = &samples[m * self.hop..m * self.hop + taps];
                Complex::new(dot(stretch, &re), dot(stretch, &im)) * shift.power(m * self.hop)
            })
            .collect()
    }

    /// The filter's taps: a windowed sinc, shifted to the band's middle.
    fn filter(&self) -> Vec<Complex<f64>> {
        let taps = Self::taps(self.hop);
        let beta = 0.1102 * (ATTENUATION - 8.7);
        let (middle, peak) = (taps / 2, bessel(beta));
        let cutoff = 0.5 * (PASS + STOP) * 2.0 * PI / self.hop as f64;
        let mut filter = vec![Complex::ZERO; taps];
        for distance in 0..=middle {
            let x = distance as f64;
            let sinc = if distance == 0 { cutoff / PI } else { libm::sin(cutoff * x) / (PI * x) };
            let share = x / (middle as f64 + 1.0);
            let tap = sinc * bessel(beta * sqrt(1.0 - share * share)) / peak;
            let (sin, cos) = libm::sincos(self.theta * x);
            filter[middle + distance] = Complex::new(tap * cos, -tap * sin);
            filter[middle - distance] = Complex::new(tap * cos, tap * sin);
        }
        filter
    }

    /// Number of samples, from the first one on, that [`Self::poles`] uses.
    pub(super) fn reach(&self) -> usize {
        self.count * self.hop + Self::taps(self.hop)
    }

    /// The poles within the band, as many as the minimum description length gives (MDL; Wax & Kailath 1985), and
    /// whether this is more than the band's samples can resolve.
    pub(super) fn poles(&self, samples: &[f64]) -> (Vec<Pole>, bool) {
        let band = self.decimate(samples);
        let rows = ((ROWS * self.count as f64) as usize).min(band.len() / 2);
        if rows < 4 {
            return (Vec::new(), false);
        }
        let columns = band.len() - rows + 1;
        let covariance = covariance(&band, rows, columns);
        let Some(SymmetricEigen { eigenvectors, eigenvalues }) = SymmetricEigen::try_new(covariance, 1e-15, 10_000)
        else {
            return (Vec::new(), false);
        };
        let mut order: Vec<usize> = (0..rows).collect();
        order.sort_by(|a, b| eigenvalues[*b].total_cmp(&eigenvalues[*a]));
        let sorted: Vec<f64> = order.iter().map(|index| eigenvalues[*index]).collect();
        let (wanted, most) =
            (description_length(&sorted, columns), ((MOST_POLES * rows as f64) as usize).min(rows - 2));
        let (count, crowded) = (wanted.min(most), wanted > most);
        let subspace = DMatrix::from_fn(rows, count, |row, column| eigenvectors[(row, order[column])]);
        let (upper, lower) = (subspace.rows(0, rows - 1).into_owned(), subspace.rows(1, rows - 1).into_owned());
        let turn = (upper.adjoint() * &upper).lu().solve(&(upper.adjoint() * lower));
        let Some(schur) = turn.and_then(|turn| Schur::try_new(turn, 1e-15, 10_000)) else {
            return (Vec::new(), crowded);
        };
        let (_, triangle) = schur.unpack();
        ((0..count).filter_map(|index| self.pole(triangle[(index, index)])).collect(), crowded)
    }

    /// The pole of a factor from one of the band's samples to the next; none if it lies outside the band or grows.
    fn pole(&self, turn: Complex<f64>) -> Option<Pole> {
        let (radius, angle) = (magnitude(turn), atan2(turn.im, turn.re));
        let inside = angle.abs() < 2.0 * PI * PASS * 1.05 && radius > 1e-6;
        let grows = log(radius.max(1e-9)) * self.count as f64 > 1.0;
        let pole =
            Pole { decay: -log(radius.max(1e-9)) / self.hop as f64, theta: self.theta + angle / self.hop as f64 };
        (inside && !grows && pole.theta > 0.0 && pole.theta < PI)
            .then_some(Pole { decay: pole.decay.max(1e-3 / (self.hop * self.count) as f64), ..pole })
    }
}

/// The Hankel matrix of some samples times its adjoint: each row of the matrix is a stretch of the samples.
fn covariance(band: &[Complex<f64>], rows: usize, columns: usize) -> DMatrix<Complex<f64>> {
    let mut covariance = DMatrix::zeros(rows, rows);
    for column in 0..rows {
        for row in column..rows {
            let pairs = band[row..row + columns].iter().zip(&band[column..column + columns]);
            let product: Complex<f64> = pairs.map(|(a, b)| a * b.conj()).sum();
            (covariance[(row, column)], covariance[(column, row)]) = (product, product.conj());
        }
    }
    covariance
}

/// How many of the falling eigenvalues of a covariance over `snapshots` snapshots belong to signals and not to noise.
fn description_length(eigenvalues: &[f64], snapshots: usize) -> usize {
    let (count, floor) = (eigenvalues.len(), 1e-15 * eigenvalues[0].max(f64::MIN_POSITIVE));
    let cost = |order: usize| {
        let noise = eigenvalues[order..].iter().map(|value| value.max(floor));
        let rest = (count - order) as f64;
        let (logarithms, sum) = noise.fold((0.0, 0.0), |(logs, sum), value| (logs + log2(value), sum + value));
        let flatness = logarithms / rest - log2(sum / rest);
        let parameters = (order * (2 * count - order)) as f64;
        -(snapshots as f64) * rest * flatness + 0.5 * parameters * log2(snapshots as f64)
    };
    (0..count - 1).min_by(|a, b| cost(*a).total_cmp(&cost(*b))).unwrap_or(0)
}

/// Modified Bessel function of order 0, by its series.
fn bessel(x: f64) -> f64 {
    let (mut term, mut sum) = (1.0, 1.0);
    for k in 1..60 {
        term *= (x / (2.0 * f64::from(k))) * (x / (2.0 * f64::from(k)));
        sum += term;
        if term < 1e-17 * sum {
            break;
        }
    }
    sum
}

/// Inner product, in several sums side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (first, second) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = first.remainder().iter().zip(second.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in first.zip(second) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    rest + sums.iter().sum::<f64>()
}
