//! The parameters that sounding voices follow, smoothed.

use super::gain::pan_gains;
use super::modulation::NoteModulation;
use crate::dsp::ramp::Ramp;
use crate::params::{PARAM_COUNT, PARAMS, Param};
use crate::patch::Patch;
use crate::units::gain_from_db;

/// Every parameter on its way to the value it was last given. Real-time safe.
pub(crate) struct Smoother {
    sample_rate: f64,
    /// Beats per second.
    beat_rate: f64,
    ramps: [Ramp; PARAM_COUNT],
    /// Frames until all have arrived.
    moving: u32,
    /// What voices follow once they have.
    arrived: Controls,
}

impl Smoother {
    /// All at rest at the values of `patch`.
    pub(crate) fn new(sample_rate: f64, patch: &Patch, beat_rate: f64) -> Self {
        let ramps = std::array::from_fn(|index| Ramp::at_rest(patch.get(PARAMS[index].param)));
        let arrived = Controls::new(|param| patch.get(param), beat_rate);
        Self { sample_rate, beat_rate, ramps, moving: 0, arrived }
    }

    /// Sets the tempo, in beats per second.
    pub(crate) fn set_tempo(&mut self, beat_rate: f64) {
        self.beat_rate = beat_rate;
        self.arrived = self.at(u32::MAX);
    }

    /// Beats per second.
    pub(crate) fn beat_rate(&self) -> f64 {
        self.beat_rate
    }

    /// Moves one parameter towards a value.
    pub(crate) fn set(&mut self, param: Param, value: f32) {
        let ramp = &mut self.ramps[param as usize];
        if let Some(frames) = param.info().smoothing_frames(self.sample_rate)
            && ramp.after(u32::MAX) != value
        {
            ramp.set(value, frames);
            self.moving = self.moving.max(frames);
            self.arrived = self.at(u32::MAX);
        }
    }

    /// Lets `frames` frames pass.
    pub(crate) fn advance(&mut self, frames: u32) {
        if self.moving > 0 {
            self.ramps.iter_mut().for_each(|ramp| ramp.advance(frames));
            self.moving = self.moving.saturating_sub(frames);
        }
    }

    /// What voices follow, `frames` frames from now.
    pub(crate) fn after(&self, frames: u32) -> Controls {
        if frames >= self.moving { self.arrived } else { self.at(frames) }
    }

    fn at(&self, frames: u32) -> Controls {
        Controls::new(|param| self.ramps[param as usize].after(frames), self.beat_rate)
    }

    /// What a note follows that has a modulation of its own, `frames` frames from now.
    pub(crate) fn modulated(&self, modulation: &NoteModulation, frames: u32) -> Controls {
        let value = |param: Param| modulation.after(param, frames);
        Controls::new(|param| value(param).unwrap_or_else(|| self.ramps[param as usize].after(frames)), self.beat_rate)
    }

    /// The value of a parameter at this frame.
    pub(crate) fn now(&self, param: Param) -> f32 {
        self.ramps[param as usize].after(0)
    }
}

/// The live parameters at one instant, in the units that voices use them in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Controls {
    /// T60 in seconds.
    pub(crate) decay: f64,
    /// T60 in seconds.
    pub(crate) release: f64,
    /// Semitones.
    pub(crate) tune: f64,
    /// Semitones.
    pub(crate) vibrato: f64,
    /// Hz.
    pub(crate) vibrato_rate: f64,
    /// Semitones.
    pub(crate) wheel_vibrato: f64,
    /// Semitones.
    pub(crate) pressure_vibrato: f64,
    /// 0–1.
    pub(crate) pressure_damping: f64,
    /// Semitones.
    pub(crate) bend_range: f32,
    /// Amplitude ratio.
    pub(crate) gain_left: f32,
    /// Amplitude ratio.
    pub(crate) gain_right: f32,
}

impl Controls {
    fn new(value: impl Fn(Param) -> f32, beat_rate: f64) -> Self {
        let gain = gain_from_db(value(Param::Gain).into()) as f32;
        let (left, right) = pan_gains(value(Param::Pan) * 0.005 + 0.5);
        Self {
            decay: value(Param::Decay).into(),
            release: value(Param::Release).into(),
            tune: f64::from(value(Param::Tune)) + f64::from(value(Param::Fine)) * 0.01,
            vibrato: f64::from(value(Param::Vibrato)) * 0.01,
            vibrato_rate: match VIBRATO_BEATS[value(Param::VibratoSync) as usize] {
                0.0 => value(Param::VibratoRate).into(),
                beats => beat_rate / beats,
            },
            wheel_vibrato: f64::from(value(Param::WheelVibrato)) * 0.01,
            pressure_vibrato: f64::from(value(Param::PressureVibrato)) * 0.01,
            pressure_damping: f64::from(value(Param::PressureDamping)) * 0.01,
            bend_range: value(Param::BendRange),
            gain_left: gain * left,
            gain_right: gain * right,
        }
    }
}

/// Quarter notes that a vibrato takes, in the order of the choices of [`Param::VibratoSync`]; 0 for one that keeps
/// its own time.
const VIBRATO_BEATS: [f64; 10] = [0.0, 4.0, 2.0, 1.5, 1.0, 2.0 / 3.0, 0.75, 0.5, 1.0 / 3.0, 0.25];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_parameter_arrives_after_its_time_and_no_sooner() {
        let patch = Patch::default();
        let mut smoother = Smoother::new(48_000.0, &patch, 2.0);
        smoother.set(Param::Decay, 2.0);
        assert_eq!(smoother.after(0).decay, 1.0);
        assert!((smoother.after(480).decay - 1.5).abs() < 1e-6);
        smoother.advance(480);
        smoother.set(Param::Decay, 2.0);
        assert_eq!(smoother.after(480).decay, 2.0, "setting the same target again does not start anew");
    }

    #[test]
    fn the_default_patch_is_centred_and_untuned() {
        let controls = Smoother::new(48_000.0, &Patch::default().with(Param::Gain, 0.0), 2.0).after(0);
        assert_eq!((controls.gain_left, controls.gain_right, controls.tune), (1.0, 1.0, 0.0));
    }

    #[test]
    fn a_synchronised_vibrato_follows_the_tempo() {
        assert_eq!(VIBRATO_BEATS.len(), Param::VibratoSync.info().choices.len());
        let mut smoother = Smoother::new(48_000.0, &Patch::default(), 2.0);
        for (choice, rate) in [("off", 5.0), ("1/1", 0.5), ("1/4", 2.0), ("1/8T", 6.0), ("1/4.", 4.0 / 3.0)] {
            smoother.set(Param::VibratoSync, Param::VibratoSync.info().parse(choice).unwrap());
            assert!((smoother.after(0).vibrato_rate - rate).abs() < 1e-12, "{choice}");
        }
        smoother.set_tempo(1.0);
        assert!((smoother.after(0).vibrato_rate - 2.0 / 3.0).abs() < 1e-12);
    }
}
