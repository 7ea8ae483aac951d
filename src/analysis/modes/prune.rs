//! Drops modes of a fit that explain no more than noise would, the weakest first.

use super::detect::Spectra;
use super::fit::{Fit, Inverses, energy};
use super::pole::magnitude;
use nalgebra::DMatrix;
use sprung_fourier::{Complex, Planner};

/// Energy that a mode must explain, as a multiple of the average energy of noise near it. Noise alone exceeds it once
/// in e¹⁵ bins, 3 million.
pub(super) const DETECTION: f64 = 15.0;
/// The same if all poles are unknown, too. It is lower, since its own unknown pole costs a mode half of that energy.
const SIGNIFICANCE: f64 = 5.0;
/// Maximum number of times that the floor is measured, since dropped modes raise the residual.
const MOST_FLOORS: usize = 8;
/// Largest unexplained energy after modes are dropped, relative to that before.
const MOST_LEFT: f64 = 1.2;
/// Maximum number of refinement steps of the modes that stay.
const REFINED: usize = 8;

/// Drops modes until each remaining one explains more than noise would, and more than the energy `least`. `None` if the
/// equations cannot be solved.
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

/// A fit without modes that explain no more than noise, the weakest first. If modes are denser than their bandwidths,
/// each one seems useless, since its neighbours could explain its part; but without all of them, much would stay
/// unexplained. Then only as many are dropped as the others, once refined, can replace.
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

/// A fit in which two modes that almost coincide become one, if one explains the sound as well. Such modes were found
/// separately and share the amplitude of a single mode. `least` is the energy that need not be explained.
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

/// Pairs of modes that almost coincide, in the order of their poles: the stronger one and the weaker one.
fn coinciding(fit: &Fit, len: usize) -> Vec<(usize, usize)> {
    let mut order: Vec<usize> = (0..fit.poles.len()).collect();
    order.sort_by(|a, b| fit.poles[*a].theta.total_cmp(&fit.poles[*b].theta));
    let near = |pair: &&[usize]| fit.poles[pair[0]].coincides(fit.poles[pair[1]], len);
    let strength = |k: usize| magnitude(fit.amplitudes[k]);
    let ordered = |pair: &[usize]| match strength(pair[0]) < strength(pair[1]) {
        true => (pair[1], pair[0]),
        false => (pair[0], pair[1]),
    };
    order.windows(2).filter(near).map(ordered).collect()
}

/// Removes modes from the normal equations one after the other. The result is the solution without them, at the cost of
/// one outer product for each unknown.
struct Elimination {
    inverses: Inverses,
    amplitudes: Vec<Complex<f64>>,
    left: Vec<usize>,
    /// In the order of removal.
    removed: Vec<usize>,
}

impl Elimination {
    fn new(inverses: Inverses, amplitudes: Vec<Complex<f64>>) -> Self {
        Self { inverses, left: (0..amplitudes.len()).collect(), removed: Vec::new(), amplitudes }
    }

    /// The remaining mode that explains the least, and its energy as a multiple of the energy that it must explain.
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
            // The amplitudes solve the equations with all modes. Without this unknown, they take over its part.
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

/// Changes an inverse into that of the equations without one unknown.
fn take_out(inverse: &mut DMatrix<f64>, at: usize) {
    let column = inverse.column(at).into_owned();
    if column[at] > 0.0 {
        inverse.ger(-1.0 / column[at], &column, &column, 1.0);
    }
    inverse.column_mut(at).fill(0.0);
    inverse.row_mut(at).fill(0.0);
}
