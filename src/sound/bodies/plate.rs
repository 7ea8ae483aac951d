//! Thin rectangular plates (Kirchhoff): simply supported on all sides, or free.

use super::bar::{self, Ends};
use super::material::Material;
use super::partial::{Pair, Partial, lowest_below};
use super::size::Size;
use libm::sin;
use std::f64::consts::PI;

/// How the edge of a plate is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edge {
    /// It cannot move but it can turn: a hinge on all sides.
    Supported,
    /// It is free: a gong, a cymbal, a hanging sheet.
    Free,
}

/// A mode with `m` half waves, or nodal lines, along x and `n` along y. `k2` is its frequency in units in which the
/// mode (1,0) of a simply supported plate would have 1.
struct Mode {
    m: usize,
    n: usize,
    k2: f64,
}

/// `aspect` is the length along x over the length along y.
pub(super) fn partials(edge: Edge, aspect: f64, poisson: f64, count: usize) -> Vec<Partial> {
    let modes = modes(edge, aspect, poisson, count);
    let first = modes[0].k2;
    modes
        .into_iter()
        .map(|Mode { m, n, k2 }| match edge {
            Edge::Supported => {
                let half_waves = move |n: usize, at: f64| sin(n as f64 * PI * at);
                Partial::new(k2 / first, Pair::Single, move |at| 2.0 * half_waves(m, at.x) * half_waves(n, at.y))
            }
            Edge::Free => {
                let (along, across) = (Line::new(m), Line::new(n));
                Partial::new(k2 / first, Pair::Single, move |at| along.at(at.x) * across.at(at.y))
            }
        })
        .collect()
}

fn modes(edge: Edge, aspect: f64, poisson: f64, count: usize) -> Vec<Mode> {
    let first = if edge == Edge::Supported { 1 } else { 0 };
    let below = |limit: f64| {
        let mut modes = Vec::new();
        // The mode (m,n) of a free plate is above (m−½)², the value for bending along x alone; the same applies along
        // y.
        let most = |factor: f64| (limit.sqrt() / factor) as usize + 1;
        for m in first..=most(1.0) {
            for n in first..=most(aspect) {
                let k2 = frequency_number(edge, m, n, aspect, poisson);
                if k2 <= limit && k2 > 0.0 {
                    modes.push(Mode { m, n, k2 });
                }
            }
        }
        modes
    };
    // Below a limit there are about π/4 · limit / aspect modes.
    lowest_below(count, 2.0 + 1.3 * aspect * count as f64, |mode: &Mode| mode.k2, below)
}

/// Supported: `m² + (n·aspect)²` (Navier 1823; Leissa, "Vibration of Plates" (1969), chapter 4).
///
/// Free: Rayleigh's method with the shapes of free bars (Warburton 1954; Leissa, chapter 4). The square of the
/// frequency number is `G_m⁴ + (aspect·G_n)⁴ + 2 aspect² (ν H_m H_n + (1−ν) J_m J_n)`. For a square plate, compared
/// with Leissa's 13.49, 19.79, 24.43 and 35.02, the first modes are 5 % and 13 % too high, 8 % too low and 4 % too
/// high, because true shapes mix (2,0) with (0,2). Plates that are not square mix them less.
fn frequency_number(edge: Edge, m: usize, n: usize, aspect: f64, poisson: f64) -> f64 {
    if edge == Edge::Supported {
        let (x, y) = (m as f64, aspect * n as f64);
        return x * x + y * y;
    }
    let ([gx, hx, jx], [gy, hy, jy]) = (warburton(m), warburton(n));
    let a2 = aspect * aspect;
    let bent = gx * gx * gx * gx + a2 * a2 * gy * gy * gy * gy;
    (bent + 2.0 * a2 * (poisson * hx * hy + (1.0 - poisson) * jx * jy)).sqrt()
}

/// `G`, `H` and `J` along one side: for a plate that moves as a whole (`m` = 0), turns (1), or bends as a free bar with
/// `m` nodes.
fn warburton(m: usize) -> [f64; 3] {
    match m {
        0 => [0.0, 0.0, 0.0],
        1 => [0.0, 0.0, 12.0 / (PI * PI)],
        2 => [1.506, 1.248, 5.017],
        _ => {
            let g = m as f64 - 0.5;
            [g, g * g * (1.0 - 2.0 / (g * PI)), g * g * (1.0 + 6.0 / (g * PI))]
        }
    }
}

/// The shape of a free plate along one side, with mean square 1.
enum Line {
    Still,
    Turning,
    Bent(f64),
}

impl Line {
    fn new(m: usize) -> Self {
        match m {
            0 => Self::Still,
            1 => Self::Turning,
            _ => Self::Bent(bar::wave_number(Ends::Free, m - 1)),
        }
    }

    fn at(&self, x: f64) -> f64 {
        match self {
            Self::Still => 1.0,
            Self::Turning => 3.0_f64.sqrt() * (1.0 - 2.0 * x),
            Self::Bent(beta) => bar::shape(Ends::Free, *beta, x),
        }
    }
}

/// Lowest frequency in Hz: `f = κ π/2 · k2 / L²`, where `L` is the side along x.
pub(super) fn frequency(edge: Edge, aspect: f64, size: &Size, material: &Material) -> f64 {
    let first = modes(edge, aspect, material.poisson, 1)[0].k2;
    material.plate_stiffness(size.thickness) * 0.5 * PI * first / (size.length * size.length)
}
