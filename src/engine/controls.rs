//! Parameter smoothing, and the parameter values that sounding voices follow.

use super::gain::{exciter_gain, pan_gains};
use super::modulation::{Bus, NoteModulation, Settings, rate_at};
use crate::dsp::power_of_two;
use crate::dsp::ramp::Ramp;
use crate::params::{Choice, NoteValue, PARAM_COUNT, PARAMS, Param, Values};
use crate::units::gain_from_db;

/// Parameter smoothing: a ramp for each parameter to its last value. Real-time safe.
pub(crate) struct Smoother {
    sample_rate: f64,
    /// Beats per second.
    beat_rate: f64,
    ramps: [Ramp; PARAM_COUNT],
    /// Frames until all ramps have reached their targets.
    moving: u32,
    /// Number of changes of a parameter or of the tempo so far.
    changes: u32,
    /// The controls after all ramps have ended.
    arrived: Controls,
}

impl Smoother {
    /// All parameters at `values`, without ramps.
    pub(crate) fn new(sample_rate: f64, values: &Values, beat_rate: f64) -> Self {
        let ramps = std::array::from_fn(|index| Ramp::at_rest(values.get(PARAMS[index].param)));
        let arrived = Controls::new(|param| values.get(param), beat_rate);
        Self { sample_rate, beat_rate, ramps, moving: 0, changes: 0, arrived }
    }

    /// Sets the tempo, in beats per second.
    pub(crate) fn set_tempo(&mut self, beat_rate: f64) {
        self.beat_rate = beat_rate;
        self.changes = self.changes.wrapping_add(1);
        self.arrived = self.at(u32::MAX);
    }

    /// Beats per second.
    pub(crate) fn beat_rate(&self) -> f64 {
        self.beat_rate
    }

    /// Starts a parameter's ramp to a value.
    pub(crate) fn set(&mut self, param: Param, value: f32) {
        let ramp = &mut self.ramps[param as usize];
        if let Some(frames) = param.info().smoothing_frames(self.sample_rate)
            && ramp.after(u32::MAX) != value
        {
            ramp.set(value, frames);
            self.changes = self.changes.wrapping_add(1);
            self.moving = self.moving.max(frames);
            self.arrived = self.at(u32::MAX);
        }
    }

    /// Advances the ramps by `frames` frames.
    pub(crate) fn advance(&mut self, frames: u32) {
        if self.moving > 0 {
            self.ramps.iter_mut().for_each(|ramp| ramp.advance(frames));
            self.moving = self.moving.saturating_sub(frames);
        }
    }

    /// The controls `frames` frames from now.
    pub(crate) fn after(&self, frames: u32) -> Controls {
        if frames >= self.moving { self.arrived } else { self.at(frames) }
    }

    fn at(&self, frames: u32) -> Controls {
        Controls::new(|param| self.value_after(param, frames), self.beat_rate)
    }

    /// The modulators' settings `frames` frames from now; `before` are the last ones.
    pub(crate) fn settings_after(&self, frames: u32, before: &Settings, bus: &Bus) -> Settings {
        before.next(bus, |param| self.value_after(param, frames), self.beat_rate)
    }

    /// The modulators' settings for a note with host offsets of its own.
    pub(crate) fn own_settings(&self, own: &NoteModulation, frames: u32, before: &Settings, bus: &Bus) -> Settings {
        let value = |param| own.after(param, frames).unwrap_or_else(|| self.value_after(param, frames));
        before.own(bus, value, self.beat_rate)
    }

    /// Number of changes of a parameter or of the tempo so far; none if a ramp will still be running `frames` frames
    /// from now.
    pub(crate) fn changes(&self, frames: u32) -> Option<u32> {
        (frames >= self.moving).then_some(self.changes)
    }

    /// The value of a parameter, `frames` frames from now.
    pub(crate) fn value_after(&self, param: Param, frames: u32) -> f32 {
        self.ramps[param as usize].after(frames)
    }

    /// The controls of a note with host offsets of its own, `frames` frames from now.
    pub(crate) fn modulated(&self, modulation: &NoteModulation, frames: u32) -> Controls {
        let value = |param: Param| modulation.after(param, frames);
        Controls::new(|param| value(param).unwrap_or_else(|| self.value_after(param, frames)), self.beat_rate)
    }
}

