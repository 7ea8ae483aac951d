//! The modes of a string in the direction across the strike, which the joint pulls only weakly.
//!
//! A string moves in two directions. A bridge gives way to one of them much more than to the other, so the sound of the
//! first decays fast, and what is left is the sound of the second (Weinreich, "Coupled piano strings", J. Acoust. Soc.
//! Am. 62, 1977). The second is in tune: its pitch is not moved by the joint. To first order in the square of its share
//! of the joint, it loses what the joint takes from it, and moves the other body.

use super::response;
use crate::sound::coupled::{BodyMode, Complex, CoupledMode, Joint};

/// The modes of `body`, free, at the pitch of the note, in the direction across. `share` is the share of the strike and
/// of the shapes at the joint that this direction has.
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
