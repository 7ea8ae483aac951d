//! How a frequency between the points of a Fourier transform's grid takes part in it: by taps of a Kaiser–Bessel kernel.
//!
//! A sum `Σ a(t) e^(2πi ξt/N)` over the middle half of `N` frames is the transform's value at a frequency `ξ` off its grid. It
//! equals `Σ K(ξ − k) A[k]` over the points `k` near `ξ`, where `A` is the transform of `a` divided by that of the kernel `K`
//! (a non-uniform Fourier transform: J. A. Fessler and B. P. Sutton, 2003). It holds for complex `ξ` as well: an imaginary
//! part is a damping. The same taps, read the other way, add a mode to a grid.
//!
//! A tap is a polynomial of the distance `δ` from a centre. So modes near a centre need no taps of their own: their powers of
//! `δ` are summed instead.

use libm::{cos, sinh, sqrt};
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Number of taps.
pub(super) const TAPS: usize = 8;

/// Centres are at multiples of this fraction of a grid step.
pub(super) const FRACTIONS: usize = 16;

/// Numbers of terms of the polynomials: few for small distances, more for large ones.
pub(super) const TERMS: [usize; 3] = [6, 7, 8];

/// Most terms.
pub(super) const MOST_TERMS: usize = 8;

/// Imaginary distances up to which the first numbers of terms keep the error below −102 dB, if the real distance is at most
/// 0.43.
pub(super) const DAMPINGS: [f64; 2] = [0.015, 0.1];

/// Real distances for which the polynomials are made.
const REACHES: [f64; 3] = [0.44, 0.5, 0.5];

/// Width of the kernel in grid steps. Wider ones would need more taps, narrower ones are less exact.
const WIDTH: f64 = 6.8;

/// The taps around a centre: coefficients of `δ^p`, by term and by tap.
#[derive(Clone, Debug, Default)]
pub(super) struct Taps {
    pub(super) by_term: [[f32; TAPS]; MOST_TERMS],
    pub(super) by_tap: [[f32; MOST_TERMS]; TAPS],
}

/// The taps for each of [`TERMS`] and each fraction. The first call computes them, so do not make it on the audio thread.
pub(super) fn tables() -> &'static [[Taps; FRACTIONS]; 3] {
    static TABLES: LazyLock<[[Taps; FRACTIONS]; 3]> = LazyLock::new(|| {
        std::array::from_fn(|order| std::array::from_fn(|fraction| taps(TERMS[order], REACHES[order], fraction)))
    });
    &TABLES
}

/// What divides a frame at `t` from the middle, so that the taps are exact: the kernel's own transform at `t`.
pub(super) fn kernel_transform(t: f64, size: usize) -> f64 {
    let (b, a) = (shape(), PI * WIDTH * t / size as f64);
    let root = sqrt(b * b - a * a);
    WIDTH * sinh(root) / (root * bessel(b * b))
}

/// The best shape for grids twice as fine as needed (P. J. Beatty, D. G. Nishimura and J. M. Pauly, 2005).
fn shape() -> f64 {
    PI * sqrt(WIDTH * WIDTH * 9.0 / 16.0 - 0.8)
}

/// The modified Bessel function `I₀(√x)`, by its series.
fn bessel(x: f64) -> f64 {
    let (mut sum, mut term) = (1.0, 1.0);
    for k in 1..60 {
        term *= 0.25 * x / f64::from(k * k);
        sum += term;
    }
    sum
}

fn kernel(x: f64) -> f64 {
    let (b2, u) = (shape() * shape(), 2.0 * x / WIDTH);
    bessel(b2 * (1.0 - u * u)) / bessel(b2)
}

