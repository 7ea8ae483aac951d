//! Thin round plates (Kirchhoff): simply supported, or free at the rim like a gong or a cymbal.

use super::bessel::{i_ratio, i_relative};
use super::material::Material;
use super::partial::{Pair, Partial, lowest_below};
use super::plate::Edge;
use super::roots;
use super::size::Size;
use libm::jn;
use std::f64::consts::PI;

/// A mode with `n` nodal diameters: `λ` is its wave number times radius, and its shape `J_n(λr) + c I_n(λr)/I_n(λ)`.
#[derive(Clone, Copy)]
struct Mode {
    n: u32,
    lambda: f64,
}

/// `J_n`, `J_n′` and `J_{n+1}` at λ, and `I_n′` and `I_{n+1}` scaled so that `I_n` is 1.
struct Values {
    j: f64,
    dj: f64,
    j_next: f64,
    di: f64,
    i_next: f64,
}

impl Values {
    fn new(n: u32, lambda: f64) -> Self {
        let (j, j_next, i_next) = (jn(n as i32, lambda), jn(n as i32 + 1, lambda), i_ratio(n, lambda));
        let slope = f64::from(n) / lambda;
        Self { j, dj: slope * j - j_next, j_next, di: slope + i_next, i_next }
    }

    /// Bending moment at a free rim: the moment of the `J` part and that of the `I` part.
    fn moments(&self, n: u32, lambda: f64, poisson: f64) -> (f64, f64) {
        let (n2, l2, side) = (f64::from(n * n), lambda * lambda, 1.0 - poisson);
        (l2 * self.j + side * (lambda * self.dj - n2 * self.j), l2 - side * (lambda * self.di - n2))
    }

    /// Shear at a free rim, in the same form.
    fn shears(&self, n: u32, lambda: f64, poisson: f64) -> (f64, f64) {
        let (n2, l3, side) = (f64::from(n * n), lambda * lambda * lambda, 1.0 - poisson);
        (l3 * self.dj + side * n2 * (lambda * self.dj - self.j), l3 * self.di - side * n2 * (lambda * self.di - 1.0))
    }
}

/// A function that is zero at the frequencies. Supported: `J_{n+1}/J_n + I_{n+1}/I_n = 2λ/(1−ν)` (Leissa, "Vibration of
/// Plates" (1969), chapter 2). Free: moment and shear are both zero (same chapter; Itao and Crandall 1979).
fn characteristic(edge: Edge, n: u32, lambda: f64, poisson: f64) -> f64 {
    let values = Values::new(n, lambda);
    match edge {
        Edge::Supported => values.j_next + (values.i_next - 2.0 * lambda / (1.0 - poisson)) * values.j,
        Edge::Free => {
            let (moment_j, moment_i) = values.moments(n, lambda, poisson);
            let (shear_j, shear_i) = values.shears(n, lambda, poisson);
            // The I parts grow as λ² and λ³. After this division everything is of the size of J_n.
            (moment_j * shear_i - shear_j * moment_i) / (lambda * lambda * lambda * lambda)
        }
    }
}

fn modes(edge: Edge, poisson: f64, count: usize) -> Vec<Mode> {
    let below = |limit: f64| {
        let of = |n: u32| {
            // A free plate can also move without bending, with λ = 0. All other modes have λ > 0.9 n.
            let start = (0.9 * f64::from(n)).max(1.0);
            let lambdas = roots::all(|lambda| characteristic(edge, n, lambda, poisson), start, limit, 0.75);
            lambdas.into_iter().map(move |lambda| Mode { n, lambda })
        };
        (0..=(limit / 0.9) as u32).flat_map(of).collect()
    };
    lowest_below(count, 4.0 + (8.0 * count as f64).sqrt(), |mode: &Mode| mode.lambda, below)
}

pub(super) fn partials(edge: Edge, poisson: f64, count: usize) -> Vec<Partial> {
    let modes = modes(edge, poisson, count);
    let first = modes[0].lambda * modes[0].lambda;
    modes.into_iter().map(|mode| partial(edge, poisson, mode, first)).collect()
}

fn partial(edge: Edge, poisson: f64, Mode { n, lambda }: Mode, first: f64) -> Partial {
    let values = Values::new(n, lambda);
    let c = match edge {
        Edge::Supported => -values.j,
        Edge::Free => {
            let (of_j, of_i) = values.moments(n, lambda, poisson);
            of_j / of_i
        }
    };
    // ∫ J² r dr, ∫ I² r dr and ∫ J I r dr from 0 to 1 (Abramowitz and Stegun, section 11.3).
    let slope2 = f64::from(n * n) / (lambda * lambda);
    let jj = 0.5 * (values.dj * values.dj + (1.0 - slope2) * values.j * values.j);
    let ii = 0.5 * (1.0 + slope2 - values.di * values.di);
    let ji = 0.5 * (values.j_next + values.j * values.i_next) / lambda;
    let square = jj + 2.0 * c * ji + c * c * ii;
    let (pair, lobes) = if n == 0 { (Pair::Single, 2.0) } else { (Pair::Diameters(n), 1.0) };
    let scale = 1.0 / (lobes * square).sqrt();
    let shape = move |r: f64| scale * (jn(n as i32, lambda * r) + c * i_relative(n, lambda, r));
    Partial::new(lambda * lambda / first, pair, move |at| shape(at.x))
}

/// Lowest frequency in Hz: `f = λ² κ / (2π a²)`.
pub(super) fn frequency(edge: Edge, size: &Size, material: &Material) -> f64 {
    let lambda = modes(edge, material.poisson, 1)[0].lambda;
    let radius = 0.5 * size.length;
    lambda * lambda * material.plate_stiffness(size.thickness) / (2.0 * PI * radius * radius)
}
