//! The fade-out of all remaining sound when playing ends.

use super::status::Status;
use std::time::Duration;

/// How long the fade takes.
pub(super) const FADE: Duration = Duration::from_millis(600);

/// Fades everything out once [`Status::fade`] was called. Real-time safe.
pub struct Fade {
    /// Length of the fade in frames, and the number of frames left.
    frames: u32,
    left: u32,
}

impl Fade {
    /// For a sample rate in Hz.
    pub fn new(sample_rate: f64) -> Self {
        let frames = (sample_rate * FADE.as_secs_f64()) as u32 + 1;
        Self { frames, left: frames }
    }

    /// Fades a block out if that was requested, and reports the end of the fade. Without a request, no sample is
    /// changed.
    pub fn apply(&mut self, status: &Status, left: &mut [f32], right: &mut [f32]) {
        if !status.is_fading() {
            return;
        }
        for (left, right) in left.iter_mut().zip(right) {
            self.left = self.left.saturating_sub(1);
            let share = self.left as f32 / self.frames as f32;
            // The square sounds like an even fade, and reaches 0 without a corner.
            let gain = share * share;
            *left *= gain;
            *right *= gain;
        }
        if self.left == 0 {
            status.note_faded();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fade_begins_when_asked_for_and_ends_in_silence_without_steps() {
        let (status, mut fade) = (Status::default(), Fade::new(48_000.0));
        let mut block = |status: &Status| {
            let (mut left, mut right) = ([1.0_f32; 480], [-0.5_f32; 480]);
            fade.apply(status, &mut left, &mut right);
            assert!(left.iter().zip(right).all(|(left, right)| right == left * -0.5));
            left
        };
        assert_eq!(block(&status), [1.0; 480], "nothing was asked for");
        status.fade();
        let mut last = 1.0;
        for _ in 0..60 {
            assert!(!status.is_faded());
            for sample in block(&status) {
                assert!(sample < last && last - sample < 1e-4, "{last} {sample}");
                last = sample;
            }
        }
        assert_eq!(block(&status)[0], 0.0);
        assert!(status.is_faded());
        assert_eq!(block(&status), [0.0; 480], "and it stays silent");
    }
}
