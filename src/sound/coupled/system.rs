//! Two bodies and their joint as a rank-one change of a diagonal system, and its secular equation.
//!
//! Let `q_k(s) = (s − p_k)(s − p̄_k)` for each mode of both bodies, and `c_k` its shape at the joint, negative for the
//! second body. Then the joined bodies obey `(diag q_k(s) + β(s) c cᵀ) x = force`. So their poles are the zeros of
//! `F(s) = α + β(s) Σ c_k² / q_k(s)`, where `α = 1` and `β = K + R s`, or `α = 0` and `β = 1` for a rigid joint.

use super::complex::Complex;
use super::mode::{BodyMode, CoupledMode};

/// The law of the joint in the form that the equation needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coupling {
    pub(super) rigid: bool,
    pub(super) stiffness: f64,
    pub(super) damping: f64,
}

impl Coupling {
    /// The joint with stiffness and damping multiplied by `by`.
    pub(super) fn scaled(self, by: f64) -> Self {
        Self { stiffness: self.stiffness * by, damping: self.damping * by, ..self }
    }

    fn alpha(&self) -> f64 {
        if self.rigid { 0.0 } else { 1.0 }
    }

    /// `β(s)` and `β′`.
    fn beta(&self, s: Complex) -> (Complex, f64) {
        if self.rigid {
            return (Complex::new(1.0, 0.0), 0.0);
        }
        (s.scale(self.damping) + Complex::new(self.stiffness, 0.0), self.damping)
    }
}

/// A place in the complex plane, stored relative to the pole of a nearby mode. So its difference from any pole is known
/// to nearly all digits, even if the two are very close (Gu & Eisenstat 1994 do so on the real line).
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) origin: usize,
    /// Difference from the pole of mode `origin`.
    pub(super) offset: Complex,
    /// Absolute value `s`.
    pub(super) s: Complex,
}

/// The modes that act on each other, in the order of their undamped frequencies.
#[derive(Debug)]
pub(super) struct System {
    pub(super) coupling: Coupling,
    pub(super) frequency: Vec<f64>,
    pub(super) rate: Vec<f64>,
    pub(super) joint: Vec<f64>,
    /// Squares of [`Self::joint`].
    pub(super) weight: Vec<f64>,
    strike: Vec<[f64; 2]>,
    pickup: Vec<[f64; 2]>,
}

/// The secular equation at a [`Place`], multiplied by the `q` of its origin, so that it stays finite there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Value {
    /// `H = F q` and its derivative.
    pub(super) h: Complex,
    pub(super) derivative: Complex,
    /// The sum of the magnitudes of the terms of `H`. The rounding error of `H` is a few units in the last place of
    /// this sum.
    pub(super) size: f64,
    /// `Σ q_k′/q_k` over all modes except the origin.
    pub(super) others: Complex,
}

#[derive(Clone, Copy, Debug)]
struct Loose {
    frequency: f64,
    rate: f64,
    joint: f64,
    strike: [f64; 2],
    pickup: [f64; 2],
}

/// A shape at the joint has no effect if it is smaller than this fraction of the largest one. The same applies if the
/// joint's pull is this weak compared with a mode's own stiffness. The square of such a number is far below the last digit
/// of the closest two frequencies.
const NEGLIGIBLE: f64 = 1e-36;

