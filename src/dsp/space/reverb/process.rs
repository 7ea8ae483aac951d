//! How a reverb renders: it divides blocks at control ticks, and does the work of control ticks.

use super::super::ticks::BODY_TICK;
use super::{ModalReverb, SILENCE, State};
use crate::dsp::smoothed::held;

/// Smaller input counts as silence, since masses that it moves would be slow to compute.
const FAINTEST_INPUT: f32 = 1e-15;

impl ModalReverb {
    /// Adds the space to `left` and `right`, up to the length of the shorter.
    pub fn process(&mut self, left: &mut [f32], right: &mut [f32]) {
        let frames = left.len().min(right.len());
        let (mut left, mut right) = (&mut left[..frames], &mut right[..frames]);
        while !left.is_empty() {
            if self.state != State::Awake {
                let frames = self.rest(left, right);
                (left, right) = (&mut left[frames..], &mut right[frames..]);
                if left.is_empty() {
                    return;
                }
                self.wake();
                self.jump_to_levels();
                self.silent_frames = 0;
            }
            if self.ticks.is_due() {
                self.control();
                if self.state != State::Awake {
                    continue;
                }
            }
            let frames = self.ticks.frames_before(left.len());
            let (now_left, now_right);
            (now_left, left) = left.split_at_mut(frames);
            (now_right, right) = right.split_at_mut(frames);
            self.render(now_left, now_right);
            self.ticks.advance(frames);
        }
    }

    /// Advances by silent frames, while it is idle: what was set in silence is laid out ahead of its first sound.
    pub(crate) fn skip(&mut self, frames: usize) {
        if self.state == State::Asleep {
            self.body.prepare_ahead(frames.div_ceil(BODY_TICK));
        }
    }

    /// Processes frames at rest, and returns their number: up to the first that wakes it. If the reverb is off, only the dry
    /// level acts; if it sleeps, silence is not changed.
    fn rest(&mut self, left: &mut [f32], right: &mut [f32]) -> usize {
        if self.state == State::Asleep {
            let sounds = |(left, right): (&f32, &f32)| *left != 0.0 || *right != 0.0;
            return left.iter().zip(&*right).position(sounds).unwrap_or(left.len());
        }
        if !self.dry.rests_at(1.0) {
            for (left, right) in left.iter_mut().zip(&mut *right) {
                let dry = self.dry.after(0);
                (*left, *right) = (*left * dry, *right * dry);
                self.dry.advance(1);
            }
        }
        left.len()
    }

    fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        let mut input = [0.0; BODY_TICK];
        for ((left, right), input) in left.iter().zip(&*right).zip(&mut input) {
            *input = held(0.5 * (left + right));
        }
        let frames = left.len().min(BODY_TICK);
        let input = &mut input[..frames];
        if self.drive.is_moving() {
            input.iter_mut().enumerate().for_each(|(n, input)| *input *= self.drive.after(n));
        }
        for input in &mut *input {
            let heard = if input.abs() >= FAINTEST_INPUT { *input } else { 0.0 };
            self.silent_frames = if heard == 0.0 { self.silent_frames.saturating_add(1) } else { 0 };
            self.input += f64::from(heard.abs());
            *input = self.line.next(heard);
        }
        let [wet_left, wet_right] = self.body.render(input);
        for (side, wet_side) in [(left, wet_left), (right, wet_right)] {
            if self.dry.is_moving() || self.wet.is_moving() {
                for (n, (side, wet_side)) in side.iter_mut().zip(wet_side).enumerate() {
                    *side = *side * self.dry.after(n) + wet_side * self.wet.after(n);
                }
            } else {
                let (dry, wet) = (self.dry.after(0), self.wet.after(0));
                side.iter_mut().zip(wet_side).for_each(|(side, wet_side)| *side = *side * dry + wet_side * wet);
            }
        }
        self.drive.advance(frames);
        self.dry.advance(frames);
        self.wet.advance(frames);
    }

    /// Does the work of a control tick.
    fn control(&mut self) {
        self.body.tick(std::mem::take(&mut self.input));
        if self.next_body.is_some() && self.wet.rests_at(0.0) {
            self.line.clear();
            self.finish();
            self.begin();
        }
        if self.pitch.is_moving() && self.ticks.is_due_every(self.block_ticks()) {
            self.pitch.advance(self.body.block_frames());
            self.body.tune(self.pitch.after(0).into());
        }
        if self.ticks.is_due_every(self.measure_ticks()) && !self.ticks.is_start() && self.measure() {
            return;
        }
        self.body.work();
        // The level follows the body when its change is heard.
        self.move_levels();
    }

    /// Measures the energy of the body, and returns whether it falls asleep.
    fn measure(&mut self) -> bool {
        let reach = self.line.reach();
        if self.silent_frames >= reach + self.body.block_frames() {
            self.body.measure();
        }
        let off = self.levels[1] == 0.0;
        let is_empty = self.silent_frames >= reach;
        let is_over = off || is_empty && self.body.peak(0.0) * self.loudest_wet() <= SILENCE;
        if !is_over || !self.is_still() {
            return false;
        }
        self.body.reset();
        self.line.clear();
        self.silent_frames = usize::MAX;
        self.jump_to_levels();
        self.state = if off { State::Off } else { State::Asleep };
        true
    }
}
