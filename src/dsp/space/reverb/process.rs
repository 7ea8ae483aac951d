//! How a reverb renders: it divides blocks at control ticks, and does the work of control ticks.

use super::super::kernel::FRAMES;
use super::super::smoothed::held;
use super::{MEASURE_TICKS, ModalReverb, PITCH_TICKS, SILENCE, State};

/// Smaller input counts as silence, since masses that it moves would be slow to compute.
const FAINTEST_INPUT: f32 = 1e-15;

impl ModalReverb {
    /// Adds the space to `left` and `right`, up to the length of the shorter.
    pub fn process(&mut self, left: &mut [f32], right: &mut [f32]) {
        let frames = left.len().min(right.len());
        let (mut left, mut right) = (&mut left[..frames], &mut right[..frames]);
        while !left.is_empty() {
            if self.state != State::Awake && self.rest(left, right) {
                return self.ticks.advance(left.len());
            }
            if self.ticks.is_due() {
                self.control();
            }
            let frames = self.ticks.frames_before(left.len());
            let (now_left, now_right);
            (now_left, left) = left.split_at_mut(frames);
            (now_right, right) = right.split_at_mut(frames);
            if self.state == State::Asleep && !is_silent(now_left, now_right) {
                self.wake();
            }
            if self.state == State::Awake {
                self.render(now_left, now_right);
            } else {
                _ = self.rest(now_left, now_right);
            }
            self.ticks.advance(frames);
        }
    }

    /// Processes a block at rest, and returns whether that is complete. If the reverb is off, only the dry level acts; if it
    /// sleeps, silence is not changed.
    fn rest(&mut self, left: &mut [f32], right: &mut [f32]) -> bool {
        if self.state == State::Asleep {
            return is_silent(left, right);
        }
        if !self.dry.rests_at(1.0) {
            for (left, right) in left.iter_mut().zip(right) {
                let dry = self.dry.after(0);
                (*left, *right) = (*left * dry, *right * dry);
                self.dry.advance(1);
            }
        }
        true
    }

    fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        let mut input = [0.0; FRAMES];
        let is_driven = !self.drive.is_moving();
        for (n, ((left, right), input)) in left.iter().zip(&*right).zip(&mut input).enumerate() {
            let sum = held(0.5 * (left + right)) * if is_driven { 1.0 } else { self.drive.after(n) };
            let heard = if sum.abs() >= FAINTEST_INPUT { sum } else { 0.0 };
            self.silent_frames = if heard == 0.0 { self.silent_frames.saturating_add(1) } else { 0 };
            self.input += f64::from(heard.abs());
            *input = self.line.next(heard);
        }
        let frames = left.len().min(FRAMES);
        let [wet_left, wet_right] = self.body.render(&input[..frames]);
        let moving = self.dry.is_moving() || self.wet.is_moving();
        let (mut dry, mut wet) = (self.dry.after(0), self.wet.after(0));
        for i in 0..frames {
            if moving {
                (dry, wet) = (self.dry.after(i), self.wet.after(i));
            }
            left[i] = left[i] * dry + wet_left[i] * wet;
            right[i] = right[i] * dry + wet_right[i] * wet;
        }
        self.drive.advance(frames);
        self.dry.advance(frames);
        self.wet.advance(frames);
    }

    /// Does the work of a control tick.
    fn control(&mut self) {
        if self.state != State::Awake {
            return;
        }
        self.body.tick(std::mem::take(&mut self.input));
        if self.next_body.is_some() && self.wet.rests_at(0.0) {
            self.line.clear();
            self.finish();
            self.fade_in();
            self.move_levels();
        }
        if self.pitch.is_moving() && self.ticks.is_due_every(PITCH_TICKS) {
            self.pitch.advance(PITCH_TICKS as usize * FRAMES);
            self.body.tune(self.pitch.after(0).into());
            self.move_levels();
        }
        if !self.ticks.is_due_every(MEASURE_TICKS) {
            return;
        }
        let is_empty = self.silent_frames >= self.line.reach();
        self.body.measure(is_empty);
        let still = self.is_still();
        let off = self.levels[1] == 0.0;
        if still && (off || is_empty && self.body.peak(0.0) * self.loudest_wet() <= SILENCE) {
            self.body.reset();
            self.line.clear();
            self.silent_frames = usize::MAX;
            self.jump_to_levels();
            self.state = if off { State::Off } else { State::Asleep };
        }
    }
}

fn is_silent(left: &[f32], right: &[f32]) -> bool {
    left.iter().chain(right).all(|sample| *sample == 0.0)
}
