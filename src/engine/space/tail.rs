//! The length of the tail of the effects after the voices.

use super::Space;
use crate::dsp::space::ModalReverb;

/// Longer tails count as endless. In frames.
const ENDLESS: u64 = 1 << 48;

impl Space {
    /// Upper bound of the frames until all effects are idle, if voices play for another `frames` frames with at most the
    /// amplitude `peak`, and are silent afterwards. Exactly `frames` if all effects are off.
    pub(crate) fn tail_frames(&self, frames: u64, peak: f64) -> u64 {
        if !self.is_on || frames > ENDLESS {
            return frames;
        }
        let mut tail = Tail { frames, peak };
        if let Some(soundbox) = self.soundbox.as_ref().filter(|soundbox| !soundbox.is_off()) {
            tail = Tail { frames: soundbox.tail_frames_after(frames, peak), peak: soundbox.peak_after(peak) };
        }
        let resonant = self.resonant.as_deref();
        if let Some(resonant) = resonant {
            tail.through_body(&resonant.strings);
        }
        tail.frames = tail.frames.max(self.tremolo.tail_frames());
        if !self.drive.is_off() {
            let own = if tail.frames > 0 { self.drive.tail_frames_after() } else { self.drive.tail_frames() };
            // Twice the peak, to allow for the overshoot of the filters.
            tail = Tail { frames: tail.frames.saturating_add(own), peak: 2.0 * self.drive.peak_after(tail.peak) };
        }
        if !self.tone.is_off() {
            let own = if tail.frames > 0 { self.tone.tail_frames_after() } else { self.tone.tail_frames() };
            tail = Tail { frames: tail.frames.saturating_add(own), peak: self.tone.peak_after(tail.peak) };
        }
        if let Some(resonant) = resonant {
            tail.through_body(&resonant.reverb);
        }
        tail.frames.max(self.width.tail_frames())
    }
}

/// Upper bounds of the duration and the amplitude of a sound.
#[derive(Clone, Copy)]
struct Tail {
    frames: u64,
    peak: f64,
}

impl Tail {
    fn through_body(&mut self, body: &ModalReverb) {
        if body.is_off() || self.frames > ENDLESS {
            return;
        }
        let input = self.peak * self.frames as f64;
        self.peak = body.peak_after(self.peak, input);
        self.frames = match self.frames {
            0 => body.tail_frames(),
            frames => body.tail_frames_after(frames, input),
        };
    }
}
