//! A wine glass.

use super::bar::{self, Ends};
use super::material::Material;
use super::partial::{Pair, Partial, lowest_below};
use super::size::Size;
use std::f64::consts::PI;

/// A mode with `n` nodal diameters (2 and up) and, up the wall, the `q`-th shape of a clamped bar.
struct Mode {
    n: u32,
    beta: f64,
    omega: f64,
}

/// The wine glass of French, "In Vino Veritas: a study of wineglass acoustics" (1983). Its thin wall bends round the
/// glass as a ring, `n² − 1`, and up the wall as a bar that stands on the foot, `(β R/H)²`. The wall moves round by
/// `1/n` of its outward movement: `ω² ∝ ((n² − 1)² + (β R/H)⁴) / (1 + 1/n²)`. French gives this law for `n = 2`, with
/// β⁴ = 12. Here β is that of each shape of the bar, so that the height of a place on the wall matters. `slenderness`
/// is the height of the bowl over its radius.
pub(super) fn partials(slenderness: f64, count: usize) -> Vec<Partial> {
    let modes = modes(slenderness, count);
    let first = modes[0].omega;
    let partial = |Mode { n, beta, omega }: Mode| {
        // The mean square has two parts: the outward movement and the movement round the glass.
        let scale = 1.0 / (1.0 + 1.0 / f64::from(n * n)).sqrt();
        let pair = Pair::Diameters(n);
        // The factor cos² n θ has the mean ½.
        Partial::new(omega / first, pair, move |at| scale * 2.0_f64.sqrt() * bar::shape(Ends::Clamped, beta, at.x))
    };
    modes.into_iter().map(partial).collect()
}

fn modes(slenderness: f64, count: usize) -> Vec<Mode> {
    let below = |limit: f64| {
        let mut modes = Vec::new();
        for q in 1.. {
            let beta = bar::wave_number(Ends::Clamped, q);
            let before = modes.len();
            let row = (2..).map(|n| Mode { n, beta, omega: omega(n, beta / slenderness) });
            modes.extend(row.take_while(|mode| mode.omega <= limit));
            if modes.len() == before {
                break;
            }
        }
        modes
    };
    lowest_below(count, 8.0 + 2.0 / (slenderness * slenderness) + count as f64, |mode: &Mode| mode.omega, below)
}

fn omega(n: u32, along: f64) -> f64 {
    let (n2, along2) = (f64::from(n * n), along * along);
    let round = n2 - 1.0;
    ((round * round + along2 * along2) / (1.0 + 1.0 / n2)).sqrt()
}

/// Frequency in Hz: `f = h / (2π R²) · √(E / 12ρ) · ω`, where `h` is the thickness of the wall (French 1983).
pub(super) fn frequency(slenderness: f64, size: &Size, material: &Material) -> f64 {
    let radius = 0.5 * size.length;
    let ring = size.thickness * material.bar_speed() / 12.0_f64.sqrt() / (radius * radius);
    ring * modes(slenderness, 1)[0].omega / (2.0 * PI)
}
