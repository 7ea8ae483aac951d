//! The pre-delay of a reverb.

use crate::dsp::ramp::Ramp;

/// A delay whose length changes without a click: by a crossfade between two read positions.
#[derive(Clone, Debug)]
pub(super) struct PreDelay {
    /// A power of two long.
    line: Vec<f32>,
    next: usize,
    /// Present delay in frames, and the delay before the running crossfade.
    delay: usize,
    before: usize,
    /// The next delay, after that crossfade.
    wanted: usize,
    /// Share of the sample at `delay` in the output, 0–1.
    fade: Ramp,
    /// Remaining frames of the crossfade.
    left: u32,
    fade_frames: u32,
}

/// Length of a crossfade in seconds.
const FADE: f64 = 0.02;

impl PreDelay {
    /// A silent delay line for at most `longest` frames.
    pub(super) fn new(longest: usize, sample_rate: f64) -> Self {
        let fade_frames = (FADE * sample_rate) as u32;
        let line = vec![0.0; (longest + 1).next_power_of_two()];
        Self { line, next: 0, delay: 0, before: 0, wanted: 0, fade: Ramp::at_rest(1.0), left: 0, fade_frames }
    }

    /// Frames of silent input after which the output is silent, until another delay is set.
    pub(super) fn reach(&self) -> usize {
        let fades = if self.wanted == self.delay { 0 } else { self.fade_frames };
        self.delay.max(self.before).max(self.wanted) + (self.left + fades) as usize
    }

    /// Sets another delay in frames. `at_once` if nothing sounds.
    pub(super) fn set(&mut self, frames: usize, at_once: bool) {
        self.wanted = frames.min(self.line.len() - 1);
        if at_once {
            (self.delay, self.before, self.left) = (self.wanted, self.wanted, 0);
            self.fade = Ramp::at_rest(1.0);
        }
    }

    /// Adds a sample to the line and returns the one from `delay` frames ago.
    pub(super) fn next(&mut self, sample: f32) -> f32 {
        let mask = self.line.len() - 1;
        self.line[self.next] = sample;
        let read = |delay: usize| self.line[self.next.wrapping_sub(delay) & mask];
        let mut out = read(self.delay);
        if self.left > 0 {
            let share = self.fade.after(0);
            out = read(self.before) * (1.0 - share) + out * share;
            self.fade.advance(1);
            self.left -= 1;
            if self.left == 0 {
                self.before = self.delay;
            }
        } else if self.wanted != self.delay {
            (self.before, self.delay, self.left) = (self.delay, self.wanted, self.fade_frames);
            self.fade = Ramp::at_rest(0.0);
            self.fade.set(1.0, self.fade_frames);
            out = read(self.before);
        }
        self.next = (self.next + 1) & mask;
        out
    }

    /// Silences the line and sets the target delay.
    pub(super) fn clear(&mut self) {
        self.line.fill(0.0);
        self.set(self.wanted, true);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_comes_later_and_moves_without_a_jump() {
        let mut delay = PreDelay::new(1000, 48_000.0);
        delay.set(10, true);
        let out: Vec<f32> = (0..5000)
            .map(|n| {
                if n == 1000 {
                    delay.set(700, false);
                }
                delay.next(n as f32)
            })
            .collect();
        assert_eq!((out[9], out[10], out[900]), (0.0, 0.0, 890.0));
        assert_eq!(out[4000], 3300.0);
        assert!(out[1000..3000].windows(2).all(|pair| (pair[1] - pair[0]).abs() < 2.0));
        delay.set(usize::MAX, true);
        assert_eq!(delay.next(0.0), (5000 - 1023) as f32);
        delay.clear();
        assert_eq!(delay.next(0.0), 0.0);
    }
}
