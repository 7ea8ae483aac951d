//! The effective stiffness of a joint for one mode, with the motion of all other modes of both bodies.
//!
//! A joined mode is a root of `α + β(s) Σ c_k²/q_k(s)`, with `q_k(s) = (s + σ_k)² + ω_k²` and the shapes `c_k` at the joint.
//! Solved for one mode, this gives `q = −c² β/(α + β S)`, where `S` is the sum over all other modes. So `β/(α + β S)` is the
//! effective stiffness of the joint for this mode.

use crate::sound::coupled::{BodyMode, Complex, Joint};

/// The effective stiffness in N/m of the joint for one mode of a body, at a place `s`. `others` are all other modes of both
/// bodies.
pub(super) fn stiffness<'a>(joint: Joint, others: impl Iterator<Item = &'a BodyMode>, s: Complex) -> Complex {
    let sum = sum(others, s, |mode| mode.joint * mode.joint);
    let (alpha, beta) = match joint {
        Joint::Rigid => (0.0, Complex { re: 1.0, im: 0.0 }),
        Joint::Spring { stiffness, damping } => (1.0, Complex { re: stiffness + damping * s.re, im: damping * s.im }),
    };
    over(beta, Complex { re: alpha, im: 0.0 } + beta * sum)
}

/// `Σ shape/q_k(s)` of some modes.
pub(super) fn sum<'a>(
    modes: impl Iterator<Item = &'a BodyMode>,
    s: Complex,
    shape: impl Fn(&BodyMode) -> f64,
) -> Complex {
    let term = |mode: &BodyMode| {
        let (x, omega) = (s.re + mode.decay_rate, mode.angular_frequency);
        let q = Complex { re: x * x - s.im * s.im + omega * omega, im: 2.0 * x * s.im };
        over(Complex { re: shape(mode), im: 0.0 }, q)
    };
    modes.map(term).fold(Complex::default(), |sum, term| sum + term)
}

fn over(a: Complex, b: Complex) -> Complex {
    let scale = 1.0 / (b.re * b.re + b.im * b.im);
    a * Complex { re: b.re * scale, im: -b.im * scale }
}
