//! The excitation of the masses: a mallet's force pulse, a pluck, noise, and a bow or a breath, in any combination.
//!
//! A [`Stroke`] has the areas and lengths of what pushes and what pulls, and a burst of noise. Three forces go to the
//! bank, and each mode has a gain for each of them. An exciter that is off makes no force, so nothing is computed for
//! it, and the kernel reads only the forces that are there: one that acts on `y`, one of either kind with noise, or all
//! three. All kinds of movement share the last form, which is seldom needed for longer than a contact
//! (`a_force_alone_gives_the_bits_of_the_form_that_reads_all`). Levels are in the forces. Incoming sound is added to
//! what pushes, and noise that is held to the bursts.

mod bow;
mod breath;
mod burst;
mod felt;
mod hammer;
mod jet;
mod mouthpiece;
mod pulse;
mod rattle;
mod valve;

use super::CONTROL_FRAMES;
pub use bow::Bow;
pub use breath::Breath;
use burst::Burst;
pub use burst::{BurstSetup, Colour, Decay};
pub(crate) use hammer::MOST_GIVEN;
pub use hammer::{Hammer, HammerLaw};
pub use jet::JetLaw;
pub use mouthpiece::{Mouthpiece, MouthpieceLaw};
use pulse::Pulse;
pub use rattle::{Rattle, RattleKind, RattleLaw};
pub use valve::ValveLaw;

/// The forces of up to [`CONTROL_FRAMES`] frames.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    /// Forces that change the velocity: the samples of a mallet's pulse sum to the force of the strike.
    pub push: [f32; CONTROL_FRAMES],
    /// Forces that change the displacement: the samples of a pluck's pulse sum to its force.
    pub pull: [f32; CONTROL_FRAMES],
    /// The noise burst: its expected energy in a mode is the same as that of a strike with its force.
    pub noise: [f32; CONTROL_FRAMES],
}

impl Drive {
    /// No force.
    pub const NONE: Drive =
        Drive { push: [0.0; CONTROL_FRAMES], pull: [0.0; CONTROL_FRAMES], noise: [0.0; CONTROL_FRAMES] };
}

/// What drives a body by a force that depends on how the body moves: a hammer for as long as it touches, a rattle
/// while the body swings, the others for as long as the note is held.
#[derive(Debug)]
pub enum Player<'a> {
    /// A bow.
    Bow(Bow),
    /// Breath through a mouthpiece.
    Breath(&'a mut Mouthpiece),
    /// A hammer.
    Hammer(&'a mut Hammer),
    /// Something that rattles.
    Rattle(&'a mut Rattle),
    /// A force that was found before, in each frame.
    Forces(&'a [f32; CONTROL_FRAMES]),
}

impl Player<'_> {
    /// The force in the frame that is `frame` frames after the next one. `motion` is the sum of the modes at the point of play: a
    /// speed for a bow and a jet, a pressure for a valve, a displacement for a hammer or a rattle.
    pub(crate) fn force_on(&mut self, frame: usize, motion: f32) -> f32 {
        match self {
            Self::Bow(bow) => bow.force_on(frame, motion),
            Self::Breath(mouthpiece) => mouthpiece.force_on(frame, motion),
            Self::Hammer(hammer) => hammer.force_on(motion),
            Self::Rattle(rattle) => rattle.force_on(motion),
            Self::Forces(forces) => forces[frame],
        }
    }

    /// The share of a frame's force that is added to what is heard of the modes: half for a push that is all at the start of a frame,
    /// 0 for a force that is spread over it.
    pub(crate) fn heard_ahead(&self) -> f32 {
        match self {
            Self::Bow(_) | Self::Breath(_) => 0.5,
            Self::Hammer(_) | Self::Rattle(_) | Self::Forces(_) => 0.0,
        }
    }
}

/// The parameters of a strike.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// Area of the mallet's pulse, 0 for none, and its length in frames, at least 1.
    pub push: (f32, u32),
    /// Area and length of the pluck's pulse.
    pub pull: (f32, u32),
    /// The noise.
    pub noise: BurstSetup,
}

impl Stroke {
    /// No strike.
    pub const NONE: Stroke = Stroke { push: (0.0, 1), pull: (0.0, 1), noise: BurstSetup::NONE };
}

/// Maximum number of strikes in progress; a further one replaces the one that would end first.
const OVERLAPPING: usize = 4;

/// The strikes in progress on one voice. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub struct Exciter {
    blows: [Blow; OVERLAPPING],
    /// The slot that is tried first: one after the other, since the accepted bits depend on the order in which forces add up.
    next: usize,
    /// Frames until no force is left.
    frames_left: u32,
}

