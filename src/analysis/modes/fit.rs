//! Fits all modes of a sound at once, by least squares: amplitudes exactly, poles by Gauss–Newton.
//!
//! The model is `c + Σ Re aₖ·zₖⁿ`. It is linear in the amplitudes, which are solved for at each step (variable
//! projection, Golub & Pereyra 1973). A step needs only two sums over the samples for each pole. Products of two modes
//! are sums of powers, which have a closed form.

use super::pole::{Ladder, Pole, add, correlations, magnitude};
use crate::analysis::level;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use sprung_fourier::Complex;

/// Largest step of a pole, in its own widths.
const LONGEST_STEP: f64 = 0.7;
/// Values that are added to the unit diagonal of normal equations, so that poles which almost coincide can be solved
/// for; the least that works is used.
const RIDGES: [f64; 6] = [1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4];

/// Smallest share of a quadrature's norm that is more than rounding errors.
const CANCELLED: f64 = 1e-10;

/// Modes with the amplitudes that fit best.
#[derive(Clone)]
pub(super) struct Fit {
    pub(super) poles: Vec<Pole>,
    /// `aₖ`: magnitude and phase (of a cosine) at the first sample.
    pub(super) amplitudes: Vec<Complex<f64>>,
    /// The constant.
    pub(super) constant: f64,
    /// Energy of the residual.
    pub(super) unexplained: f64,
    correlations: Vec<[Complex<f64>; 2]>,
    gram: Gram,
}

/// `Σ τᵐ` of the products of any two poles, with and without the first being conjugated.
#[derive(Clone)]
struct Gram {
    count: usize,
    plain: Vec<[Complex<f64>; 3]>,
    conjugated: Vec<[Complex<f64>; 3]>,
}

/// A direction in which the model can change: `Re(factor · τᵖ · zⁿ)` of one pole.
#[derive(Clone, Copy)]
struct Direction {
    pole: usize,
    power: usize,
    factor: Complex<f64>,
}

impl Gram {
    fn new(poles: &[Pole], len: usize) -> Self {
        let (ladder, count) = (Ladder::new(poles, len), poles.len());
        let mut plain = vec![[Complex::ZERO; 3]; count * count];
        let mut conjugated = plain.clone();
        for first in 0..count {
            for second in first..count {
                let (sums, other) = (ladder.sums(first, second, false), ladder.sums(first, second, true));
                (plain[first * count + second], conjugated[first * count + second]) = (sums, other);
                plain[second * count + first] = sums;
                conjugated[second * count + first] = other.map(|sum| sum.conj());
            }
        }
        Self { count, plain, conjugated }
    }

    /// Inner product of two directions.
    fn product(&self, a: Direction, b: Direction) -> f64 {
        let (at, m) = (a.pole * self.count + b.pole, a.power + b.power);
        let sum = a.factor * b.factor * self.plain[at][m] + a.factor.conj() * b.factor * self.conjugated[at][m];
        0.5 * sum.re
    }

    /// Mean square norm of a direction and its quadrature, a quarter turn from it.
    fn whole(&self, direction: Direction) -> f64 {
        let at = direction.pole * self.count + direction.pole;
        0.5 * direction.factor.norm_sqr() * self.conjugated[at][2 * direction.power].re
    }

    fn normal(&self, directions: &[Direction]) -> DMatrix<f64> {
        let len = directions.len();
        let mut matrix = DMatrix::zeros(len, len);
        for column in 0..len {
            for row in column..len {
                let product = self.product(directions[row], directions[column]);
                (matrix[(row, column)], matrix[(column, row)]) = (product, product);
            }
            // For a pole that hardly oscillates, a quadrature is the difference of two sums. If they are almost equal,
            // only rounding errors are left.
            let least = CANCELLED * self.whole(directions[column]);
            matrix[(column, column)] = matrix[(column, column)].max(least);
        }
        matrix
    }
}

/// A positive matrix scaled to a unit diagonal and factored.
struct Solver {
    scale: DVector<f64>,
    factors: Cholesky<f64, Dyn>,
}

impl Solver {
    /// `damping` is added to the unit diagonal. `None` for a matrix that is not positive.
    fn new(mut matrix: DMatrix<f64>, damping: f64) -> Option<Self> {
        let scale = matrix.diagonal().map(|entry| if entry > 0.0 { 1.0 / libm::sqrt(entry) } else { 1.0 });
        for column in 0..matrix.ncols() {
            for row in 0..matrix.nrows() {
                matrix[(row, column)] *= scale[row] * scale[column];
            }
            matrix[(column, column)] += damping;
        }
        let ridged = |ridge: f64| {
            let mut matrix = matrix.clone();
            (0..matrix.ncols()).for_each(|at| matrix[(at, at)] += ridge);
            Cholesky::new(matrix)
        };
        Some(Self { scale, factors: RIDGES.into_iter().find_map(ridged)? })
    }

