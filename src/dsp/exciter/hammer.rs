//! A hammer: a mass with a felt, which the body that it strikes pushes back.

use libm::sqrt;

/// Over `2.69` times the deepest dent over the speed, a mass with this felt touches a wall: twice the integral of
/// `1/√(1 − s^3.5)` from 0 to 1.
const AT_A_WALL: f64 = 2.69;

/// What the felt takes: its force is greater by this share while it is compressed at full speed, and smaller by as much while it
/// lets go (Hunt and Crossley, "Coefficient of restitution interpreted as damping in vibroimpact", J. Appl. Mech. 42, 1975).
const LOSS: f64 = 0.2;

/// Limits of the felt's stiffness and loss in a frame, as multiples of what stops the body and the hammer together: with more,
/// the modes' single precision could add energy.
const STIFFEST: f64 = 2e4;
const MOST_LOSS: f64 = 1e4;

/// The most that a hammer gives, as a multiple of its momentum. On a body at rest it gives at most twice that, when it comes back
/// as fast as it came; a body that rings may throw it further. Then it is gone, with the energy that its felt holds.
pub(crate) const MOST_GIVEN: f64 = 3.0;

/// Change of the dent as a share of it, below which the felt's mean force is computed at the middle.
const SMALL: f64 = 1e-3;

/// A hammer before its strike. Times are in frames.
#[derive(Clone, Copy, Debug)]
pub struct HammerLaw {
    /// Mass; the body's displacements and forces are in the same units.
    pub mass: f64,
    /// Its speed.
    pub speed: f64,
    /// The speed of a full strike.
    pub full_speed: f64,
    /// Contact time at a wall, at full speed.
    pub contact: f64,
    /// How far a force of 1 in a frame moves the body at the point of the strike until the frame's end.
    pub compliance: f64,
    /// The same for modes that are too high to be rendered, which follow a force at once.
    pub stillness: f64,
    /// The hammer is caught after this many frames.
    pub longest: u32,
}

impl HammerLaw {
    /// A hammer that does not move.
    pub const NONE: Self =
        Self { mass: 1.0, speed: 0.0, full_speed: 0.0, contact: 1.0, compliance: 0.0, stillness: 0.0, longest: 0 };
}

/// A hammer in flight: it touches the body, comes off, may be touched again, and is gone when it has been off for longer than
/// it touched. Real-time safe.
///
/// The force of the felt is `K ξ^2.5` for a dent `ξ`, as measured on pianos (Chaigne and Askenfelt, "Numerical simulations of
/// piano strings" I and II, JASA 95, 1994). It is constant within a frame, and modes and hammer fly exactly over the frame under
/// it. So all of them together gain at most `−f Δξ`, and with a force whose work is the change of the felt's energy nothing is
/// ever gained. The felt's energy `ψ²/2` is a state of its own: `f = g (ψ₀ + ψ₁)/2` and `ψ₁ = ψ₀ + g Δξ` for a slope `g` make one
/// linear equation, and no `g` breaks the balance (Ducceschi and Bilbao, "Simulation of the geometrically exact nonlinear string
/// via energy quadratisation", JSV 534, 2022, with a secant of `ψ` here). `ψ` is brought back to the dent's own energy whenever it
/// is above.
#[derive(Clone, Copy, Debug)]
pub struct Hammer {
    law: HammerLaw,
    /// `ψ` at a dent of 1.
    scale: f64,
    loss: f64,
    /// Compliance of body and hammer together.
    compliance: f64,
    place: Option<f64>,
    speed: f64,
    dent: f64,
    psi: f64,
    force: f64,
    /// What is left of the most that it may give.
    impulse: f64,
    frames_left: u32,
    touched: u32,
    apart: u32,
}

impl Hammer {
    /// No hammer.
    pub const AWAY: Self = Self {
        law: HammerLaw::NONE,
        scale: 0.0,
        loss: 0.0,
        compliance: 0.0,
        place: None,
        speed: 0.0,
        dent: 0.0,
        psi: 0.0,
        force: 0.0,
        impulse: 0.0,
        frames_left: 0,
        touched: 0,
        apart: 0,
    };

    /// A hammer that is about to touch the body. Without speed there is none.
    pub fn new(law: HammerLaw) -> Self {
        if !(law.speed > 0.0 && law.full_speed > 0.0) {
            return Self::AWAY;
        }
        let deepest = law.contact.max(1.0) * law.full_speed / AT_A_WALL;
        Self {
            law,
            scale: sqrt(law.mass) * law.full_speed / power(deepest),
            loss: LOSS / law.full_speed,
            compliance: law.compliance + law.stillness + 0.5 / law.mass,
            speed: law.speed,
            impulse: MOST_GIVEN * law.mass * law.speed,
            frames_left: law.longest,
            ..Self::AWAY
        }
    }

    /// Whether the hammer touches the body, or may again.
    pub(crate) fn is_there(&self) -> bool {
        self.frames_left > 0
    }

    /// Frames until the hammer is gone, at most.
    pub(crate) fn frames_left(&self) -> u32 {
        self.frames_left
    }

    /// Energy of the hammer and its felt.
    #[cfg(test)]
    pub(crate) fn energy(&self) -> f64 {
        let held = self.law.stillness * self.force * self.force;
        0.5 * (self.law.mass * self.speed * self.speed + self.psi * self.psi + held)
    }

    /// Makes the felt give back all that it takes.
    #[cfg(test)]
    pub(crate) fn take_loss(&mut self) {
        self.loss = 0.0;
    }

    /// The force in the frame that has just passed, at whose end the point would be at `point` without it.
    pub(crate) fn force_on(&mut self, point: f32) -> f32 {
        let point = f64::from(point);
        if !self.is_there() {
            return 0.0;
        }
        self.frames_left -= 1;
        let Some(place) = self.place else {
            self.place = Some(point);
            return 0.0;
        };
        let (before, free) = (self.dent, place + self.speed - point);
        if before <= 0.0 && free <= 0.0 {
            (self.force, self.psi, self.dent) = (0.0, 0.0, free);
            self.apart += 1;
            if f64::from(self.apart) > f64::from(self.touched) + self.law.contact {
                self.frames_left = 0;
            }
        } else {
            (self.apart, self.touched) = (0, self.touched + 1);
            self.touch(before, free);
        }
        self.impulse -= self.force;
        if self.impulse < 0.0 {
            self.frames_left = 0;
            return 0.0;
        }
        self.place = Some(place + self.speed - 0.5 * self.force / self.law.mass);
        self.speed -= self.force / self.law.mass;
        self.force as f32
    }

    /// Finds the force under which the dent goes from `before` to where it would be at `free` without.
    fn touch(&mut self, before: f64, free: f64) {
        let compliance = self.compliance;
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
