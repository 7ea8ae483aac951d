//! The length of a reverb's tail, and upper bounds of its amplitude.

use super::super::decay::Decay;
use super::{BODY_TICK, ModalReverb, SILENCE, State};

/// Longer tails count as endless. In frames.
const ENDLESS: u64 = 1 << 50;

impl ModalReverb {
    /// Upper bound of the frames from now until it falls asleep, if the input is silent.
    ///
    /// The bound is in closed form, and only decay removes energy: no sample after the tail exceeds −120 dBFS. Real-time safe;
    /// takes a few microseconds.
    pub fn tail_frames(&self) -> u64 {
        if self.state == State::Awake { self.tail_frames_after(0, 0.0) } else { 0 }
    }

    /// The same bound, if `frames` frames of input come before the silence. The magnitudes of this input, as the mean of both
    /// sides, sum to at most `input`. Endless if there is a next body, since its modes are not loaded yet.
    pub(crate) fn tail_frames_after(&self, frames: u64, input: f64) -> u64 {
        if self.state == State::Off {
            return if self.dry.is_moving() { frames.max(self.dry.frames_left().into()) } else { frames };
        }
        let reach = self.line.reach();
        let held = if frames > 0 { reach } else { reach.saturating_sub(self.silent_frames) } as u64;
        let mut moving = u64::from(self.wet.frames_left().max(self.dry.frames_left()));
        if !self.is_still() || self.body.is_changing() {
            // The wet level changes when a change of the body is heard.
            let steps = 2 * self.body.block_frames() as u64;
            moving = moving.max(self.pitch.frames_left().into()) + steps + u64::from(self.wet.frames());
        }
        let wet = self.loudest_wet();
        let mut rings = match self.next_body {
            // The present sound fades out before the next body starts; the tail after that is unknown.
            Some(_) if frames > 0 => return u64::MAX,
            None if wet > 0.0 => self.body.frames_until(SILENCE / wet, self.input + input),
            _ => 0,
        };
        if self.pitch.is_moving() {
            // A moving pitch may turn low modes into high ones and the reverse, and their decay changes accordingly.
            let Decay { low, high } = self.body.decay();
            rings = (rings as f64 * (low / high).max(high / low)) as u64;
        }
        let end = held.saturating_add(rings).max(moving).saturating_add(frames).saturating_add(1);
        if end > ENDLESS {
            return u64::MAX;
        }
        let until_measured = match self.state {
            State::Awake => {
                let mut ticks = self.ticks;
                ticks.advance(end as usize);
                ticks.frames_until_every(self.measure_ticks())
            }
            // Input will start the clock.
            _ => self.measure_ticks() * BODY_TICK as u64,
        };
        // It falls asleep before the next frame.
        end.saturating_add(until_measured).saturating_add(1)
    }

    /// Upper bound of the output from now on, if the magnitude of the input is at most `peak` on either side and its magnitudes
    /// sum to at most `input`. Real-time safe.
    pub(crate) fn peak_after(&self, peak: f64, input: f64) -> f64 {
        let dry = f64::from(self.dry.after(0).max(self.dry.target()));
        peak * dry + self.loudest_wet() * self.body.peak(self.input + input)
    }

    /// The largest wet gain from now on.
    pub(super) fn loudest_wet(&self) -> f64 {
        // The level of a change that is not heard yet is still to come.
        let wanted = if self.next_body.is_some() { 0.0 } else { self.levels[1] * self.body.coming_noise_gain() };
        f64::from(self.wet.after(0).max(self.wet.target()).max(wanted))
    }
}