    fn solve(&self, right: &DVector<f64>) -> DVector<f64> {
        self.factors.solve(&right.component_mul(&self.scale)).component_mul(&self.scale)
    }

    fn inverse(&self) -> DMatrix<f64> {
        let mut inverse = self.factors.inverse();
        for column in 0..inverse.ncols() {
            for row in 0..inverse.nrows() {
                inverse[(row, column)] *= self.scale[row] * self.scale[column];
            }
        }
        inverse
    }
}

/// The two directions of each pole's amplitude, and the constant's one.
fn linear_directions(count: usize) -> Vec<Direction> {
    let one = |pole| Direction { pole, power: 0, factor: Complex::new(1.0, 0.0) };
    let mut directions: Vec<_> =
        (0..count).flat_map(|pole| [one(pole), Direction { factor: Complex::i(), ..one(pole) }]).collect();
    directions.push(one(count));
    directions
}

/// Inverses of the normal equations: two rows for each amplitude and one for the constant, then two for each pole.
pub(super) struct Inverses {
    /// Of the amplitudes and the constant.
    pub(super) alone: DMatrix<f64>,
    /// Of these and the poles.
    pub(super) all: DMatrix<f64>,
}

/// The certainty of a fit's modes.
pub(super) struct Certainty {
    /// Energy that each mode explains and the others could not.
    pub(super) explained: Vec<f64>,
    /// Variances of decay, theta, relative amplitude and phase, for noise of variance 1.
    pub(super) variances: Vec<[f64; 4]>,
}

impl Fit {
    /// The best amplitudes for these poles. `None` if the equations cannot be solved.
    pub(super) fn new(samples: &[f64], poles: Vec<Pole>) -> Option<Self> {
        let energy = level::energy(samples, 0.0);
        let mut all = poles.clone();
        all.push(Pole::CONSTANT);
        let (correlations, gram) = (correlations(samples, &all), Gram::new(&all, samples.len()));
        let directions = linear_directions(poles.len());
        let right = DVector::from_iterator(
            directions.len(),
            directions.iter().map(|direction| (direction.factor.conj() * correlations[direction.pole][0]).re),
        );
        let solved = Solver::new(gram.normal(&directions), 0.0)?.solve(&right);
        let amplitudes = (0..poles.len()).map(|k| Complex::new(solved[2 * k], solved[2 * k + 1])).collect();
        let unexplained = (energy - solved.dot(&right)).max(0.0);
        let constant = solved[2 * poles.len()];
        unexplained.is_finite().then_some(Self { poles, amplitudes, constant, unexplained, correlations, gram })
    }

    /// The samples minus the model.
    pub(super) fn residual(&self, samples: &[f64]) -> Vec<f64> {
        let mut residual: Vec<f64> = samples.iter().map(|sample| sample - self.constant).collect();
        for (pole, amplitude) in self.poles.iter().zip(&self.amplitudes) {
            add(&mut residual, *pole, *amplitude, -1.0);
        }
        residual
    }

    /// The directions of all amplitudes, then of the constant, then of all poles.
    fn directions(&self) -> Vec<Direction> {
        let mut directions = linear_directions(self.poles.len());
        for (pole, amplitude) in self.amplitudes.iter().enumerate() {
            directions.push(Direction { pole, power: 1, factor: *amplitude });
            directions.push(Direction { pole, power: 1, factor: *amplitude * Complex::i() });
        }
        directions
    }

    /// The change of the poles that Gauss–Newton proposes with Marquardt's damping, as `Δ ln z · len`.
    fn step(&self, damping: f64) -> Option<Vec<Complex<f64>>> {
        let (count, directions) = (self.poles.len(), self.directions());
        let mut amplitudes = self.amplitudes.clone();
        amplitudes.push(Complex::new(self.constant, 0.0));
        let gradient = |direction: &Direction| {
            if direction.power == 0 {
                // The amplitudes are optimal already.
                return 0.0;
            }
            let data = (direction.factor.conj() * self.correlations[direction.pole][1]).re;
            let model = |(pole, factor): (usize, &Complex<f64>)| {
                self.gram.product(*direction, Direction { pole, power: 0, factor: *factor })
            };
            data - amplitudes.iter().enumerate().map(model).sum::<f64>()
        };
        let right = DVector::from_iterator(directions.len(), directions.iter().map(gradient));
        let solved = Solver::new(self.gram.normal(&directions), damping)?.solve(&right);
        let start = 2 * count + 1;
        Some((0..count).map(|k| Complex::new(solved[start + 2 * k], solved[start + 2 * k + 1])).collect())
    }