/// The taps by Chebyshev interpolation for distances from −`reach` to `reach`.
fn taps(terms: usize, reach: f64, fraction: usize) -> Taps {
    let mut taps = Taps::default();
    let angle = |node: usize| (2 * node + 1) as f64 * PI / (2 * terms) as f64;
    for tap in 0..TAPS {
        let centre = fraction as f64 / FRACTIONS as f64;
        let value = |distance: f64| kernel(tap as f64 - 3.0 - centre - distance);
        let mut powers = [0.0; MOST_TERMS];
        // Chebyshev polynomials k − 1 and k, as powers.
        let (mut before, mut now) = ([0.0; MOST_TERMS + 1], [0.0; MOST_TERMS + 1]);
        now[0] = 1.0;
        for k in 0..terms {
            let sum: f64 = (0..terms).map(|n| value(reach * cos(angle(n))) * cos(k as f64 * angle(n))).sum();
            let weight = sum * if k == 0 { 1.0 } else { 2.0 } / terms as f64;
            (0..terms).for_each(|p| powers[p] += weight * now[p]);
            let double = if k == 0 { 1.0 } else { 2.0 };
            let next = std::array::from_fn(|p| double * if p > 0 { now[p - 1] } else { 0.0 } - before[p]);
            (before, now) = (now, next);
        }
        let mut scale = 1.0;
        for p in 0..terms {
            let power = (powers[p] * scale) as f32;
            (taps.by_term[p][tap], taps.by_tap[tap][p]) = (power, power);
            scale /= reach;
        }
    }
    taps
}

#[cfg(test)]
mod tests {
    use super::*;
    use libm::{exp, log10, sin};
    use std::f64::consts::TAU;

    /// Largest error, in dB, of a damped sine through the taps, over all phases of a centre and distances of a magnitude.
    fn error(order: usize, real: f64, imaginary: f64) -> f64 {
        let (size, table) = (1024, &tables()[order]);
        let mut most: f64 = 0.0;
        for fraction in [0, 5, 15] {
            for (real, imaginary) in [(real, imaginary), (-real, imaginary), (0.0, imaginary), (0.5 * real, imaginary)]
            {
                let mut powers = [[0.0; 2]; MOST_TERMS];
                powers[0] = [1.0, 0.0];
                for p in 1..MOST_TERMS {
                    let [re, im] = powers[p - 1];
                    powers[p] = [re * real - im * imaginary, re * imaginary + im * real];
                }
                for t in [-256, -255, -200, -100, -3, 0, 50, 170, 255, 256].map(f64::from) {
                    let mut sum = [0.0; 2];
                    for tap in 0..TAPS {
                        let mut weight = [0.0; 2];
                        for (p, power) in powers.iter().enumerate() {
                            let factor = f64::from(table[fraction].by_term[p][tap]);
                            weight = [weight[0] + factor * power[0], weight[1] + factor * power[1]];
                        }
                        let (s, c) =
                            (sin(TAU * (tap as f64 - 3.0) * t / 1024.0), cos(TAU * (tap as f64 - 3.0) * t / 1024.0));
                        sum = [sum[0] + weight[0] * c - weight[1] * s, sum[1] + weight[0] * s + weight[1] * c];
                    }
                    let found = sum.map(|sum| sum / kernel_transform(t, size));
                    let (turns, level) =
                        ((fraction as f64 / 16.0 + real) * t / 1024.0, exp(-TAU * imaginary * t / 1024.0));
                    let exact = [level * cos(TAU * turns), level * sin(TAU * turns)];
                    let (re, im) = (found[0] - exact[0], found[1] - exact[1]);
                    most = most.max(sqrt(re * re + im * im));
                }
            }
        }
        20.0 * log10(most)
    }

    #[test]
    fn taps_are_exact_up_to_their_distances() {
        for (order, real, imaginary) in [(0, 0.43, 0.0), (0, 0.43, 0.015), (1, 0.43, 0.1), (2, 0.28, 0.26)] {
            let found = error(order, real, imaginary);
            println!("{} terms, {real} + {imaginary} i: {found:.1} dB", TERMS[order]);
            assert!(found < -100.0, "{} terms, {real} + {imaginary} i: {found} dB", TERMS[order]);
        }
    }
}