impl Exciter {
    /// An exciter at rest.
    pub const REST: Exciter = Exciter { blows: [Blow::REST; OVERLAPPING], next: 0, frames_left: 0 };

    /// Starts a strike. Earlier strikes continue; if there are too many, it replaces the one that would end first.
    pub fn strike(&mut self, stroke: &Stroke, sample_rate: f64) {
        let slots = (self.next..self.next + OVERLAPPING).map(|slot| slot % OVERLAPPING);
        let slot = slots.min_by_key(|slot| self.blows[*slot].frames_left()).unwrap_or(self.next);
        self.blows[slot] = Blow::new(stroke, sample_rate);
        self.next = (slot + 1) % OVERLAPPING;
        self.frames_left = self.blows.iter().map(Blow::frames_left).max().unwrap_or(0);
    }

    /// Whether any force is still to come.
    pub(crate) fn is_active(&self) -> bool {
        self.frames_left > 0
    }

    /// Frames until no force is left.
    pub(crate) fn frames_left(&self) -> u32 {
        self.frames_left
    }

    /// The slot of the strike that was started last.
    pub(crate) fn newest(&self) -> usize {
        (self.next + OVERLAPPING - 1) % OVERLAPPING
    }

    /// Whether any of the pulses of the strike that was started last is still to come.
    pub(crate) fn is_pushed(&self) -> bool {
        self.blows[self.newest()].is_pushed()
    }

    /// Whether any force of the strike in this slot is still to come.
    pub(crate) fn is_acting(&self, slot: usize) -> bool {
        self.blows[slot].frames_left() > 0
    }

    /// A copy in which only the strike in this slot is in progress.
    #[must_use]
    pub(crate) fn only(&self, slot: usize) -> Self {
        let mut blows = [Blow::REST; OVERLAPPING];
        blows[slot] = self.blows[slot];
        Self { blows, next: self.next, frames_left: blows[slot].frames_left() }
    }

    /// Writes the forces of the next `frames` frames, at most [`CONTROL_FRAMES`], and advances by them.
    pub fn fill(&mut self, frames: usize, drive: &mut Drive) {
        let Drive { push, pull, noise } = drive;
        [push, pull, noise].into_iter().for_each(|force| force[..frames].fill(0.0));
        for blow in self.blows.iter_mut().filter(|blow| blow.frames_left() > 0) {
            blow.add_to(frames, drive);
        }
        self.frames_left = self.frames_left.saturating_sub(frames as u32);
    }
}

/// One strike.
#[derive(Clone, Copy, Debug)]
struct Blow {
    push: Pulse,
    pull: Pulse,
    noise: Burst,
    frame: u32,
}

impl Blow {
    const REST: Blow = Blow { push: Pulse::NONE, pull: Pulse::NONE, noise: Burst::NONE, frame: 0 };

    fn new(stroke: &Stroke, sample_rate: f64) -> Self {
        let pulse = |(area, frames)| Pulse::new(area, frames);
        Self {
            push: pulse(stroke.push),
            pull: pulse(stroke.pull),
            noise: Burst::new(stroke.noise, sample_rate),
            frame: 0,
        }
    }

    fn frames_left(&self) -> u32 {
        self.push.frames().max(self.pull.frames()).max(self.noise.frames()).saturating_sub(self.frame)
    }

    fn is_pushed(&self) -> bool {
        self.frame < self.push.frames().max(self.pull.frames())
    }

    fn add_to(&mut self, frames: usize, drive: &mut Drive) {
        self.push.add_to(self.frame, &mut drive.push[..frames]);
        self.pull.add_to(self.frame, &mut drive.pull[..frames]);
        self.noise.add_to(self.frame, &mut drive.noise[..frames]);
        self.frame = self.frame.saturating_add(frames as u32);
    }
}

#[cfg(test)]
mod tests;
