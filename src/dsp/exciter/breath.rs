//! The breath of a player, as the tube's mouthpiece meets it.

/// The breath of some frames, and the tube that it meets.
#[derive(Clone, Copy, Debug)]
pub struct Breath {
    /// Pressure in the mouth, `γ`, at the start of the ramp, and its change per frame.
    pub(crate) pressure: [f32; 2],
    /// Frames of the ramp that have passed.
    pub(crate) passed: u32,
    /// Turbulence: the deviation by chance of the pressure behind the flow, as a share of it.
    pub(crate) noise: f32,
    /// Flow at a difference of 1 through the valve at rest, `β`.
    pub(crate) opening: f32,
    /// The note's frequency over the sample rate, `q`.
    pub(crate) per_frame: f32,
    /// The sum of the modes' shares of the flow, `S`.
    pub(crate) shares: f32,
}

impl Breath {
    /// No breath, and no tube.
    pub(crate) const NONE: Self =
        Self { pressure: [0.0; 2], passed: 0, noise: 0.0, opening: 0.0, per_frame: 0.0, shares: 0.0 };

    /// The pressure in the mouth in the frame that is `frame` frames after the next one, without turbulence.
    pub(super) fn at(&self, frame: usize) -> f32 {
        (self.pressure[0] + (self.passed as f32 + (frame + 1) as f32) * self.pressure[1]).max(0.0)
    }
}
