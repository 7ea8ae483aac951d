//! The state of every knob of a sound: its value, the host's modulation of it, and the ramp by which it moves.

use crate::dsp::ramp::Ramp;
use crate::params::{Choice, PARAM_COUNT, PARAMS, Param};

/// The state of one knob.
#[derive(Clone, Copy)]
struct Knob {
    /// The value that was set.
    value: f32,
    /// The ramp to this value with the host's modulation. It jumps there unless sounding notes follow the knob.
    played: Ramp,
}

/// The knobs of one sound. Real-time safe.
#[derive(Clone)]
pub(crate) struct Knobs {
    knobs: [Knob; PARAM_COUNT],
    /// Frames until all ramps have reached their targets.
    moving: u32,
}

impl Knobs {
    /// All knobs at the values that `value` gives, which knobs can take, moved by `offsets` in knob travel, without ramps.
    pub(crate) fn new(value: impl Fn(Param) -> f32, offsets: &[f32; PARAM_COUNT]) -> Self {
        let knobs = std::array::from_fn(|index| {
            let info = &PARAMS[index];
            let value = value(info.param);
            Knob { value, played: Ramp::at_rest(info.moved(value, offsets[index])) }
        });
        Self { knobs, moving: 0 }
    }

    /// Sets a knob and the host's modulation of it in knob travel. Returns whether sounding notes follow the knob to a
    /// new target.
    pub(crate) fn set(&mut self, param: Param, value: f32, offset: f32, sample_rate: f64) -> bool {
        let (info, knob) = (param.info(), &mut self.knobs[param as usize]);
        knob.value = info.clamp(value);
        let (target, frames) = (info.moved(knob.value, offset), info.smoothing_frames(sample_rate));
        let is_new = knob.played.after(u32::MAX) != target;
        if is_new {
            knob.played.set(target, frames.unwrap_or(0));
            self.moving = self.moving.max(frames.unwrap_or(0));
        }
        is_new && frames.is_some()
    }

    /// Advances the ramps by `frames` frames.
    pub(crate) fn advance(&mut self, frames: u32) {
        if self.moving > 0 {
            self.knobs.iter_mut().for_each(|knob| knob.played.advance(frames));
            self.moving = self.moving.saturating_sub(frames);
        }
    }

    /// The value that was set.
    pub(crate) fn value(&self, param: Param) -> f32 {
        self.knobs[param as usize].value
    }

    /// The value with the host's modulation, at which the ramp ends. Strikes read this.
    pub(crate) fn modulated(&self, param: Param) -> f32 {
        self.after(param, u32::MAX)
    }

    /// The choice of [`Knobs::modulated`].
    pub(crate) fn choice<T: Choice>(&self, param: Param) -> T {
        debug_assert!(param.info().choices == T::NAMES, "{param:?} has other choices");
        T::from_value(self.modulated(param))
    }

    /// The value with the host's modulation, `frames` frames from now.
    pub(crate) fn after(&self, param: Param, frames: u32) -> f32 {
        self.knobs[param as usize].played.after(frames)
    }

    /// Whether all ramps will have ended `frames` frames from now.
    pub(crate) fn are_at_rest_after(&self, frames: u32) -> bool {
        frames >= self.moving
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_parameter_arrives_after_its_time_and_no_sooner() {
        let mut knobs = Knobs::new(|param| param.info().default, &[0.0; PARAM_COUNT]);
        assert!(knobs.set(Param::Decay, 2.0, 0.0, 48_000.0));
        assert_eq!((knobs.after(Param::Decay, 0), knobs.modulated(Param::Decay)), (1.0, 2.0));
        assert!((knobs.after(Param::Decay, 480) - 1.5).abs() < 1e-6);
        knobs.advance(480);
        assert!(!knobs.set(Param::Decay, 2.0, 0.0, 48_000.0), "setting the same target again does not start anew");
        assert_eq!(knobs.after(Param::Decay, 480), 2.0);
        assert!(knobs.are_at_rest_after(480) && !knobs.are_at_rest_after(479));
    }
}
