//! A bow: friction between the moving bow and the point of the body under it.

/// Friction at high slip, as a fraction of the friction without slip.
const SLIDING: f32 = 0.3;

/// Force per slip that makes the point move with the bow: the exact factor would be 2. It is a little less, so that rounding
/// never makes the point faster than the bow.
const STICKING: f32 = 1.999;

/// A bow for some frames: speed and force change linearly. Real-time safe.
///
/// The squares of the modes' weights at the point add up to 1. Then a force `F` in one frame adds the energy `2 F (v + F/2)`
/// to the modes, in squared amplitude, where `v` is the speed of the point before. Friction moves the point towards the bow's
/// speed and never past it. So the added energy is at most `2 · force · speed`, the work of the friction at the bow's speed.
/// The rest becomes heat.
///
/// The friction falls with slip as `1/(1 + slip/width)` (as in Smith and Woodhouse, "The tribology of rosin", J. Mech.
/// Phys. Solids 48, 2000, the classical curve).
#[derive(Clone, Copy, Debug)]
pub struct Bow {
    /// Speed at the start of the ramp, in amplitudes of the modes, and its change per frame.
    pub(crate) speed: [f32; 2],
    /// Maximum friction in a frame, and its change per frame.
    pub(crate) force: [f32; 2],
    /// Frames of the ramp that have passed.
    pub(crate) passed: u32,
    /// Slip at which friction is half way between its values without slip and at high slip, as a fraction of the speed.
    pub(crate) width: f32,
}

impl Bow {
    /// Speed and maximum friction in the frame that is `frame` frames after the next one.
    pub(crate) fn at(&self, frame: usize) -> [f32; 2] {
        let passed = self.passed as f32 + (frame + 1) as f32;
        [self.speed, self.force].map(|[start, step]| (start + passed * step).max(0.0))
    }

    /// Friction at a slip, as a share of that without: `width` is the slip at which it has fallen half way.
    #[inline(always)]
    pub(crate) fn friction(width: f32, slip: f32) -> f32 {
        SLIDING + (1.0 - SLIDING) * (width / (width + slip.abs()))
    }

    /// The force on the point in that frame, if the point moves at `velocity`.
    pub(crate) fn force_on(&self, frame: usize, velocity: f32) -> f32 {
        let [speed, force] = self.at(frame);
        let slip = speed - velocity;
        let width = self.width * speed + f32::MIN_POSITIVE;
        let friction = force * Self::friction(width, slip);
        (STICKING * slip).min(friction).max(-friction)
    }
}
