//! When a reverb's tail is over, and how loud it can be until then.

use super::super::decay::Decay;
use super::super::kernel::FRAMES;
use super::{MEASURE_TICKS, ModalReverb, PITCH_TICKS, SILENCE, State};

/// Tails that are longer than so many frames have no end.
const ENDLESS: u64 = 1 << 50;

impl ModalReverb {
    /// At most how many frames after the last that was processed it falls asleep, if only silence comes from there on.
    ///
    /// Energy is known in closed form, and nothing but decay takes it: no sample after the tail exceeds −120 dBFS. Real-time
    /// safe; takes a few microseconds.
    pub fn tail_frames(&self) -> u64 {
        if self.state == State::Awake { self.tail_frames_after(0, 0.0) } else { 0 }
    }

    /// The same if before the silence there are `frames` frames of input, whose magnitudes, the mean of both sides, add up to
    /// at most `input`. Without end if a body is still to come, as its modes are not known before.
    pub fn tail_frames_after(&self, frames: u64, input: f64) -> u64 {
        if self.state == State::Off {
            return if self.dry.is_moving() { frames.max(self.dry.frames_left().into()) } else { frames };
        }
        let reach = self.line.reach();
        let held = if frames > 0 { reach } else { reach.saturating_sub(self.silent_frames) } as u64;
        let mut moving = u64::from(self.wet.frames_left().max(self.dry.frames_left()));
        if !self.is_still() {
            // The wet level follows what the pitch and the body become.
            let steps = 2 * PITCH_TICKS * FRAMES as u64;
            moving = moving.max(self.pitch.frames_left().into()) + steps + u64::from(self.wet.frames());
        }
        let wet = self.loudest_wet();
        let mut rings = match self.next_body {
            // What sounds fades out before the body comes; what comes after that nobody knows.
            Some(_) if frames > 0 => return u64::MAX,
            None if wet > 0.0 => self.body.frames_until(SILENCE / wet, self.input + input),
            _ => 0,
        };
        if self.pitch.is_moving() {
            // Lows may become highs and the reverse, and decay as these do.
            let Decay { low, high } = self.body.decay();
            rings = (rings as f64 * (low / high).max(high / low)) as u64;
        }
        let end = held.saturating_add(rings).max(moving).saturating_add(frames).saturating_add(1);
        if end > ENDLESS {
            return u64::MAX;
        }
        let mut ticks = self.ticks;
        ticks.advance(end as usize);
        // It falls asleep before the frame after.
        end.saturating_add(ticks.frames_until_every(MEASURE_TICKS)).saturating_add(1)
    }

    /// Greatest magnitude of what comes out from now on, if what comes in has at most `peak` on either side, and its
    /// magnitudes add up to at most `input`. Real-time safe.
    pub fn peak_after(&self, peak: f64, input: f64) -> f64 {
        let dry = f64::from(self.dry.after(0).max(self.dry.target()));
        peak * dry + self.loudest_wet() * self.body.peak(self.input + input)
    }

    /// The greatest wet gain from now on.
    pub(super) fn loudest_wet(&self) -> f64 {
        f64::from(self.wet.after(0).max(self.wet.target()))
    }
}
