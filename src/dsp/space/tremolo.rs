//! The tremolo of a vibraphone's motor: the gain goes up and down, alternately on both sides if wanted.

use super::ticks::Ticks;
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::smoothed::Smoothed;
use libm::cos;
use std::f64::consts::TAU;

/// Multiplies both sides by `1 − depth · (1 − cos φ)/2`, like the rotating fans in a vibraphone's tubes. The right side's
/// `φ` is ahead by a constant angle.
///
/// The gain is exact at control ticks and linear between them: at 12 Hz there are 125 ticks per turn at 48 kHz. With a constant
/// depth of 0 it does not change the signal, and the motor stands still. Real-time safe.
///
/// ```
/// let mut tremolo = sprung::internals::space::Tremolo::new(48_000.0);
/// tremolo.set_rate(6.0);
/// tremolo.set_depth(1.0);
/// let (mut left, mut right) = (vec![1.0; 48_000], vec![1.0; 48_000]);
/// tremolo.process(&mut left, &mut right);
/// assert!(left[2000..].iter().any(|sample| *sample < 0.01) && left[2000..].iter().any(|sample| *sample > 0.99));
/// ```
#[derive(Clone, Debug)]
pub struct Tremolo {
    sample_rate: f64,
    ticks: Ticks<{ CONTROL_FRAMES as u64 }>,
    rate: f64,
    depth: Smoothed,
    stereo_phase: Smoothed,
    /// Turns of the motor when its rate was last set, and control ticks since then.
    start: f64,
    turned: u64,
    /// Gains at the last control tick and at the next, of both sides.
    gains: [[f32; 2]; 2],
    /// Frames since the last control tick.
    passed: usize,
}

impl Tremolo {
    /// A tremolo that is off, with a rate of 5 Hz.
    pub fn new(sample_rate: f64) -> Self {
        Self {
            sample_rate,
            ticks: Ticks::default(),
            rate: 5.0,
            depth: Smoothed::new(0.0, sample_rate),
            stereo_phase: Smoothed::new(0.0, sample_rate),
            start: 0.0,
            turned: 0,
            gains: [[1.0; 2]; 2],
            passed: 0,
        }
    }

    /// Sets the turns per second, from 0 to 20, from the next control tick on.
    pub fn set_rate(&mut self, rate: f64) {
        if !rate.is_nan() && rate.clamp(0.0, 20.0) != self.rate {
            (self.start, self.turned) = (self.phase(), 0);
            self.rate = rate.clamp(0.0, 20.0);
        }
    }

    /// Sets the depth, from 0 (off) to 1 (down to silence), in 20 ms.
    pub fn set_depth(&mut self, depth: f32) {
        self.depth.set(depth.clamp(0.0, 1.0));
    }

    /// Sets by how much the right side is ahead, in degrees from 0 to 180, in 20 ms.
    pub fn set_stereo_phase(&mut self, degrees: f32) {
        self.stereo_phase.set(degrees.clamp(0.0, 180.0) / 360.0);
    }

    /// Returns the motor to its start and ends all ramps.
    pub fn reset(&mut self) {
        self.depth.jump(self.depth.target());
        self.stereo_phase.jump(self.stereo_phase.target());
        (self.ticks, self.start, self.turned, self.passed) = (Ticks::default(), 0.0, 0, 0);
        self.gains = [self.gains_at(0.0, 0); 2];
    }

    /// Turns of the motor at the next control tick, 0 to 1.
    fn phase(&self) -> f64 {
        let turns = self.start + self.turned as f64 * (self.rate * CONTROL_FRAMES as f64 / self.sample_rate);
        turns - libm::floor(turns)
    }

    /// Whether the signal is not changed.
    pub fn is_off(&self) -> bool {
        self.is_flat() && self.ticks.is_due()
    }

    fn is_flat(&self) -> bool {
        self.depth.rests_at(0.0) && self.gains[1] == [1.0; 2]
    }

    /// Whether silent input changes nothing but the clock: [`Tremolo::skip`] does the same.
    pub fn is_idle(&self) -> bool {
        self.is_off() || self.tail_frames() == 0 && self.gains[1] == self.gains_at(self.phase(), 0)
    }

    /// Frames until the ramps of depth and phase end.
    pub(crate) fn tail_frames(&self) -> u64 {
        self.depth.frames_left().max(self.stereo_phase.frames_left()).into()
    }

    /// Advances by frames of silence while it is idle. The motor keeps turning.
    pub fn skip(&mut self, frames: usize) {
        if self.is_off() {
            return;
        }
        let to_tick = if self.ticks.is_due() { 0 } else { CONTROL_FRAMES - self.passed };
        // Without depth it is off from the next control tick on, and its clock stops there.
        let frames = if self.is_flat() { frames.min(to_tick) } else { frames };
        self.ticks.advance(frames);
        if frames <= to_tick {
            self.passed += frames;
            return;
        }
        let ticks = (frames - to_tick).div_ceil(CONTROL_FRAMES);
        self.passed = frames - to_tick - (ticks - 1) * CONTROL_FRAMES;
        self.turned += ticks as u64 - 1;
        let before = self.gains_at(self.phase(), 0);
        self.turned += 1;
        self.gains = [before, self.gains_at(self.phase(), 0)];
    }

    fn gains_at(&self, phase: f64, frames: usize) -> [f32; 2] {
        let depth = f64::from(self.depth.after(frames));
        [phase, phase + f64::from(self.stereo_phase.after(frames))].map(|phase| Self::gain(depth, phase))
    }

    /// The gain of a depth from 0 to 1, after some turns of the motor.
    pub(crate) fn gain(depth: f64, turns: f64) -> f32 {
        (1.0 - depth * 0.5 * (1.0 - cos(TAU * turns))) as f32
    }

    /// Changes `left` and `right`, up to the length of the shorter.
    pub fn process(&mut self, left: &mut [f32], right: &mut [f32]) {
        let frames = left.len().min(right.len());
        let mut start = 0;
        while start < frames {
            if self.ticks.is_due() {
                if self.is_off() {
                    return;
                }
                self.turned += 1;
                self.gains = [self.gains[1], self.gains_at(self.phase(), CONTROL_FRAMES)];
                self.depth.advance(CONTROL_FRAMES);
                self.stereo_phase.advance(CONTROL_FRAMES);
                self.passed = 0;
            }
            let end = start + self.ticks.frames_before(frames - start);
            let [from, to] = self.gains;
            for frame in start..end {
                let share = self.passed as f32 * (1.0 / CONTROL_FRAMES as f32);
                left[frame] *= from[0] + (to[0] - from[0]) * share;
                right[frame] *= from[1] + (to[1] - from[1]) * share;
                self.passed += 1;
            }
            self.ticks.advance(end - start);
            start = end;
        }
    }
}
