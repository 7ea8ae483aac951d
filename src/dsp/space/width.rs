//! The width of the stereo image: the level of the side signal relative to the middle.

use crate::dsp::smoothed::Smoothed;

/// Scales the difference between left and right: 0 is mono, 1 leaves both as they are, 2 is the widest.
///
/// `middle = (l + r)/2` does not change, so the mono sum stays the same (A. D. Blumlein 1931). With a constant width of 1 it
/// does not change the signal. Real-time safe.
///
/// ```
/// let mut width = sprung::internals::space::Width::new(48_000.0);
/// width.set(0.0);
/// let (mut left, mut right) = (vec![1.0; 2000], vec![0.0; 2000]);
/// width.process(&mut left, &mut right);
/// assert_eq!((left[1999], right[1999]), (0.5, 0.5));
/// ```
#[derive(Clone, Debug)]
pub struct Width {
    width: Smoothed,
}

impl Width {
    /// A width of 1.
    pub fn new(sample_rate: f64) -> Self {
        Self { width: Smoothed::new(1.0, sample_rate) }
    }

    /// Moves to a width from 0 to 2 in 20 ms.
    pub fn set(&mut self, width: f32) {
        self.width.set(width.clamp(0.0, 2.0));
    }

    /// Ends the ramp.
    pub fn reset(&mut self) {
        self.width.jump(self.width.target());
    }

    /// Whether the signal is not changed.
    pub fn is_off(&self) -> bool {
        self.width.rests_at(1.0)
    }

    /// Whether silent input changes nothing.
    pub fn is_idle(&self) -> bool {
        !self.width.is_moving()
    }

    /// Frames until the ramp of the width ends.
    pub(crate) fn tail_frames(&self) -> u64 {
        self.width.frames_left().into()
    }

    /// Changes `left` and `right`, up to the length of the shorter.
    pub fn process(&mut self, left: &mut [f32], right: &mut [f32]) {
        for (left, right) in left.iter_mut().zip(right) {
            // Checked at every frame, since the sum of middle and side is rounded.
            if self.is_off() {
                return;
            }
            let (middle, side) = (0.5 * (*left + *right), 0.5 * (*left - *right) * self.width.after(0));
            (*left, *right) = (middle + side, middle - side);
            self.width.advance(1);
        }
    }
}