impl System {
    /// Joins two bodies. Also returns the modes on which the joint has no effect.
    pub(super) fn new(first: &[BodyMode], second: &[BodyMode], coupling: Coupling) -> (Self, Vec<CoupledMode>) {
        let one = first.iter().map(|mode| Loose {
            frequency: mode.angular_frequency,
            rate: mode.decay_rate,
            joint: mode.joint,
            strike: [mode.strike, 0.0],
            pickup: [mode.pickup, 0.0],
        });
        let other = second.iter().map(|mode| Loose {
            frequency: mode.angular_frequency,
            rate: mode.decay_rate,
            joint: -mode.joint,
            strike: [0.0, mode.strike],
            pickup: [0.0, mode.pickup],
        });
        let mut modes: Vec<Loose> = one.chain(other).collect();
        modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency).then(a.rate.total_cmp(&b.rate)));
        deflate(&mut modes);
        let largest = modes.iter().fold(0.0, |largest: f64, mode| largest.max(mode.joint.abs()));
        let is_still = |mode: &Loose| {
            let pole = Complex::new(-mode.rate, mode.frequency);
            let pull =
                if coupling.rigid { f64::MAX } else { coupling.beta(pole).0.norm() * mode.joint.abs() * largest };
            mode.joint.abs() <= NEGLIGIBLE * largest || pull <= NEGLIGIBLE * pole.norm2()
        };
        let (still, mut moved): (Vec<Loose>, Vec<Loose>) = modes.into_iter().partition(is_still);
        let undamped = |mode: &Loose| mode.frequency * mode.frequency + mode.rate * mode.rate;
        moved.sort_by(|a, b| undamped(a).total_cmp(&undamped(b)));
        let free = |mode: Loose| CoupledMode::free(mode.frequency, mode.rate, mode.strike, mode.pickup);
        let system = Self {
            coupling,
            frequency: moved.iter().map(|mode| mode.frequency).collect(),
            rate: moved.iter().map(|mode| mode.rate).collect(),
            joint: moved.iter().map(|mode| mode.joint).collect(),
            weight: moved.iter().map(|mode| mode.joint * mode.joint).collect(),
            strike: moved.iter().map(|mode| mode.strike).collect(),
            pickup: moved.iter().map(|mode| mode.pickup).collect(),
        };
        (system, still.into_iter().map(free).collect())
    }

    /// Number of modes.
    pub(super) fn len(&self) -> usize {
        self.frequency.len()
    }

    /// The pole of mode `k`.
    pub(super) fn pole(&self, k: usize) -> Complex {
        Complex::new(-self.rate[k], self.frequency[k])
    }

    /// `p_j − p_k`, exact except for one rounding of each part.
    pub(super) fn between(&self, j: usize, k: usize) -> Complex {
        Complex::new(self.rate[k] - self.rate[j], self.frequency[j] - self.frequency[k])
    }

    /// The place at this offset from a pole.
    pub(super) fn place(&self, origin: usize, offset: Complex) -> Place {
        Place { origin, offset, s: self.pole(origin) + offset }
    }

    /// `s − p_k`.
    fn from(&self, place: Place, k: usize) -> Complex {
        self.between(place.origin, k) + place.offset
    }

    /// The leading coefficient of `F Π q_k`.
    pub(super) fn leading(&self) -> f64 {
        if self.coupling.rigid { self.weight.iter().sum() } else { 1.0 }
    }

    /// The same place, relative to the nearest pole.
    pub(super) fn nearest(&self, place: Place) -> Place {
        let mut best = place;
        let mut least = place.offset.norm2();
        for k in 0..self.len() {
            let offset = self.from(place, k);
            let distance = offset.norm2();
            if distance < least {
                (best, least) = (Place { origin: k, offset, ..place }, distance);
            }
        }
        best
    }

    /// `q_k` and `q_k′` at a place.
    pub(super) fn q(&self, place: Place, k: usize) -> (Complex, Complex) {
        let from = self.from(place, k);
        let conjugate = Complex::new(from.re, from.im + 2.0 * self.frequency[k]);
        (from * conjugate, from + conjugate)
    }

    /// The secular equation at a place.
    pub(super) fn value(&self, place: Place) -> Value {
        let (mut sum, mut slope, mut others, mut size) = (Complex::ZERO, Complex::ZERO, Complex::ZERO, 0.0);
        for k in (0..place.origin).chain(place.origin + 1..self.len()) {
            let (q, derivative) = self.q(place, k);
            let inverse = q.reciprocal();
            let ratio = derivative * inverse;
            let term = inverse.scale(self.weight[k]);
            sum = sum + term;
            slope = slope - term * ratio;
            others = others + ratio;
            size += term.re.abs() + term.im.abs();
        }
        let (q, derivative) = self.q(place, place.origin);
        let (beta, beta_slope) = self.coupling.beta(place.s);
        let (alpha, weight) = (self.coupling.alpha(), self.weight[place.origin]);
        let pull = q * beta;
        let pull_slope = derivative * beta + q.scale(beta_slope);
        Value {
            h: q.scale(alpha) + beta.scale(weight) + pull * sum,
            derivative: derivative.scale(alpha)
                + Complex::new(beta_slope * weight, 0.0)
                + pull_slope * sum
                + pull * slope,
            size: alpha * q.norm() + weight * beta.norm() + size * pull.norm(),
            others,
        }
    }

    /// The mode of a found pole. `rings` is false for a real pole.
    pub(super) fn mode(&self, place: Place, rings: bool, rate: f64) -> CoupledMode {
        let (q, _) = self.q(place, place.origin);
        // Σ shape · c_k / q_k, times the origin's q.
        let origin = place.origin;
        let mut strike = self.strike[origin].map(|shape| Complex::new(shape * self.joint[origin], 0.0));
        let mut pickup = self.pickup[origin].map(|shape| Complex::new(shape * self.joint[origin], 0.0));
        for k in (0..origin).chain(origin + 1..self.len()) {
            let inverse = (q * self.q(place, k).0.reciprocal()).scale(self.joint[k]);
            for body in 0..2 {
                strike[body] = strike[body] + inverse.scale(self.strike[k][body]);
                pickup[body] = pickup[body] + inverse.scale(self.pickup[k][body]);
            }
        }
        let twice = if rings { -2.0 } else { -1.0 };
        let scale = (self.coupling.beta(place.s).0 * (q * self.value(place).derivative).reciprocal()).scale(twice);
        let frequency = if rings { place.s.im } else { 0.0 };
        let pickup = pickup.map(|shape| shape * scale);
        CoupledMode { angular_frequency: frequency, decay_rate: rate, strike, pickup }
    }
}

/// Rotates modes that have the same pole until the joint moves only one of them (Bunch, Nielsen & Sorensen, "Rank-one
/// modification of the symmetric eigenproblem", Numer. Math. 31, 1978).
fn deflate(modes: &mut [Loose]) {
    for k in 1..modes.len() {
        let (one, other) = (modes[k - 1], modes[k]);
        if (one.frequency, one.rate) != (other.frequency, other.rate) {
            continue;
        }
        let joint = (one.joint * one.joint + other.joint * other.joint).sqrt();
        if joint > 0.0 {
            let (sin, cos) = (one.joint / joint, other.joint / joint);
            let moved = |a: [f64; 2], b: [f64; 2]| [sin * a[0] + cos * b[0], sin * a[1] + cos * b[1]];
            let still = |a: [f64; 2], b: [f64; 2]| [cos * a[0] - sin * b[0], cos * a[1] - sin * b[1]];
            let (strike, pickup) = ((one.strike, other.strike), (one.pickup, other.pickup));
            modes[k - 1] =
                Loose { joint: 0.0, strike: still(strike.0, strike.1), pickup: still(pickup.0, pickup.1), ..one };
            modes[k] = Loose { joint, strike: moved(strike.0, strike.1), pickup: moved(pickup.0, pickup.1), ..other };
        }
    }
}
