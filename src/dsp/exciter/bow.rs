//! A bow: friction between what moves along and the point of the body that it lies on.

/// Friction at high slip, as a share of that at none.
const SLIDING: f32 = 0.3;

/// What makes the point move as the bow does: twice the difference of their speeds, less a little, so that rounding never
/// makes it overtake the bow.
const STICKING: f32 = 1.999;

/// A bow through some frames: speed and force move in straight lines. Real-time safe.
///
/// The modes' weights at the point have squares that add up to 1. Then a force `F` in one frame gives the modes the energy
/// `2 F (v + F/2)` in squared amplitude, where `v` is the speed of the point before. Friction pulls the point towards the
/// bow's speed and never past it, so that this is at most `2 · force · speed`: what friction does at the bow's speed. The
/// rest becomes heat.
///
/// The friction falls with slip as `1/(1 + slip/width)` (as in Smith and Woodhouse, "The tribology of rosin", J. Mech.
/// Phys. Solids 48, 2000, the classical curve).
#[derive(Clone, Copy, Debug)]
pub struct Bow {
    /// Speed at the start of the line, in amplitudes of the modes, and its change a frame.
    pub speed: [f32; 2],
    /// Most friction in a frame, and its change a frame.
    pub force: [f32; 2],
    /// Frames of the line that have passed.
    pub passed: u32,
    /// Slip at which half of what friction can lose is lost, as a share of the speed.
    pub width: f32,
}

impl Bow {
    /// Speed and most friction in the frame that comes after `frame` frames more.
    pub fn at(&self, frame: usize) -> [f32; 2] {
        let passed = self.passed as f32 + (frame + 1) as f32;
        [self.speed, self.force].map(|[start, step]| (start + passed * step).max(0.0))
    }

    /// The force on the point in that frame, if the point moves at `velocity`.
    pub fn force_on(&self, frame: usize, velocity: f32) -> f32 {
        let [speed, force] = self.at(frame);
        let slip = speed - velocity;
        let width = self.width * speed + f32::MIN_POSITIVE;
        let friction = force * (SLIDING + (1.0 - SLIDING) * (width / (width + slip.abs())));
        (STICKING * slip).min(friction).max(-friction)
    }
}
