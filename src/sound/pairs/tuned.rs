//! The tuning of a body that gives it a certain pitch once it is joined to another one.
//!
//! A joint changes the pitch of a body, by its stiffness and by the motion of the other body. A player tunes a string on
//! the instrument, so its pitch is right when it is joined.
//!
//! Let the frequencies of all modes of the body be multiplied by `a`. The mode that sets the pitch must be at `s = −σ + iω`,
//! with the wanted `ω`. There, `(s + σ_k)² + a² ω_k² = −c² K`, with the stiffness `K` of the joint for the mode
//! ([`super::response`]). The imaginary part gives `σ` and the real part `a`. Both are iterated, because `K` depends on them
//! a little.

use super::response;
use crate::sound::coupled::{BodyMode, Complex, Joint};

/// Maximum number of steps, and the change of `a` at which the iteration ends: 1e−6 cents.
const STEPS: usize = 80;
const ENOUGH: f64 = 5e-10;

/// The largest tuning: two semitones.
const MOST: f64 = 1.12;

/// The factor `a` of all frequencies of `body` with which its mode nearest to the angular frequency `wanted` has exactly
/// this frequency once it is joined.
///
/// If the other body has a mode at nearly the same frequency, there may be no such factor, because the two modes repel each
/// other (the wolf note of a cello). Then the body is tuned as if the other body did not move. If the body
/// has no mode near the wanted frequency, the factor is 1.
pub(super) fn factor(body: &[BodyMode], other: &[BodyMode], joint: Joint, wanted: f64) -> f64 {
    find(body, other, joint, wanted).or_else(|| find(body, &[], joint, wanted)).unwrap_or(1.0)
}

fn find(body: &[BodyMode], other: &[BodyMode], joint: Joint, wanted: f64) -> Option<f64> {
    let near = |mode: &BodyMode| (mode.angular_frequency / wanted).max(wanted / mode.angular_frequency);
    let pitch = (0..body.len()).min_by(|m, n| near(&body[*m]).total_cmp(&near(&body[*n])))?;
    let mode = Some(body[pitch]).filter(|mode| near(mode) < MOST)?;
    let own = mode.angular_frequency;
    let (mut a, mut rate) = (1.0, mode.decay_rate);
    for _ in 0..STEPS {
        let s = Complex { re: -rate, im: wanted };
        let tuned: Vec<BodyMode> =
            body.iter().map(|mode| BodyMode { angular_frequency: a * mode.angular_frequency, ..*mode }).collect();
        let others = tuned.iter().enumerate().filter(|(m, _)| *m != pitch).map(|(_, mode)| mode).chain(other);
        let stiffness = response::stiffness(joint, others, s);
        let weight = -mode.joint * mode.joint;
        let q = Complex { re: weight * stiffness.re, im: weight * stiffness.im };
        // q = d² − ω² + 2iωd + a² own², with d = σ_k − σ.
        let d = q.im / (2.0 * wanted);
        let square = (q.re + wanted * wanted - d * d) / (own * own);
        if !(1.0 / (MOST * MOST)..=MOST * MOST).contains(&square) {
            return None;
        }
        // Half steps: if the other body has a mode at the same pitch, whole steps may oscillate.
        let step = 0.5 * (square.sqrt() - a);
        (a, rate) = (a + step, rate + 0.5 * (mode.decay_rate - d - rate));
        if step.abs() < ENOUGH {
            return Some(a);
        }
    }
    None
}
