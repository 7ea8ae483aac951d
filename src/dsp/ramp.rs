//! A linear ramp from one value to another, as a function of elapsed frames.

/// A value that moves to a target. Real-time safe.
///
/// The value depends only on the number of elapsed frames, not on the block size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ramp {
    from: f32,
    to: f32,
    frames: u32,
    elapsed: u32,
}

impl Ramp {
    /// A ramp that stays at `value`.
    pub(crate) fn at_rest(value: f32) -> Self {
        Self { from: value, to: value, frames: 0, elapsed: 0 }
    }

    /// Starts a ramp from the present value to `target`, which is reached after `frames`.
    pub(crate) fn set(&mut self, target: f32, frames: u32) {
        *self = Self { from: self.after(0), to: target, frames, elapsed: 0 };
    }

    /// The value `frames` frames from now.
    pub(crate) fn after(&self, frames: u32) -> f32 {
        let elapsed = self.elapsed.saturating_add(frames);
        if elapsed >= self.frames {
            self.to
        } else {
            self.from + (self.to - self.from) * (elapsed as f32 / self.frames as f32)
        }
    }

    /// Advances by `frames` frames.
    pub(crate) fn advance(&mut self, frames: u32) {
        self.elapsed = self.elapsed.saturating_add(frames);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_is_the_same_however_it_is_divided() {
        let mut whole = Ramp::at_rest(-1.0);
        whole.set(2.0, 100);
        let mut parts = whole;
        whole.advance(63);
        (0..63).for_each(|_| parts.advance(1));
        assert_eq!(whole.after(0), parts.after(0));
        assert_eq!(parts.after(37), 2.0);
        assert_eq!(parts.after(u32::MAX), 2.0);
        whole.set(0.0, 0);
        assert_eq!(whole.after(0), 0.0);
    }
}
