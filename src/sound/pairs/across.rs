//! The modes of a string in the direction across the strike, on which the joint has only a weak effect.
//!
//! A string moves in two directions. A bridge yields to one of them much more than to the other, so the sound of the
//! first decays fast, and the second remains audible (Weinreich, "Coupled piano strings", J. Acoust. Soc. Am. 62, 1977). The
//! joint does not change the pitch of the second, so it is in tune. Its loss to the joint, and the motion of the other body,
//! are computed to first order in the square of its share of the joint.

use super::response;
use crate::sound::coupled::{BodyMode, Complex, CoupledMode, Joint};

/// The modes of `body`, free, at the pitch of the note, in the direction across. `share` is this direction's share of the
/// strike and of the shapes at the joint.
pub(super) fn modes(body: &[BodyMode], other: &[BodyMode], joint: Joint, share: f64) -> Vec<CoupledMode> {
    let one = |(place, mode): (usize, &BodyMode)| {
        let (omega, c) = (mode.angular_frequency, share * mode.joint);
        let s = Complex { re: -mode.decay_rate, im: omega };
        let others = body.iter().enumerate().filter(|(m, _)| *m != place).map(|(_, mode)| mode).chain(other);
        let stiffness = response::stiffness(joint, others, s);
        // (s + σ)² + ω² = −c² K has a root at −σ + iω + i c² K/(2ω).
        let loss = c * c * stiffness.im / (2.0 * omega);
        let moved = stiffness * response::sum(other.iter(), s, |mode| mode.joint * mode.pickup);
        // A displacement after an impulse is sin(ωt)/ω, which is the real part of −i e^(iωt)/ω.
        let scaled = |z: Complex, by: f64| Complex { re: z.im * by, im: -z.re * by };
        let pickup = [Complex { re: mode.pickup, im: 0.0 }, Complex { re: c * moved.re, im: c * moved.im }];
        CoupledMode {
            angular_frequency: omega,
            decay_rate: mode.decay_rate + loss.max(0.0),
            strike: [Complex { re: share * mode.strike, im: 0.0 }, Complex::default()],
            pickup: pickup.map(|shape| scaled(shape, 1.0 / omega)),
        }
    };
    body.iter().enumerate().map(one).collect()
}
