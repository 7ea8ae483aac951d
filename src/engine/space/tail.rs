//! How long what is behind the voices goes on.

use super::Space;
use crate::dsp::space::ModalReverb;

/// Tails that are longer than so many frames have no end.
const ENDLESS: u64 = 1 << 48;

impl Space {
    /// At most how many frames it takes until all of it sleeps, if voices play for `frames` frames more, no louder than
    /// `peak`, and then there is silence. Exactly `frames` if all is off.
    pub(crate) fn tail_frames(&self, frames: u64, peak: f64) -> u64 {
        if !self.is_on || frames > ENDLESS {
            return frames;
        }
        let mut tail = Tail { frames, peak };
        let resonant = self.resonant.as_deref();
        if let Some(resonant) = resonant {
            tail.through_body(&resonant.strings);
        }
        tail.frames = tail.frames.max(self.tremolo.tail_frames());
        if !self.drive.is_off() {
            let own = if tail.frames > 0 { self.drive.tail_frames_after() } else { self.drive.tail_frames() };
            // What filters overshoot, doubled.
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

/// How long something sounds at most, and how loudly.
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
