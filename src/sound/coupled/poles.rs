//! Computes all poles of two joined bodies together, by Aberth's iteration on the secular equation.
//!
//! Aberth ("Iteration methods for finding all zeros of a polynomial simultaneously", Math. Comp. 27, 1973) improves a
//! guess of each zero of a polynomial `N` by `1/(N′/N − Σ 1/(s − s_k))`, where the sum is over the guesses of all other
//! zeros. It converges cubically and finds no zero twice. Bini & Robol ("Solving secular and polynomial equations", J.
//! Comput. Appl. Math. 272, 2014) apply it to secular equations. Here `N = F Π q_k` is real, so each guess also stands
//! for its conjugate. Real poles come in pairs as well: near the real axis a whole quadratic factor is improved at
//! once, to the quadratic that has the values of `N` divided by all other factors. Kerner (Numer. Math. 8, 1966) does
//! so for single zeros.

use super::complex::Complex;
use super::system::{Place, System};

/// Two poles, which are found together.
#[derive(Clone, Copy, Debug)]
pub(super) enum Pair {
    /// A pole above the real axis, and its conjugate.
    Conjugate(Place),
    /// Two real poles, and the relative change of each in the last step.
    Real([f64; 2], [f64; 2]),
}

/// Maximum number of sweeps before other guesses are tried; four to seven are usual.
const MOST_SWEEPS: usize = 60;

/// Relative differences of this size are rounding errors.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Real poles are found when their relative change is below this: each further step squares it.
const SETTLED: f64 = 1e-13;

/// Real poles whose relative change is below this will stay real.
const NEARLY_SETTLED: f64 = 1e-9;

/// All poles of a system, starting from a guess of each pair; `None` if they were not found.
pub(super) fn find(system: &System, guesses: Vec<Place>) -> Option<Vec<Pair>> {
    let mut pairs: Vec<Pair> = guesses.into_iter().map(Pair::Conjugate).collect();
    let mut found = vec![false; pairs.len()];
    for _ in 0..MOST_SWEEPS {
        if found.iter().all(|found| *found) {
            return Some(pairs);
        }
        for j in 0..pairs.len() {
            if !found[j] {
                (pairs[j], found[j]) = match pairs[j] {
                    Pair::Conjugate(place) => step_conjugate(system, &pairs, j, system.nearest(place)),
                    Pair::Real(poles, _) => step_real(system, &pairs, j, poles),
                };
            }
        }
        exchange(&mut pairs, &found);
    }
    None
}

/// Two real poles that should become a conjugate pair cannot do so if they belong to different pairs, each with a pole
/// that has settled. So the two settled poles are made one pair, and the other two another.
fn exchange(pairs: &mut [Pair], found: &[bool]) {
    let mut open: Option<(usize, usize)> = None;
    for j in (0..pairs.len()).filter(|j| !found[*j]) {
        let Pair::Real(poles, moves) = pairs[j] else { continue };
        let restless = match moves.map(|moved| moved < NEARLY_SETTLED) {
            [true, false] => 1,
            [false, true] => 0,
            _ => continue,
        };
        let Some((first, its_restless)) = open.take() else {
            open = Some((j, restless));
            continue;
        };
        let Pair::Real(others, _) = pairs[first] else { continue };
        pairs[first] = Pair::Real([others[1 - its_restless], poles[1 - restless]], [1.0; 2]);
        pairs[j] = Pair::Real([others[its_restless], poles[restless]], [1.0; 2]);
    }
}

/// One step of a pole above the real axis. Returns whether it was the last.
fn step_conjugate(system: &System, pairs: &[Pair], j: usize, place: Place) -> (Pair, bool) {
    let (value, s) = (system.value(place), place.s);
    if value.h.norm() <= ROUNDING * value.size {
        return (Pair::Conjugate(place), true);
    }
    let mut slope = value.derivative * value.h.reciprocal() + value.others;
    for (k, pair) in pairs.iter().enumerate() {
        if k != j {
            let (factor, derivative) = factor(system, place, pair);
            slope = slope - derivative * factor.reciprocal();
        }
    }
    // Without the contribution of its own conjugate: 1 / (s − s̄).
    slope.im += 0.5 / s.im;
    let step = slope.reciprocal();
    if s.im - step.im > 0.25 * s.im {
        let offset = place.offset - step;
        return (
            Pair::Conjugate(system.place(place.origin, offset)),
            step.norm2() <= ROUNDING * ROUNDING * offset.norm2(),
        );
    }
    // The quadratic s² + b s + c that has the value of N divided by all other factors.
    let value = over_others(system, pairs, j, place, value.h);
    let b = value.im / s.im - 2.0 * s.re;
    let c = value.re - (s.re * s.re - s.im * s.im) - b * s.re;
    let discriminant = b * b - 4.0 * c;
    if discriminant >= 0.0 {
        return (Pair::Real(roots(b, c, discriminant), [1.0; 2]), false);
    }
    // The root nearest to s, as a difference from it.
    let slope = Complex::new(2.0 * s.re + b, 2.0 * s.im);
    let root = (slope * slope - value.scale(4.0)).sqrt();
    let (plus, minus) = (slope + root, slope - root);
    let larger = if plus.norm2() >= minus.norm2() { plus } else { minus };
    let offset = place.offset - value.scale(2.0) * larger.reciprocal();
    let near = system.place(place.origin, offset);
    (if near.s.im > 0.0 { Pair::Conjugate(near) } else { ring(system, b, discriminant) }, false)
}

