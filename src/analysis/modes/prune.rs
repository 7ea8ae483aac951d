//! Which modes of a fit are dropped: those that explain no more than noise would, the weakest first.

use super::detect::Spectra;
use super::fit::{Fit, Inverses, energy};
use nalgebra::DMatrix;
use realfft::num_complex::Complex;

/// What a mode has to explain, in multiples of what noise explains near it on average. Noise alone exceeds it once in
/// e¹⁵ bins, 3 million.
pub(super) const DETECTION: f64 = 15.0;
/// The same for its amplitude once all poles are unknown: lower, since a pole of its own costs a mode half of it.
const SIGNIFICANCE: f64 = 5.0;
/// Times that a floor is measured anew, since what is dropped comes back in the residual.
const MOST_FLOORS: usize = 8;

/// Drops modes until each one that is left explains more than noise would, and more than the energy `least`. `None` if
/// the equations cannot be solved.
pub(super) fn prune(mut fit: Fit, samples: &[f64], sample_rate: f64, least: f64) -> Option<Fit> {
    for _ in 0..MOST_FLOORS {
        if fit.poles.is_empty() {
            break;
        }
        let spectra = Spectra::new(&fit.residual(samples), sample_rate);
        let floors: Vec<f64> = fit.poles.iter().map(|pole| spectra.floor(*pole).max(1e-300)).collect();
        let mut elimination = Elimination::new(fit.inverses()?, fit.amplitudes.clone());
        while let Some((worth, k)) = elimination.weakest(&floors, least)
            && worth < 1.0
        {
            elimination.remove(k);
        }
        if elimination.left.len() == fit.poles.len() {
            break;
        }
        fit = Fit::new(samples, elimination.left.iter().map(|k| fit.poles[*k]).collect())?;
    }
    Some(fit)
}

/// Modes that are taken out of the normal equations one after the other. What is left is the solution without them, at
/// the cost of one outer product for each unknown.
struct Elimination {
    inverses: Inverses,
    amplitudes: Vec<Complex<f64>>,
    left: Vec<usize>,
}

impl Elimination {
    fn new(inverses: Inverses, amplitudes: Vec<Complex<f64>>) -> Self {
        Self { inverses, left: (0..amplitudes.len()).collect(), amplitudes }
    }

    /// The mode that explains the least of those left, and its energy as a multiple of what it has to explain.
    fn weakest(&self, floors: &[f64], least: f64) -> Option<(f64, usize)> {
        let worth = |k: usize| {
            let explained = energy(&self.inverses.alone, k, self.amplitudes[k]);
            let significance = energy(&self.inverses.all, k, self.amplitudes[k]);
            let floor = floors[k];
            (explained / (DETECTION * floor)).min(significance / (SIGNIFICANCE * floor)).min(explained / least)
        };
        self.left.iter().map(|k| (worth(*k), *k)).min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn remove(&mut self, k: usize) {
        for part in 0..2 {
            // The amplitudes are the solution with all modes; without this unknown they take over what it explained.
            let at = 2 * k + part;
            let own = if part == 0 { self.amplitudes[k].re } else { self.amplitudes[k].im };
            let column = self.inverses.alone.column(at);
            if column[at] > 0.0 {
                let share = own / column[at];
                for (index, amplitude) in self.amplitudes.iter_mut().enumerate() {
                    *amplitude -= Complex::new(column[2 * index], column[2 * index + 1]) * share;
                }
            }
            take_out(&mut self.inverses.alone, at);
        }
        let pole = 2 * self.amplitudes.len() + 1 + 2 * k;
        [2 * k, 2 * k + 1, pole, pole + 1].into_iter().for_each(|at| take_out(&mut self.inverses.all, at));
        self.left.retain(|other| *other != k);
    }
}

/// Makes of an inverse that of the equations without one unknown.
fn take_out(inverse: &mut DMatrix<f64>, at: usize) {
    let column = inverse.column(at).into_owned();
    if column[at] > 0.0 {
        inverse.ger(-1.0 / column[at], &column, &column, 1.0);
    }
    inverse.column_mut(at).fill(0.0);
    inverse.row_mut(at).fill(0.0);
}
