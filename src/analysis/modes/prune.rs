//! Which modes of a fit are dropped: those that explain no more than noise would, the weakest first.

use super::detect::{Planner, Spectra};
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
/// What may be left without modes that were dropped, over what was left with them.
const MOST_LEFT: f64 = 1.2;
/// Most refinement steps of the modes that stay.
const REFINED: usize = 8;

/// Drops modes until each one that is left explains more than noise would, and more than the energy `least`. `None` if
/// the equations cannot be solved.
pub(super) fn prune(
    mut fit: Fit,
    samples: &[f64],
    sample_rate: f64,
    least: f64,
    planner: &Planner,
    go_on: &mut dyn FnMut() -> bool,
) -> Option<Fit> {
    for _ in 0..MOST_FLOORS {
        if fit.poles.is_empty() {
            break;
        }
        let spectra = Spectra::new(&fit.residual(samples), sample_rate, planner);
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
        let next = without(&fit, &elimination.removed, &floors, samples, go_on)?;
        if next.poles.len() == fit.poles.len() {
            break;
        }
        fit = next;
    }
    Some(fit)
}

/// A fit without modes that explain no more than noise, the weakest first. Of modes that are denser than their bandwidths each one
/// seems to be of no worth, since its neighbours could explain what it does; without all of them, much would be left. Then
/// only as many are dropped as the others can replace once they are refined.
fn without(
    fit: &Fit,
    weakest: &[usize],
    floors: &[f64],
    samples: &[f64],
    go_on: &mut dyn FnMut() -> bool,
) -> Option<Fit> {
    let mut count = weakest.len();
    while count > 0 {
        let dropped = &weakest[..count];
        let left = (0..fit.poles.len()).filter(|k| !dropped.contains(k)).map(|k| fit.poles[k]).collect();
        let most = MOST_LEFT * fit.unexplained + DETECTION * dropped.iter().map(|k| floors[*k]).sum::<f64>();
        let mut next = Fit::new(samples, left)?;
        if next.unexplained > most {
            next = next.refine(samples, 1e-2, REFINED, go_on);
        }
        if next.unexplained <= most {
            return Some(next);
        }
        count /= 2;
    }
    Some(fit.clone())
}

/// A fit in which two modes that all but coincide have become one, if one explains the sound as well: the two were found from
/// different sides and share the amplitude of a single mode. `least` is the energy that need not be explained.
pub(super) fn join(mut fit: Fit, samples: &[f64], least: f64, go_on: &mut dyn FnMut() -> bool) -> Fit {
    let mut tried = 0;
    while let Some((_, weaker)) = coinciding(&fit, samples.len()).into_iter().nth(tried) {
        let left = (0..fit.poles.len()).filter(|k| *k != weaker).map(|k| fit.poles[k]).collect();
        let Some(next) = Fit::new(samples, left).map(|next| next.refine(samples, 1e-7, 40, go_on)) else { break };
        match next.unexplained <= MOST_LEFT * fit.unexplained + least {
            true => fit = next,
            false => tried += 1,
        }
    }
    fit
}

/// Pairs of modes that all but coincide, in the order of their poles: the stronger one and the weaker one.
fn coinciding(fit: &Fit, len: usize) -> Vec<(usize, usize)> {
    let mut order: Vec<usize> = (0..fit.poles.len()).collect();
    order.sort_by(|a, b| fit.poles[*a].theta.total_cmp(&fit.poles[*b].theta));
    let near = |pair: &&[usize]| fit.poles[pair[0]].coincides(fit.poles[pair[1]], len);
    let strength = |k: usize| fit.amplitudes[k].norm();
    let ordered = |pair: &[usize]| match strength(pair[0]) < strength(pair[1]) {
        true => (pair[1], pair[0]),
        false => (pair[0], pair[1]),
    };
    order.windows(2).filter(near).map(ordered).collect()
}

/// Modes that are taken out of the normal equations one after the other. What is left is the solution without them, at
/// the cost of one outer product for each unknown.
struct Elimination {
    inverses: Inverses,
    amplitudes: Vec<Complex<f64>>,
    left: Vec<usize>,
    /// In the order in which they were taken out.
    removed: Vec<usize>,
}

impl Elimination {
    fn new(inverses: Inverses, amplitudes: Vec<Complex<f64>>) -> Self {
        Self { inverses, left: (0..amplitudes.len()).collect(), removed: Vec::new(), amplitudes }
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
        self.removed.push(k);
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