/// The two conjugate roots of a quadratic.
fn ring(system: &System, b: f64, discriminant: f64) -> Pair {
    let s = Complex::new(-0.5 * b, 0.5 * (-discriminant).sqrt());
    Pair::Conjugate(system.nearest(system.place(0, s - system.pole(0))))
}

/// One step of two real poles. Returns whether it was the last.
fn step_real(system: &System, pairs: &[Pair], j: usize, poles: [f64; 2]) -> (Pair, bool) {
    let [near, mut far] = poles;
    if near == far {
        far *= 1.0 + 1e-6;
    }
    let values = [near, far].map(|s| {
        let place = on_axis(system, s);
        let value = system.value(place);
        (over_others(system, pairs, j, place, value.h).re, value.h.norm() <= ROUNDING * value.size)
    });
    let b = (values[0].0 - values[1].0) / (near - far) - (near + far);
    let c = values[0].0 - near * near - b * near;
    let discriminant = b * b - 4.0 * c;
    if discriminant < 0.0 {
        return (ring(system, b, discriminant), false);
    }
    if values[0].1 && values[1].1 {
        return (Pair::Real(poles, [0.0; 2]), true);
    }
    let to = roots(b, c, discriminant);
    // In an order in which each new pole is next to its old one.
    let to = if (poles[0] < poles[1]) == (to[0] < to[1]) { to } else { [to[1], to[0]] };
    let moves = [0, 1].map(|k| (to[k] - poles[k]).abs() / to[k].abs());
    (Pair::Real(to, moves), moves.iter().all(|moved| *moved <= SETTLED))
}

/// The two real roots of a quadratic, computed without subtracting nearly equal numbers.
fn roots(b: f64, c: f64, discriminant: f64) -> [f64; 2] {
    let root = discriminant.sqrt();
    let far = -0.5 * (b + if b < 0.0 { -root } else { root });
    [if far == 0.0 { 0.0 } else { c / far }, far]
}

/// The place of a pole on the real axis.
pub(super) fn on_axis(system: &System, s: f64) -> Place {
    let s = Complex::new(s, 0.0);
    let Place { origin, .. } = system.nearest(system.place(0, s - system.pole(0)));
    Place { origin, offset: s - system.pole(origin), s }
}

/// `(s − a)(s − b)` for a pair of poles, and its derivative.
fn factor(system: &System, place: Place, pair: &Pair) -> (Complex, Complex) {
    let (one, other) = match *pair {
        Pair::Conjugate(pole) => {
            let from = system.between(place.origin, pole.origin) + (place.offset - pole.offset);
            (from, Complex::new(from.re, from.im + 2.0 * (system.frequency[pole.origin] + pole.offset.im)))
        }
        Pair::Real(poles, _) => {
            let s = place.s;
            (Complex::new(s.re - poles[0], s.im), Complex::new(s.re - poles[1], s.im))
        }
    };
    // If two guesses coincide, any value that moves them apart will do.
    let product = one * other;
    if product.norm2() == 0.0 { (Complex::new(1.0, 0.0), Complex::ZERO) } else { (product, one + other) }
}

/// `N` divided by the factors of all other pairs, computed from `H`.
fn over_others(system: &System, pairs: &[Pair], j: usize, place: Place, h: Complex) -> Complex {
    let mut product = h.scale(1.0 / system.leading());
    for k in 0..system.len() {
        if k != place.origin {
            product = product * system.q(place, k).0;
        }
        if let Some(pair) = pairs.get(k).filter(|_| k != j) {
            product = product * factor(system, place, pair).0.reciprocal();
        }
    }
    product
}
