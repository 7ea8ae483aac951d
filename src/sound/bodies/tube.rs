//! Air in tubes: open at both ends, closed at one end, and conical.

use super::partial::{Pair, Partial};
use super::roots;
use super::size::Size;
use libm::{cos, sin};
use std::f64::consts::{PI, SQRT_2};

/// Speed of sound in air of 20 °C, in m/s.
const SOUND: f64 = 343.2;

/// Length that an open end adds to a tube, in radii (Levine and Schwinger 1948).
const OPEN_END: f64 = 0.6133;

/// Open at both ends: integer ratios, with pressure shapes `sin n π x`.
pub(super) fn open(count: usize) -> Vec<Partial> {
    let partial = |n: usize| {
        let n = n as f64;
        Partial::new(n, Pair::Single, move |at| SQRT_2 * sin(n * PI * at.x))
    };
    (1..=count).map(partial).collect()
}

/// Closed at `x = 0`: odd ratios, with pressure shapes `cos (n − ½) π x`.
pub(super) fn stopped(count: usize) -> Vec<Partial> {
    let partial = |n: usize| {
        let odd = 2.0 * n as f64 - 1.0;
        Partial::new(odd, Pair::Single, move |at| SQRT_2 * cos(0.5 * odd * PI * at.x))
    };
    (1..=count).map(partial).collect()
}

/// A cone, closed at its narrow end `x = 0` and open at its mouth. `truncation` is the length cut off at the apex over
/// the rest.
///
/// Spherical waves `sin k(L−x) / (x₀+x)`; the closed end at `x = 0` requires `tan kL = −k x₀` (Fletcher and Rossing,
/// chapter 8). Ratios are integers for a complete cone (0) and approach the closed tube's odd ones as `truncation`
/// grows.
pub(super) fn cone(truncation: f64, count: usize) -> Vec<Partial> {
    let first = cone_root(truncation, 1);
    (1..=count)
        .map(|n| {
            let u = cone_root(truncation, n);
            // Weighted by the cone's cross-section, (x₀+x)², the mean square is that of the sine.
            let mean = 0.5 - sin(2.0 * u) / (4.0 * u);
            let (t, whole) = (truncation, 1.0 + truncation);
            let volume = (whole * whole * whole - t * t * t) / 3.0;
            let scale = (volume / mean).sqrt();
            let shape = move |x: f64| {
                let from_apex = t + x;
                // At the apex of a complete cone the quotient has a limit: u, up to a sign.
                if from_apex > 1e-9 { sin(u * (1.0 - x)) / from_apex } else { -u * cos(u) }
            };
            Partial::new(u / first, Pair::Single, move |at| scale * shape(at.x))
        })
        .collect()
}

/// The `n`-th root `u = kL`, between `(n − ½) π` and `n π`.
fn cone_root(truncation: f64, n: usize) -> f64 {
    let top = n as f64 * PI;
    if truncation == 0.0 { top } else { roots::between(|u| sin(u) + truncation * u * cos(u), top - 0.5 * PI, top) }
}

/// Lowest frequency in Hz of a tube of this length and bore, with the end correction of both open ends.
pub(super) fn open_frequency(size: &Size) -> f64 {
    SOUND / (2.0 * (size.length + OPEN_END * size.thickness))
}

/// The same for one open end.
pub(super) fn stopped_frequency(size: &Size) -> f64 {
    SOUND / (4.0 * (size.length + 0.5 * OPEN_END * size.thickness))
}

/// Lowest frequency in Hz of a cone with this length and diameter at the mouth.
pub(super) fn cone_frequency(truncation: f64, size: &Size) -> f64 {
    cone_root(truncation, 1) * SOUND / (2.0 * PI * (size.length + 0.5 * OPEN_END * size.thickness))
}
