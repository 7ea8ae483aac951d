//! The parameter values that sounding voices follow.

use super::gain::{exciter_gain, pan_gains};
use super::modulation::rate_at;
use crate::dsp::power_of_two;
use crate::params::{Choice, NoteValue, Param};
use crate::units::gain_from_db;

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
    /// How much softer higher modes are heard, in decibels per octave.
    pub(crate) colour: f64,
    /// How far modes wander by themselves: decibels, cents, and how often a second.
    pub(crate) drift_level: f64,
    pub(crate) drift_pitch: f64,
    pub(crate) drift_rate: f64,
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
    /// Pressure of the breath, 1 closes a reed; opening of the valve or the jet, 0–1; semitones of its tension; turbulence, 0–1;
    /// steepening in decibels per octave for each halving of the pressure.
    pub(crate) breath_pressure: f32,
    pub(crate) breath_opening: f64,
    pub(crate) breath_lip: f64,
    pub(crate) breath_noise: f32,
    pub(crate) breath_steepening: f64,
    /// Amplitude ratio of the noise that is held.
    pub(crate) noise_gain: f32,
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
    /// The controls with parameters from `value`, at a tempo in beats per second.
    pub(crate) fn new(value: impl Fn(Param) -> f32, beat_rate: f64) -> Self {
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
            colour: value(Param::Colour).into(),
            drift_level: value(Param::DriftLevel).into(),
            drift_pitch: value(Param::DriftPitch).into(),
            drift_rate: value(Param::DriftRate).into(),
            tension: value(Param::Tension).into(),
            bloom: f64::from(value(Param::Bloom)) * 0.01,
            bloom_time: value(Param::BloomTime).into(),
            touch: f64::from(value(Param::Touch)) * 0.01,
            touch_position: f64::from(value(Param::TouchPosition)) * 0.01,
            bend_range: value(Param::BendRange),
            bow_speed: exciter_gain(value(Param::BowLevel).into()) as f32,
            bow_force: value(Param::BowForce) * 0.01,
            breath_pressure: value(Param::BreathPressure) * 0.01,
            breath_opening: f64::from(value(Param::BreathOpening)) * 0.01,
            breath_lip: value(Param::BreathLip).into(),
            breath_noise: value(Param::BreathNoise) * 0.01,
            breath_steepening: value(Param::BreathSteepening).into(),
            noise_gain: exciter_gain(value(Param::NoiseHeld).into()) as f32,
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
            Param::Colour => self.colour = wide,
            Param::DriftLevel => self.drift_level = wide,
            Param::DriftPitch => self.drift_pitch = wide,
            Param::DriftRate => self.drift_rate = wide,
            Param::Tension => self.tension = wide,
            Param::Bloom => self.bloom = wide * 0.01,
            Param::BloomTime => self.bloom_time = wide,
            Param::Touch => self.touch = wide * 0.01,
            Param::TouchPosition => self.touch_position = wide * 0.01,
            Param::BendRange => self.bend_range = value,
            Param::BowLevel => self.bow_speed = exciter_gain(wide) as f32,
            Param::BowForce => self.bow_force = value * 0.01,
            Param::BreathPressure => self.breath_pressure = value * 0.01,
            Param::BreathOpening => self.breath_opening = wide * 0.01,
            Param::BreathLip => self.breath_lip = wide,
            Param::BreathNoise => self.breath_noise = value * 0.01,
            Param::BreathSteepening => self.breath_steepening = wide,
            Param::NoiseHeld => self.noise_gain = exciter_gain(wide) as f32,
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
    fn the_default_sound_is_centred_and_untuned() {
        let value = |param: Param| if param == Param::Gain { 0.0 } else { param.info().default };
        let controls = Controls::new(value, 2.0);
        assert_eq!((controls.gain_left, controls.gain_right, controls.tune), (1.0, 1.0, 0.0));
    }

    #[test]
    fn a_synchronised_vibrato_follows_the_tempo() {
        for (choice, beat_rate, rate) in [
            ("off", 2.0, 5.0),
            ("1/1", 2.0, 0.5),
            ("1/4", 2.0, 2.0),
            ("1/8T", 2.0, 6.0),
            ("1/4.", 2.0, 4.0 / 3.0),
            ("1/4.", 1.0, 2.0 / 3.0),
        ] {
            let sync = Param::VibratoSync.info().parse(choice).unwrap();
            let value = |param: Param| if param == Param::VibratoSync { sync } else { param.info().default };
            assert!((Controls::new(value, beat_rate).vibrato_rate - rate).abs() < 1e-12, "{choice}");
        }
    }
}
