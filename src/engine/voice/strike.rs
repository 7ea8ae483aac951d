//! What a note makes of its patch: how its modes are tuned, damped and moved.

use super::SynthVoice;
use super::key_tracking::KeyTracking;
use crate::dsp::mode_bank::ExcitationGains;
use crate::dsp::pitch::{Glide, SweepEnvelope};
use crate::dsp::random;
use crate::engine::controls::Controls;
use crate::engine::damping::Damping;
use crate::engine::instrument::Instrument;
use crate::engine::modulation::Struck;
use crate::engine::note::Note;
use crate::params::Param;
use crate::units::gain_from_db;
use libm::{fabs, pow, sin};
use std::f64::consts::{LOG2_10, PI};

/// The soft pedal takes this share of the force …
const SOFT_FORCE: f64 = 0.6;
/// … and this much of the hardness.
const SOFT_HARDNESS: f64 = 0.3;

/// Contact times of the softest and the hardest mallet, in seconds.
const SOFTEST_CONTACT: f64 = 0.01;
const HARDEST_CONTACT: f64 = 0.000_05;

/// The brightest notes are tilted by this much more than the patch says, in decibels per octave; the dullest by as
/// much less, and their higher modes ring shorter by their ratio.
const BRIGHTNESS_TILT: f64 = 12.0;

/// Values of [`Param::Exciter`].
const IMPULSE: u32 = 0;
const PLUCK: u32 = 2;
const NOISE: u32 = 3;

impl SynthVoice {
    /// The value that a parameter has for this strike.
    pub(super) fn value(&self, instrument: &Instrument, param: Param) -> f64 {
        self.modulators.struck_value(param, |param| instrument.modulated.get(param)).into()
    }

    /// The value of a parameter that is in per cent, as a share of 1.
    fn share(&self, instrument: &Instrument, param: Param) -> f64 {
        self.value(instrument, param) * 0.01
    }

    /// Tells the modulators of a strike, the `first` of the voice or a later one.
    pub(super) fn strike_modulators(&mut self, instrument: &Instrument, note: &Note, first: bool) {
        let (pitch, seed, serial) = (instrument.pitch(note), instrument.seed, note.serial);
        let struck = Struck { velocity: note.velocity, pitch, seed, serial };
        let Instrument { positions, settings, shared, modulated, .. } = instrument;
        self.modulators.strike(&struck, positions, settings, shared, |param| modulated.get(param), first);
    }

    /// Computes each mode's excitation gains. Returns whether noise is among them.
    pub(super) fn set_excitation_gains(&mut self, instrument: &Instrument) -> bool {
        let value = |param| self.value(instrument, param);
        let modes = instrument.sound.patch().modes.as_slice();
        let tilt = (value(Param::Tilt) + self.brightness * (2.0 * BRIGHTNESS_TILT)) / (20.0 / LOG2_10);
        let (noise_gain, position) = (gain_from_db(value(Param::NoiseLevel)), value(Param::Position));
        let tilted = |mode: &crate::patch::Mode| f64::from(mode.level) * pow(f64::from(mode.ratio), tilt);
        let plain: f64 = modes.iter().map(|mode| fabs(mode.level.into())).sum();
        let total: f64 = modes.iter().map(|mode| fabs(tilted(mode))).sum();
        let balance = if tilt != 0.0 && total > 0.0 { plain / total } else { 1.0 };

        let exciter = instrument.modulated.get(Param::Exciter) as u32;
        // Energy is what a strike of force 1 brings: the sum of the squared levels.
        let (mut noisy, mut energy) = (false, 0.0);
        for (m, mode) in modes.iter().enumerate() {
            let level = tilted(mode) * balance;
            let struck = if exciter == NOISE { 0.0 } else { level * f64::from(mode.strike) };
            let noise = if exciter == NOISE { level } else { level * (1.0 - f64::from(mode.strike)) } * noise_gain;
            let plucked = struck * sin(PI * position * 0.01 * f64::from(mode.ratio));
            let (push, pull) = if exciter == PLUCK { (0.0, plucked) } else { (struck, 0.0) };
            let gains = ExcitationGains { push: push as f32, pull: pull as f32, noise: noise as f32 };
            self.bank.set_excitation_gains(m, gains);
            noisy |= noise != 0.0;
            energy += push * push + pull * pull + noise * noise;
        }
        self.pending_energy += self.squared_force * (energy - self.unit_energy);
        self.unit_energy = energy;
        noisy
    }

