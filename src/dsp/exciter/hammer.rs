//! A hammer: a mass with a felt, which the body that it strikes pushes back.

use super::felt::Felt;

/// The most that a hammer gives, as a multiple of its momentum. On a body at rest it gives at most twice that, when it comes back
/// as fast as it came; a body that rings may throw it further. Then it is gone, with the energy that its felt holds.
pub(crate) const MOST_GIVEN: f64 = 3.0;

/// A hammer before its strike. Times are in frames.
#[derive(Clone, Copy, Debug)]
pub struct HammerLaw {
    /// Mass; the body's displacements and forces are in the same units.
    pub(crate) mass: f64,
    /// Its speed.
    pub(crate) speed: f64,
    /// The speed of a full strike.
    pub(crate) full_speed: f64,
    /// Contact time at a wall, at full speed.
    pub(crate) contact: f64,
    /// How far a force of 1 in a frame moves the body at the point of the strike until the frame's end.
    pub(crate) compliance: f64,
    /// The same for modes that are too high to be rendered, which follow a force at once.
    pub(crate) stillness: f64,
    /// The hammer is caught after this many frames.
    pub(crate) longest: u32,
}

impl HammerLaw {
    /// A hammer that does not move.
    pub(crate) const NONE: Self =
        Self { mass: 1.0, speed: 0.0, full_speed: 0.0, contact: 1.0, compliance: 0.0, stillness: 0.0, longest: 0 };
}

/// A hammer in flight: it touches the body, comes off, may be touched again, and is gone when it has been off for longer than
/// it touched. What it adds is at most the energy of its flight; see `Felt`. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub struct Hammer {
    law: HammerLaw,
    felt: Felt,
    place: Option<f64>,
    speed: f64,
    /// What is left of the most that it may give.
    impulse: f64,
    frames_left: u32,
    touched: u32,
    apart: u32,
}

impl Hammer {
    /// No hammer.
    pub(crate) const AWAY: Self = Self {
        law: HammerLaw::NONE,
        felt: Felt::NONE,
        place: None,
        speed: 0.0,
        impulse: 0.0,
        frames_left: 0,
        touched: 0,
        apart: 0,
    };

    /// A hammer that is about to touch the body. Without speed there is none.
    pub(crate) fn new(law: HammerLaw) -> Self {
        if !(law.speed > 0.0 && law.full_speed > 0.0) {
            return Self::AWAY;
        }
        let compliance = law.compliance + law.stillness + 0.5 / law.mass;
        Self {
            law,
            felt: Felt::new(law.mass, law.full_speed, law.contact, compliance),
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
        let held = self.law.stillness * self.felt.force * self.felt.force;
        0.5 * (self.law.mass * self.speed * self.speed + self.felt.psi * self.felt.psi + held)
    }

    /// Makes the felt give back all that it takes.
    #[cfg(test)]
    pub(crate) fn take_loss(&mut self) {
        self.felt.loss = 0.0;
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
        if self.felt.follow(place + self.speed - point) {
            (self.apart, self.touched) = (0, self.touched + 1);
        } else {
            self.apart += 1;
            if f64::from(self.apart) > f64::from(self.touched) + self.law.contact {
                self.frames_left = 0;
            }
        }
        let force = self.felt.force;
        self.impulse -= force;
        if self.impulse < 0.0 {
            self.frames_left = 0;
            return 0.0;
        }
        self.place = Some(place + self.speed - 0.5 * force / self.law.mass);
        self.speed -= force / self.law.mass;
        force as f32
    }
}
