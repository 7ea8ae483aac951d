//! An ideal round membrane.

use super::bessel::zeros_below;
use super::material::Material;
use super::partial::{Pair, Partial, Point, lowest_below};
use super::size::Size;
use libm::jn;
use std::f64::consts::{PI, SQRT_2};

/// The first zero of `J_0`.
pub(super) const J_01: f64 = 2.404_825_557_695_773;

/// A mode with `m` nodal diameters: its wave number times radius is `k = j_mn`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    pub(super) m: u32,
    pub(super) k: f64,
}

impl Mode {
    /// The lowest `count` modes; a pair counts as one.
    pub(super) fn lowest(count: usize) -> Vec<Mode> {
        let below = |limit: f64| {
            // j_m1 is above m, so modes with more diameters are above the limit.
            let of = |m: u32| zeros_below(m, limit).into_iter().map(move |k| Mode { m, k });
            (0..=limit as u32).flat_map(of).collect()
        };
        // By Weyl's law there are about k²/8 modes below k.
        lowest_below(count, 4.0 + (8.0 * count as f64).sqrt(), |mode: &Mode| mode.k, below)
    }

    pub(super) fn pair(self) -> Pair {
        if self.m == 0 { Pair::Single } else { Pair::Diameters(self.m) }
    }

    /// `√2 J_m(k r) / |J_{m+1}(k)|`, for `m = 0` without the root: together with the factor `cos m θ`, its mean square
    /// over the disk is 1.
    pub(super) fn shape(self) -> impl Fn(Point) -> f64 + 'static {
        let m = self.m as i32;
        let scale = if m == 0 { 1.0 } else { SQRT_2 } / jn(m + 1, self.k).abs();
        move |at| scale * jn(m, self.k * at.x)
    }
}

/// Frequencies in proportion to the zeros of the Bessel functions; `J_01` has ratio 1 (Rayleigh, "The Theory of Sound",
/// §200 to §206).
pub(super) fn partials(count: usize) -> Vec<Partial> {
    Mode::lowest(count).into_iter().map(|mode| Partial::new(mode.k / J_01, mode.pair(), mode.shape())).collect()
}

/// Lowest frequency in Hz: `f_01 = j_01 / (π d) · √(T / (ρ h))`.
pub(super) fn frequency(size: &Size, material: &Material) -> f64 {
    J_01 / (PI * size.length) * (size.tension / (material.density * size.thickness)).sqrt()
}
