//! The last frames of the sound, for a display that shows them as a curve.

use super::atomic::AtomicF32;
use crate::units::mono_from_stereo;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::Ordering::Relaxed;

/// How many frames are kept: 43 ms at 48 kHz.
pub const SCOPE_FRAMES: usize = 2048;

/// The last frames of the sound, mixed to mono. One thread writes, any thread reads; neither waits. A reader may get
/// some frames that are newer than the rest, which does not matter for a picture.
pub struct Scope {
    frames: [AtomicF32; SCOPE_FRAMES],
    /// Index of the next frame to write.
    next: AtomicU32,
}

impl Default for Scope {
    /// Silence.
    fn default() -> Self {
        Self { frames: std::array::from_fn(|_| AtomicF32::default()), next: AtomicU32::new(0) }
    }
}

impl Scope {
    /// Adds frames. Real-time safe.
    pub(super) fn write(&self, left: &[f32], right: &[f32]) {
        let mut next = self.next.load(Relaxed) as usize;
        for (left, right) in left.iter().zip(right) {
            self.frames[next % SCOPE_FRAMES].store(mono_from_stereo(*left, *right));
            next = (next + 1) % SCOPE_FRAMES;
        }
        self.next.store(next as u32, Relaxed);
    }

    /// The frames, the oldest first.
    pub fn read(&self) -> [f32; SCOPE_FRAMES] {
        let next = self.next.load(Relaxed) as usize;
        std::array::from_fn(|frame| self.frames[(next + frame) % SCOPE_FRAMES].load())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_frames_are_read_in_order() {
        let scope = Scope::default();
        let frames: Vec<f32> = (0..SCOPE_FRAMES + 100).map(|frame| frame as f32).collect();
        for part in frames.chunks(77) {
            scope.write(part, part);
        }
        assert_eq!(scope.read()[..], frames[100..]);
    }
}
