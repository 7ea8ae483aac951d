//! A rattle: a loose mass that lies on a body, or a fixed edge beside it that the body hits as it swings.

use super::felt::Felt;

/// A rattle before it begins. Times are in frames; the body's displacements and forces are in the same units.
#[derive(Clone, Copy, Debug)]
pub struct RattleLaw {
    /// What it is.
    pub(crate) kind: RattleKind,
    /// The speed of a hard hit, and its contact time.
    pub(crate) speed: f64,
    /// See `speed`.
    pub(crate) contact: f64,
    /// How far a force of 1 in a frame moves the body at the point until the frame's end.
    pub(crate) compliance: f64,
}

/// What rattles.
#[derive(Clone, Copy, Debug)]
pub enum RattleKind {
    /// An edge that does not move, at a distance from the body at rest.
    Edge {
        /// The distance.
        gap: f64,
    },
    /// A mass that lies on the body.
    Loose {
        /// The mass.
        mass: f64,
        /// How much faster it falls in each frame.
        pull: f64,
    },
}

/// A rattle. It only passes on energy that the body has, and what it takes with each hit is lost; see `Felt`. Real-time safe.
///
/// The weight of a loose mass bends the body at rest, which is its place: only what differs from that weight acts on the modes.
#[derive(Clone, Copy, Debug)]
pub struct Rattle {
    felt: Felt,
    pull: f64,
    inverse_mass: f64,
    /// The weight of a loose mass, and how far it moves the body in a frame in which the mass has left it.
    rest: f64,
    lift: f64,
    /// Where it is above the body at rest, and how fast.
    place: f64,
    speed: f64,
    /// Whether it has met the body as it was when it began.
    is_there: bool,
}

impl Rattle {
    /// A rattle on a body at rest.
    pub(crate) fn new(law: RattleLaw) -> Self {
        let (inverse_mass, pull) = match law.kind {
            RattleKind::Edge { .. } => (0.0, 0.0),
            RattleKind::Loose { mass, pull } => (1.0 / mass, pull),
        };
        // An edge is as hard as a mass of 1 needs it for the contact time.
        let mass = if inverse_mass > 0.0 { 1.0 / inverse_mass } else { 1.0 };
        let mut felt = Felt::new(mass, law.speed, law.contact, law.compliance + 0.5 * inverse_mass);
        let rest = pull * mass;
        let place = match law.kind {
            RattleKind::Edge { gap } => -gap,
            RattleKind::Loose { .. } => felt.dent_under(rest),
        };
        felt.set(place);
        Self { felt, pull, inverse_mass, rest, lift: law.compliance * rest, place, speed: 0.0, is_there: false }
    }

    /// The force in the frame that has just passed, at whose end the point would be at `point` without it.
    pub(crate) fn force_on(&mut self, point: f32) -> f32 {
        let point = f64::from(point);
        if !self.is_there {
            // A loose mass begins on the body wherever that is, an edge when the body has left it.
            if self.inverse_mass > 0.0 {
                self.place += point;
            } else if self.place - point > 0.0 {
                return 0.0;
            } else {
                self.felt.set(self.place - point);
            }
            self.is_there = true;
            return 0.0;
        }
        self.felt.follow(self.place + self.speed + 0.5 * self.pull - (point - self.lift));
        let faster = self.pull - self.felt.force * self.inverse_mass;
        self.place += self.speed + 0.5 * faster;
        self.speed += faster;
        (self.felt.force - self.rest) as f32
    }

    /// Energy of the rattle and its surface, with that of its weight on the body, and of modes that only give way, by `stillness`.
    #[cfg(test)]
    pub(crate) fn energy(&self, stillness: f64) -> f64 {
        let moving = if self.inverse_mass > 0.0 { 0.5 * self.speed * self.speed / self.inverse_mass } else { 0.0 };
        let held = 0.5 * stillness * (self.felt.force - self.rest) * (self.felt.force - self.rest);
        moving + held + 0.5 * self.felt.psi * self.felt.psi - self.rest * self.felt.dent()
    }
}