    /// Moves the poles until the unexplained energy is least: until a step moves no pole by more than `tolerance` of
    /// its width, or `rounds` are over.
    pub(super) fn refine(
        mut self,
        samples: &[f64],
        tolerance: f64,
        rounds: usize,
        go_on: &mut dyn FnMut() -> bool,
    ) -> Self {
        let len = samples.len();
        let mut damping = 1e-4;
        for _ in 0..rounds {
            if self.poles.is_empty() || !go_on() {
                break;
            }
            let Some(step) = self.step(damping) else { break };
            let mut most: f64 = 0.0;
            let moved = self.poles.iter().zip(&step).map(|(pole, step)| {
                let width = pole.width(len);
                let size = magnitude(*step) / len as f64 / width;
                most = most.max(size);
                let scale = if size > LONGEST_STEP { LONGEST_STEP / size } else { 1.0 } / len as f64;
                Pole {
                    decay: (pole.decay - step.re * scale).max(0.0),
                    theta: (pole.theta + step.im * scale).clamp(1e-6, std::f64::consts::PI - 1e-6),
                }
            });
            let moved: Vec<Pole> = moved.collect();
            let tried = Self::new(samples, moved);
            let settled = 1e-14 * self.gram.conjugated.last().map_or(0.0, |sum| sum[0].re) + 1e-12 * self.unexplained;
            match tried.filter(|tried| tried.unexplained <= self.unexplained + settled) {
                Some(tried) => {
                    let gained = self.unexplained - tried.unexplained;
                    self = tried;
                    damping = (damping * 0.1).max(1e-9);
                    if most < tolerance && gained <= 1e-6 * self.unexplained.max(f64::MIN_POSITIVE) || most < 1e-9 {
                        break;
                    }
                }
                None if most < tolerance => break,
                None => {
                    damping *= 10.0;
                    if damping > 1e3 {
                        break;
                    }
                }
            }
        }
        self
    }

    /// Inverses of the normal equations: of the amplitudes alone, and of amplitudes and poles. `None` if the equations
    /// cannot be solved.
    pub(super) fn inverses(&self) -> Option<Inverses> {
        let alone = Solver::new(self.gram.normal(&linear_directions(self.poles.len())), 0.0)?.inverse();
        let all = Solver::new(self.gram.normal(&self.directions()), 0.0)?.inverse();
        Some(Inverses { alone, all })
    }

    /// The certainty of the modes. `None` if the equations cannot be solved.
    pub(super) fn certainty(&self, len: usize) -> Option<Certainty> {
        let (count, Inverses { alone, all }) = (self.poles.len(), self.inverses()?);
        let variances = |k: usize| {
            let (at, square) = (2 * count + 1 + 2 * k, (len as f64) * (len as f64));
            let (x, y, power) = (self.amplitudes[k].re, self.amplitudes[k].im, self.amplitudes[k].norm_sqr());
            let (a, b, c) = (all[(2 * k, 2 * k)], all[(2 * k, 2 * k + 1)], all[(2 * k + 1, 2 * k + 1)]);
            let along = (a * x * x + 2.0 * b * x * y + c * y * y) / (power * power);
            let across = (a * y * y - 2.0 * b * x * y + c * x * x) / (power * power);
            [all[(at, at)] / square, all[(at + 1, at + 1)] / square, along, across]
        };
        Some(Certainty {
            explained: (0..count).map(|k| energy(&alone, k, self.amplitudes[k])).collect(),
            variances: (0..count).map(variances).collect(),
        })
    }
}

/// Square of a mode's amplitude over its variance, from an inverse of the normal equations: the energy that only this
/// mode can explain.
pub(super) fn energy(inverse: &DMatrix<f64>, k: usize, amplitude: Complex<f64>) -> f64 {
    let (a, b, c) = (inverse[(2 * k, 2 * k)], inverse[(2 * k, 2 * k + 1)], inverse[(2 * k + 1, 2 * k + 1)]);
    let (x, y) = (amplitude.re, amplitude.im);
    let determinant = a * c - b * b;
    if determinant > 0.0 { (c * x * x - 2.0 * b * x * y + a * y * y) / determinant } else { 0.0 }
}
