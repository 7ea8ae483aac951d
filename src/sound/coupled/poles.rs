//! The poles of two joined bodies, all at once, by Aberth's iteration on the secular equation.
//!
//! Aberth (1973) improves a guess of each zero of a polynomial `N` by `1/(N′/N − Σ 1/(s − s_k))`, the sum over the guesses
//! of all others: cubically, and without finding a zero twice. Bini & Robol (2014) apply it to secular equations. Here
//! `N = F Π q_k` is real, so each guess stands for its conjugate too. Poles that are real come in pairs as well; near the
//! real axis a whole quadratic factor is improved at once, after Durand (1960) and Kerner (1966).

use super::complex::Complex;
use super::system::{Place, System};

/// Two poles.
#[derive(Clone, Copy, Debug)]
pub(super) enum Pair {
    /// A pole above the real axis, and its conjugate.
    Ringing(Place),
    /// Two real poles, the smaller first.
    Creeping([f64; 2]),
}

/// Sweeps after which poles that still move are taken as they are. A few are enough unless poles almost coincide.
const MOST_SWEEPS: usize = 100;

/// Differences of this size are rounding errors.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// All poles of a system, and in how many sweeps they were found; `None` if they were not.
pub(super) fn find(system: &System, guesses: Vec<Place>) -> Option<(Vec<Pair>, usize)> {
    let mut pairs: Vec<Pair> = guesses.into_iter().map(Pair::Ringing).collect();
    let mut found = vec![false; pairs.len()];
    for sweep in 0..MOST_SWEEPS {
        if found.iter().all(|found| *found) {
            return Some((pairs, sweep));
        }
        for j in 0..pairs.len() {
            if !found[j] {
                (pairs[j], found[j]) = match pairs[j] {
                    Pair::Ringing(place) => ringing(system, &pairs, j, system.nearest(place)),
                    Pair::Creeping(poles) => creeping(system, &pairs, j, poles),
                };
            }
        }
    }
    None
}

/// One step of a pole above the real axis, and whether it was the last.
fn ringing(system: &System, pairs: &[Pair], j: usize, place: Place) -> (Pair, bool) {
    let (value, s) = (system.value(place), system.at(place));
    if value.h.norm() <= ROUNDING * value.size {
        return (Pair::Ringing(place), true);
    }
    let mut slope = value.derivative * value.h.reciprocal() + value.others;
    for (k, pair) in pairs.iter().enumerate() {
        if k != j {
            let (factor, derivative) = factor(system, place, pair);
            slope = slope - derivative * factor.reciprocal();
        }
    }
    // Less its own conjugate: 1 / (s − s̄).
    slope.im += 0.5 / s.im;
    let step = slope.reciprocal();
    if s.im - step.im > 0.25 * s.im {
        let offset = place.offset - step;
        return (Pair::Ringing(Place { offset, ..place }), step.norm2() <= ROUNDING * ROUNDING * offset.norm2());
    }
    if system.law.rigid || system.law.damping == 0.0 {
        // No pole is real.
        return (lowered(place, 0.5 * s.im), false);
    }
    // The quadratic s² + b s + c that has the value of N over all other factors.
    let value = over_others(system, pairs, j, place, value.h);
    let b = value.im / s.im - 2.0 * s.re;
    let c = value.re - (s.re * s.re - s.im * s.im) - b * s.re;
    let discriminant = b * b - 4.0 * c;
    if discriminant >= 0.0 {
        return (creep(b, c, discriminant), false);
    }
    // The root nearest to s, as a difference from it.
    let slope = Complex::new(2.0 * s.re + b, 2.0 * s.im);
    let root = (slope * slope - value.scale(4.0)).sqrt();
    let (plus, minus) = (slope + root, slope - root);
    let larger = if plus.norm2() >= minus.norm2() { plus } else { minus };
    let offset = place.offset - value.scale(2.0) * larger.reciprocal();
    if system.pole(place.origin).im + offset.im > 0.0 {
        return (Pair::Ringing(Place { offset, ..place }), false);
    }
    (lowered(place, 0.5 * s.im), false)
}

/// The pole moved towards the real axis.
fn lowered(place: Place, by: f64) -> Pair {
    Pair::Ringing(Place { offset: Complex::new(place.offset.re, place.offset.im - by), ..place })
}

/// One step of two real poles, and whether it was the last.
fn creeping(system: &System, pairs: &[Pair], j: usize, poles: [f64; 2]) -> (Pair, bool) {
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
        let s = Complex::new(-0.5 * b, 0.5 * (-discriminant).sqrt());
        let place = Place { origin: 0, offset: s - system.pole(0) };
        return (Pair::Ringing(system.nearest(place)), false);
    }
    if values[0].1 && values[1].1 {
        return (Pair::Creeping(poles), true);
    }
    let moved = creep(b, c, discriminant);
    let last = match moved {
        Pair::Creeping(to) => (0..2).all(|k| (to[k] - poles[k]).abs() <= ROUNDING * to[k].abs()),
        Pair::Ringing(_) => false,
    };
    (moved, last)
}

/// The two real roots of a quadratic, neither by a difference of nearly equal numbers.
fn creep(b: f64, c: f64, discriminant: f64) -> Pair {
    let root = discriminant.sqrt();
    let far = -0.5 * (b + if b < 0.0 { -root } else { root });
    Pair::Creeping([if far == 0.0 { 0.0 } else { c / far }, far])
}

/// The place of a real pole.
pub(super) fn on_axis(system: &System, s: f64) -> Place {
    let place = Place { origin: 0, offset: Complex::new(s, 0.0) - system.pole(0) };
    // Exactly on the axis, whichever pole it is told from.
    let mut place = system.nearest(place);
    place.offset = Complex::new(s + system.rate[place.origin], -system.frequency[place.origin]);
    place
}

/// `(s − a)(s − b)` of a pair of poles, and its derivative.
fn factor(system: &System, place: Place, pair: &Pair) -> (Complex, Complex) {
    let (one, other) = match *pair {
        Pair::Ringing(pole) => {
            let from = system.between(place.origin, pole.origin) + (place.offset - pole.offset);
            (from, Complex::new(from.re, from.im + 2.0 * (system.frequency[pole.origin] + pole.offset.im)))
        }
        Pair::Creeping(poles) => {
            let s = system.at(place);
            (Complex::new(s.re - poles[0], s.im), Complex::new(s.re - poles[1], s.im))
        }
    };
    // Two guesses in one place: any push apart will do.
    let product = one * other;
    if product.norm2() == 0.0 { (Complex::new(1.0, 0.0), Complex::ZERO) } else { (product, one + other) }
}

/// `N` over the factors of all other pairs, from `H`.
fn over_others(system: &System, pairs: &[Pair], j: usize, place: Place, h: Complex) -> Complex {
    let mut product = h;
    for (k, pair) in pairs.iter().enumerate() {
        if k != place.origin {
            product = product * system.q(place, k).0;
        }
        if k != j {
            product = product * factor(system, place, pair).0.reciprocal();
        }
    }
    product
}
