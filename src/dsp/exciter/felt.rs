//! A felt or another soft surface: the force between two bodies that touch.

use libm::sqrt;

/// Over `2.69` times the deepest dent over the speed, a mass touches a wall: twice the integral of `1/√(1 − s^3.5)` from 0 to 1.
const AT_A_WALL: f64 = 2.69;

/// What the surface takes: its force is greater by this share while it is compressed at full speed, and smaller by as much while it
/// lets go (Hunt and Crossley, "Coefficient of restitution interpreted as damping in vibroimpact", J. Appl. Mech. 42, 1975).
const LOSS: f64 = 0.2;

/// Limits of stiffness and loss in a frame, as multiples of what stops the bodies: with more, the modes' single precision could
/// add energy.
const STIFFEST: f64 = 2e4;
const MOST_LOSS: f64 = 1e4;

/// Change of the dent as a share of it, below which the mean force is computed at the middle.
const SMALL: f64 = 1e-3;

/// The force `K ξ^2.5` of a dent `ξ`, as measured on the hammers of pianos (Chaigne and Askenfelt, "Numerical simulations of piano
/// strings" I and II, JASA 95, 1994). Real-time safe.
///
/// It is constant within a frame, and what touches flies exactly over the frame under it. So all of them together gain at most
/// `−f Δξ`, and with a force whose work is the change of the surface's energy nothing is ever gained. That energy, `ψ²/2`, is a
/// state of its own: `f = g (ψ₀ + ψ₁)/2` and `ψ₁ = ψ₀ + g Δξ` for a slope `g` make one linear equation, and no `g` breaks the
/// balance (Ducceschi and Bilbao, "Simulation of the geometrically exact nonlinear string via energy quadratisation", JSV 534,
/// 2022, with a secant of `ψ` here). `ψ` is brought back to the dent's own energy whenever it is above.
#[derive(Clone, Copy, Debug)]
pub(super) struct Felt {
    /// `ψ` at a dent of 1.
    scale: f64,
    pub(super) loss: f64,
    /// How far a force of 1 in a frame brings the two bodies apart until its end.
    compliance: f64,
    dent: f64,
    pub(super) psi: f64,
    pub(super) force: f64,
}

impl Felt {
    /// No surface.
    pub(super) const NONE: Self = Self { scale: 0.0, loss: 0.0, compliance: 0.0, dent: 0.0, psi: 0.0, force: 0.0 };

    /// A surface that throws a `mass` of this `speed` back from a wall within `contact` frames, between bodies that give way by
    /// `compliance` together.
    pub(super) fn new(mass: f64, speed: f64, contact: f64, compliance: f64) -> Self {
        let deepest = contact.max(1.0) * speed / AT_A_WALL;
        Self { scale: sqrt(mass) * speed / power(deepest), loss: LOSS / speed, compliance, ..Self::NONE }
    }

    /// Dents the surface, or, below 0, leaves a gap.
    pub(super) fn set(&mut self, dent: f64) {
        (self.dent, self.psi) = (dent, self.psi_at(dent));
        self.force = self.mean_force(dent, dent)[0];
    }

    /// The dent, or, below 0, the gap.
    #[cfg(test)]
    pub(super) fn dent(&self) -> f64 {
        self.dent
    }

    /// The dent under a steady force.
    pub(super) fn dent_under(&self, force: f64) -> f64 {
        libm::pow(force / (1.75 * self.scale * self.scale), 0.4)
    }

    /// Goes on by a frame at whose end the dent would be `free` without a force. Returns whether anything touches.
    pub(super) fn follow(&mut self, free: f64) -> bool {
        if self.dent <= 0.0 && free <= 0.0 {
            (self.force, self.psi, self.dent) = (0.0, 0.0, free);
            return false;
        }
        self.touch(free);
        true
    }

    /// Finds the force under which the dent goes to where it would be at `free` without.
    fn touch(&mut self, free: f64) {
        let (before, compliance) = (self.dent, self.compliance);
        // The last force tells where the dent will be, and one step of Newton's method makes that better.
        let mut ahead = free - compliance * self.force;
        let [mean, slope] = self.mean_force(before, ahead);
        ahead -= (ahead - free + compliance * mean) / (1.0 + compliance * slope);
        let moved = ahead - before;
        let steep = if moved * moved > 1e-24 * ahead * ahead {
            (self.psi_at(ahead) - self.psi) / moved
        } else {
            1.75 * self.psi_at(ahead) / ahead
        };
        let mut steep = steep.max(0.0).min(sqrt(STIFFEST / compliance));
        let lost = (self.loss * self.mean_force(before, ahead)[0]).min(MOST_LOSS / compliance);
        let stiff = 0.5 * steep * steep + lost;
        let force = (steep * self.psi + stiff * (free - before)) / (1.0 + compliance * stiff);
        if force < 0.0 {
            steep = 0.0;
        }
        self.force = force.max(0.0);
        self.dent = free - compliance * self.force;
        let psi = self.psi + steep * (self.dent - before);
        self.psi = psi.abs().min(self.psi_at(self.dent));
    }

    fn psi_at(&self, dent: f64) -> f64 {
        self.scale * power(dent.max(0.0))
    }

    /// The change of the felt's energy between two dents over their difference, and its slope by the second of them.
    fn mean_force(&self, from: f64, to: f64) -> [f64; 2] {
        // K of K ξ^2.5, from ψ² = 2 K ξ^3.5 / 3.5.
        let stiffness = 1.75 * self.scale * self.scale;
        let force = |dent: f64| stiffness * dent * dent * sqrt(dent);
        let (moved, middle) = (to - from, 0.5 * (from + to));
        if from <= 0.0 && to <= 0.0 {
            return [0.0; 2];
        }
        if from > 0.0 && to > 0.0 && moved.abs() < SMALL * middle {
            let (share, middle_force) = (moved / middle, force(middle));
            return [middle_force * (1.0 + 2.5 * 1.5 / 24.0 * share * share), 1.25 * middle_force / middle];
        }
        let [at_from, at_to] = [from, to].map(|dent| dent.max(0.0));
        let mean = (force(at_to) * at_to - force(at_from) * at_from) / (3.5 * moved);
        [mean, (force(at_to) - mean) / moved]
    }
}

/// `ξ^1.75`.
fn power(dent: f64) -> f64 {
    let root = sqrt(dent);
    dent * root * sqrt(root)
}
