//! Bars: with free ends, as in mallet instruments, plain or tuned by undercutting; and clamped at one end.

use super::material::Material;
use super::partial::{Pair, Partial};
use super::size::Size;
use libm::{cos, exp, sin};
use std::f64::consts::PI;

/// How a bar is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ends {
    /// Both ends free.
    Free,
    /// Clamped at `x = 0`, free at `x = 1`.
    Clamped,
}

/// Wave number times length, `β`, of the `k`-th mode of a uniform bar, `k` from 1: the roots of `cos β cosh β = ±1`,
/// with plus for a free bar and minus for a clamped one (Euler 1744; Fletcher and Rossing, "The Physics of Musical
/// Instruments", chapter 2).
pub(super) fn wave_number(ends: Ends, k: usize) -> f64 {
    let (sign, start) = match ends {
        Ends::Free => (1.0, (k as f64 + 0.5) * PI),
        Ends::Clamped => (-1.0, (k as f64 - 0.5) * PI),
    };
    // Newton's method on cos β ∓ 1/cosh β. From these starting values, close to the roots, it needs at most five steps.
    let mut beta = start;
    for _ in 0..8 {
        let decay = exp(-beta);
        let sech = 2.0 * decay / (1.0 + decay * decay);
        let tanh = (1.0 - decay * decay) / (1.0 + decay * decay);
        beta -= (cos(beta) - sign * sech) / (sign * sech * tanh - sin(beta));
    }
    beta
}

/// The shape of this mode at `x`, with mean square 1: `cosh βx ± cos βx − σ (sinh βx ± sin βx)`. The large parts of the
/// hyperbolic functions, which would cancel, are removed first.
pub(super) fn shape(ends: Ends, beta: f64, x: f64) -> f64 {
    let (sign, e) = (if ends == Ends::Free { 1.0 } else { -1.0 }, exp(-beta));
    let (sin_b, cos_b) = (sin(beta), cos(beta));
    // σ is about 1, and e^(βx), which is up to e^β, is multiplied by σ − 1. So σ − 1 is stored times e^β.
    let (numerator, denominator) = match ends {
        Ends::Free => (cos_b - sin_b - e, 1.0 - e * e - 2.0 * e * sin_b),
        Ends::Clamped => (cos_b + sin_b + e, 1.0 + e * e + 2.0 * e * cos_b),
    };
    let rising = numerator / denominator;
    let sigma = 1.0 - 2.0 * e * rising;
    rising * exp(beta * (x - 1.0))
        + 0.5 * (1.0 + sigma) * exp(-beta * x)
        + sign * (cos(beta * x) - sigma * sin(beta * x))
}

/// The modes of a uniform bar: frequencies in proportion to `β²`.
pub(super) fn partials(ends: Ends, count: usize) -> Vec<Partial> {
    let first = wave_number(ends, 1);
    (1..=count).map(|k| wave_number(ends, k)).map(|beta| partial(ends, beta, beta * beta / (first * first))).collect()
}

fn partial(ends: Ends, beta: f64, ratio: f64) -> Partial {
    Partial::new(ratio, Pair::Directions, move |at| shape(ends, beta, at.x))
}

/// A free bar, undercut so that its first modes have the ratios `tuned`. Above them, ratios grow as in a uniform bar.
///
/// Makers tune a marimba to 1 : 4 : 10, a vibraphone to 1 : 4 : 10 and a xylophone to 1 : 3 : 6 (Fletcher and Rossing,
/// chapter 19; Bork 1995). The ratios above are within 3 % of those measured on a marimba, 16.3 : 24.2 : 33.5 (same
/// chapter). The shapes are those of a uniform bar: undercutting moves the nodes only slightly.
pub(super) fn tuned(tuned: &[f64], count: usize) -> Vec<Partial> {
    let (last, last_beta) = (tuned[tuned.len() - 1], wave_number(Ends::Free, tuned.len()));
    let ratio = |k: usize, beta: f64| tuned.get(k - 1).copied().unwrap_or(last * beta * beta / (last_beta * last_beta));
    (1..=count)
        .map(|k| (k, wave_number(Ends::Free, k)))
        .map(|(k, beta)| partial(Ends::Free, beta, ratio(k, beta)))
        .collect()
}

/// Frequency in Hz of a flat bar: `f₁ = β₁² / (2π L²) · √(E/ρ) · h/√12` (Fletcher and Rossing, chapter 2).
pub(super) fn frequency(ends: Ends, size: &Size, material: &Material) -> f64 {
    bending(wave_number(ends, 1), size, material, size.thickness / 12.0_f64.sqrt())
}

/// Frequency in Hz of the mode `β` of a bar with the radius of gyration `gyration` in metres.
pub(super) fn bending(beta: f64, size: &Size, material: &Material, gyration: f64) -> f64 {
    beta * beta / (2.0 * PI * size.length * size.length) * material.bar_speed() * gyration
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_have_mean_square_1_and_the_ends_of_their_bar() {
        for ends in [Ends::Free, Ends::Clamped] {
            for k in [1, 2, 3, 10, 100, 512] {
                let beta = wave_number(ends, k);
                let steps = 40 * k + 400;
                let square = |i: usize| {
                    let value = shape(ends, beta, (i as f64 + 0.5) / steps as f64);
                    value * value
                };
                let mean = (0..steps).map(square).sum::<f64>() / steps as f64;
                assert!((mean - 1.0).abs() < 2e-3, "{ends:?} {k}: {mean}");
                assert!((shape(ends, beta, 1.0).abs() - 2.0).abs() < 1e-9, "{ends:?} {k}");
                let foot = shape(ends, beta, 0.0).abs();
                assert!((foot - if ends == Ends::Free { 2.0 } else { 0.0 }).abs() < 1e-9, "{ends:?} {k}: {foot}");
            }
        }
    }

    #[test]
    fn a_steel_ruler_has_the_pitch_of_its_size() {
        let size = Size { length: 0.3, thickness: 1e-3, tension: 0.0 };
        let steel = Material::find("steel").unwrap();
        let c = (2.0e11_f64 / 7850.0).sqrt();
        let expected = 1.0279 * c * 1e-3 / (0.3 * 0.3);
        assert!((frequency(Ends::Free, &size, steel) / expected - 1.0).abs() < 1e-3);
    }
}