/// The parameters that voices follow, at one instant, in the units that voices use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Controls {
    /// T60 of a held note in seconds.
    pub(crate) decay: f64,
    /// T60 of a released note in seconds.
    pub(crate) release: f64,
    /// Semitones, of `coarse` and `fine` together.
    pub(crate) tune: f64,
    coarse: f32,
    /// Cents.
    fine: f32,
    /// Vibrato depth in semitones: that of the patch, and, in the next field, the depth that routes add.
    pub(crate) vibrato: f64,
    pub(crate) added_vibrato: f64,
    /// Hz.
    pub(crate) vibrato_rate: f64,
    /// Whether the vibrato rate follows the tempo.
    is_synchronised: bool,
    /// How strongly a held note is damped, 0–1.
    pub(crate) damper: f64,
    /// Exponent by which higher modes decay faster.
    pub(crate) decay_tilt: f64,
    /// Semitones by which a full strike raises the pitch.
    pub(crate) tension: f64,
    /// Share of its energy that a band passes on to higher modes, 0–1, and the time of this rise in seconds.
    pub(crate) bloom: f64,
    pub(crate) bloom_time: f64,
    /// How firmly the body is touched, 0–1, and where, as a fraction of its length.
    pub(crate) touch: f64,
    pub(crate) touch_position: f64,
    /// Semitones.
    pub(crate) bend_range: f32,
    /// Speed of the bow, at least 0, and the pressure of the bow, 0–1.
    pub(crate) bow_speed: f32,
    pub(crate) bow_force: f32,
    /// Amplitude ratio of the incoming sound.
    pub(crate) input_gain: f32,
    /// Amplitude ratio.
    pub(crate) gain_left: f32,
    /// Amplitude ratio.
    pub(crate) gain_right: f32,
    /// The values that the gains are computed from: decibels, and pan in per cent from −100 (left) to 100 (right).
    gain_db: f32,
    pan: f32,
}

impl Controls {
    fn new(value: impl Fn(Param) -> f32, beat_rate: f64) -> Self {
        let (coarse, fine) = (value(Param::Tune), value(Param::Fine));
        let (gain_db, pan) = (value(Param::Gain), value(Param::Pan));
        let (gain_left, gain_right) = gains(gain_db, pan);
        let sync = NoteValue::from_value(value(Param::VibratoSync));
        Self {
            decay: value(Param::Decay).into(),
            release: value(Param::Release).into(),
            tune: semitones(coarse, fine),
            coarse,
            fine,
            vibrato: f64::from(value(Param::Vibrato)) * 0.01,
            added_vibrato: 0.0,
            vibrato_rate: rate_at(sync, value(Param::VibratoRate).into(), beat_rate),
            is_synchronised: sync != NoteValue::Off,
            damper: f64::from(value(Param::Damper)) * 0.01,
            decay_tilt: value(Param::DecayTilt).into(),
            tension: value(Param::Tension).into(),
            bloom: f64::from(value(Param::Bloom)) * 0.01,
            bloom_time: value(Param::BloomTime).into(),
            touch: f64::from(value(Param::Touch)) * 0.01,
            touch_position: f64::from(value(Param::TouchPosition)) * 0.01,
            bend_range: value(Param::BendRange),
            bow_speed: exciter_gain(value(Param::BowLevel).into()) as f32,
            bow_force: value(Param::BowForce) * 0.01,
            input_gain: exciter_gain(value(Param::InputLevel).into()) as f32,
            gain_left,
            gain_right,
            gain_db,
            pan,
        }
    }