    /// Reads what the patch says of a strike, and strikes.
    pub(super) fn excite(&mut self, instrument: &Instrument, note: &Note) {
        let velocity = f64::from(note.velocity);
        let soft = if note.soft { SOFT_FORCE } else { 1.0 };
        // The strike before has brought its energy: this one's is counted below.
        self.squared_force = 0.0;
        let noisy = self.set_excitation_gains(instrument);
        let exciter = instrument.modulated.get(Param::Exciter) as u32;

        let force = pow(velocity, 2.0 * self.share(instrument, Param::Velocity)) * soft;
        let hardness = self.share(instrument, Param::Hardness)
            * (1.0 - self.share(instrument, Param::HardnessVelocity) * (1.0 - velocity));
        let hardness = if note.soft { hardness * (1.0 - SOFT_HARDNESS) } else { hardness };
        let contact = SOFTEST_CONTACT * pow(HARDEST_CONTACT / SOFTEST_CONTACT, hardness);
        let frames = |seconds: f64| (seconds * self.sample_rate + 0.5) as u32;
        let pulse_frames = if exciter == IMPULSE { 1 } else { frames(contact) };
        let noise_force = if noisy { force as f32 } else { 0.0 };
        let noise_frames = frames(self.value(instrument, Param::NoiseTime));
        let key = random::key(instrument.seed, note.serial);
        self.exciter.strike(force as f32, pulse_frames, noise_force, noise_frames, key);
        self.squared_force = force * force;
        self.pending_energy += self.squared_force * self.unit_energy;
        self.end = None;

        let depth = self.value(instrument, Param::Sweep)
            * (1.0 - self.share(instrument, Param::SweepVelocity) * (1.0 - velocity));
        self.sweep = SweepEnvelope::new(
            depth,
            self.value(instrument, Param::SweepTime),
            self.share(instrument, Param::SweepCurve),
        );
        self.vibrato_delay = self.value(instrument, Param::VibratoDelay);
        self.rings_on = instrument.modulated.get(Param::NoteOff) != 0.0;
        self.release_velocity = self.share(instrument, Param::ReleaseVelocity);
    }

    /// Reads what the patch says of the body: the ratios and T60s of its modes, and how they follow the key.
    pub(super) fn read_body(&mut self, instrument: &Instrument) {
        self.key_tracking = KeyTracking::new(|param| self.value(instrument, param));
        let stretch = self.value(instrument, Param::Stretch);
        for (ratio, mode) in self.ratios.iter_mut().zip(instrument.sound.patch().modes.as_slice()) {
            *ratio = if stretch == 1.0 { mode.ratio.into() } else { pow(mode.ratio.into(), stretch) };
        }
        self.scale_decay(instrument);
    }

    /// Takes the pitch and decay of `note`; returns the frequency of a mode of ratio 1.
    pub(super) fn place(&mut self, note: &Note, controls: Controls) -> f64 {
        (self.pitch, self.tune) = (self.key_tracking.pitch(note), controls.tune);
        self.key_scale = self.key_tracking.decay_scale(self.pitch);
        self.damping = Damping { decay: controls.decay * self.key_scale, release: 0.0, amount: 0.0 };
        self.released = false;
        self.key_tracking.frequency(self.pitch + self.tune)
    }

    /// Each mode's T60 as a multiple of the decay: the higher, the shorter; dull notes lose their high modes sooner.
    pub(super) fn scale_decay(&mut self, instrument: &Instrument) {
        let tilt = -self.value(instrument, Param::DecayTilt);
        let dullness = 2.0 * self.brightness.min(0.0);
        for (scale, mode) in self.t60_scale.iter_mut().zip(instrument.sound.patch().modes.as_slice()) {
            *scale = f64::from(mode.decay) * pow(mode.ratio.into(), tilt);
            if dullness < 0.0 && mode.ratio > 1.0 {
                *scale *= pow(mode.ratio.into(), dullness);
            }
        }
    }

    /// Frequency and T60 of each mode, after [`SynthVoice::place`].
    pub(super) fn tuning(&self, frequency: f64) -> impl Iterator<Item = (f64, f64)> + use<> {
        let damping = self.damping;
        let modes = self.ratios.into_iter().zip(self.t60_scale);
        modes.map(move |(ratio, scale)| (frequency * ratio, damping.t60(scale)))
    }

    /// The note that the voice had hands over to `note`, which is told what it is told anew. A gain that the last one
    /// was told fades to this one's.
    fn take_over(&mut self, note: &Note) {
        // A MIDI controller that has not let go of the key still presses it.
        let pressure = if note.key == self.key && note.id == -1 { self.expressions.pressure } else { 0.0 };
        self.expressions.begin(note.gain, note.pan);
        self.expressions.pressure = pressure;
        self.modulation.let_go();
        self.key = note.key;
        self.brightness = note.brightness.into();
    }

    /// Makes the sounding voice that of `note`, sliding from where its pitch is. Without an instrument, the voice goes
    /// by what it has read of its own.
    pub(super) fn aim(&mut self, instrument: Option<&Instrument>, note: &Note) {
        let from = self.pitch + self.glide.at(self.seconds(self.age - self.glide_start));
        self.take_over(note);
        self.end = None;
        if let Some(instrument) = instrument {
            self.follow(instrument);
            self.read_body(instrument);
        }
        let controls = instrument.map_or(self.controls, |instrument| instrument.controls);
        let frequency = self.place(note, controls);
        self.modulators.set_pitch(self.pitch);
        self.glide = Glide::new(from - self.pitch, 0.0, self.key_tracking.glide_seconds);
        self.glide_start = self.age;
        let tuning = self.tuning(frequency);
        self.bank.retune(tuning);
    }
}