    /// Sets the modulated value of one parameter. Ignores parameters that are not part of the controls.
    /// [`Controls::find_gains`] must follow, since the gains depend on level and pan together.
    pub(crate) fn set(&mut self, param: Param, value: f32) {
        let wide = f64::from(value);
        match param {
            Param::Decay => self.decay = wide,
            Param::Release => self.release = wide,
            Param::Tune | Param::Fine => {
                *(if param == Param::Tune { &mut self.coarse } else { &mut self.fine }) = value;
                self.tune = semitones(self.coarse, self.fine);
            }
            Param::Vibrato => self.added_vibrato = wide * 0.01 - self.vibrato,
            Param::VibratoRate if !self.is_synchronised => self.vibrato_rate = wide,
            Param::Damper => self.damper = wide * 0.01,
            Param::DecayTilt => self.decay_tilt = wide,
            Param::Tension => self.tension = wide,
            Param::Bloom => self.bloom = wide * 0.01,
            Param::BloomTime => self.bloom_time = wide,
            Param::Touch => self.touch = wide * 0.01,
            Param::TouchPosition => self.touch_position = wide * 0.01,
            Param::BendRange => self.bend_range = value,
            Param::BowLevel => self.bow_speed = exciter_gain(wide) as f32,
            Param::BowForce => self.bow_force = value * 0.01,
            Param::InputLevel => self.input_gain = exciter_gain(wide) as f32,
            Param::Gain => self.gain_db = value,
            Param::Pan => self.pan = value,
            _ => {}
        }
    }

    /// Computes the gains if level or pan differ from those `before`. If `base` has the same level and pan, its gains are
    /// copied, since they are more exact.
    pub(crate) fn find_gains(&mut self, before: [f32; 2], base: Option<&Self>) {
        let now = self.level_and_pan();
        if now == before {
            return;
        }
        if let Some(base) = base.filter(|base| base.level_and_pan() == now) {
            (self.gain_left, self.gain_right) = (base.gain_left, base.gain_right);
        } else {
            let (left, right) = pan_gains(self.pan * 0.005 + 0.5);
            let gain = power_of_two(self.gain_db * DOUBLINGS_PER_DB);
            (self.gain_left, self.gain_right) = (gain * left, gain * right);
        }
    }

    /// The two values that the gains are computed from.
    pub(crate) fn level_and_pan(&self) -> [f32; 2] {
        [self.gain_db, self.pan]
    }
}

/// Powers of two per decibel: log₂ 10 / 20.
const DOUBLINGS_PER_DB: f32 = std::f32::consts::LOG2_10 / 20.0;

fn semitones(coarse: f32, fine: f32) -> f64 {
    f64::from(coarse) + f64::from(fine) * 0.01
}

fn gains(gain_db: f32, pan: f32) -> (f32, f32) {
    let gain = gain_from_db(gain_db.into()) as f32;
    let (left, right) = pan_gains(pan * 0.005 + 0.5);
    (gain * left, gain * right)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_parameter_arrives_after_its_time_and_no_sooner() {
        let mut smoother = Smoother::new(48_000.0, &Values::default(), 2.0);
        smoother.set(Param::Decay, 2.0);
        assert_eq!(smoother.after(0).decay, 1.0);
        assert!((smoother.after(480).decay - 1.5).abs() < 1e-6);
        smoother.advance(480);
        smoother.set(Param::Decay, 2.0);
        assert_eq!(smoother.after(480).decay, 2.0, "setting the same target again does not start anew");
    }

    #[test]
    fn the_default_sound_is_centred_and_untuned() {
        let mut values = Values::default();
        values.set(Param::Gain, 0.0);
        let controls = Smoother::new(48_000.0, &values, 2.0).after(0);
        assert_eq!((controls.gain_left, controls.gain_right, controls.tune), (1.0, 1.0, 0.0));
    }

    #[test]
    fn a_synchronised_vibrato_follows_the_tempo() {
        let mut smoother = Smoother::new(48_000.0, &Values::default(), 2.0);
        for (choice, rate) in [("off", 5.0), ("1/1", 0.5), ("1/4", 2.0), ("1/8T", 6.0), ("1/4.", 4.0 / 3.0)] {
            smoother.set(Param::VibratoSync, Param::VibratoSync.info().parse(choice).unwrap());
            assert!((smoother.after(0).vibrato_rate - rate).abs() < 1e-12, "{choice}");
        }
        smoother.set_tempo(1.0);
        assert!((smoother.after(0).vibrato_rate - 2.0 / 3.0).abs() < 1e-12);
    }
}
