//! The strikes of a voice: how hard they are, and how strongly each mode is moved by them.

use super::values::StruckValues;
use crate::dsp::cells::Cells;
use crate::dsp::exciter::{self, Drive};
use crate::dsp::mode_bank::ExcitationGains;
use crate::dsp::random;
use crate::engine::note::Note;
use crate::engine::voice_manager::Unison;
use crate::params::{Exciter, Param};
use crate::patch::Mode;
use crate::units::gain_from_db;
use libm::{fabs, pow, sin, sqrt};
use std::f64::consts::{LOG2_10, PI};

/// The soft pedal takes this share of the force …
const SOFT_FORCE: f64 = 0.6;
/// … and this much of the hardness.
const SOFT_HARDNESS: f64 = 0.3;

/// Contact times of the softest and the hardest mallet, in seconds.
const SOFTEST_CONTACT: f64 = 0.01;
const HARDEST_CONTACT: f64 = 0.000_05;

/// The stream of random phases, beside that of a voice's noise.
const PHASE_STREAM: u64 = 0x55_4e49_534f_4e00;

/// What moves the modes of a voice. Real-time safe.
pub(super) struct Strike {
    exciter: exciter::Exciter,
    drive: Drive,
    /// Squared force of the last strike, and the energy that one of force 1 brings: the sum of the squared gains.
    squared_force: f64,
    unit_energy: f64,
    /// Whether noise is among what moves the modes.
    is_noisy: bool,
    /// Radians by which the strike of a unison voice is turned ahead.
    phase: f32,
}

impl Strike {
    /// None yet.
    pub(super) fn new() -> Self {
        Self {
            exciter: exciter::Exciter::REST,
            drive: Drive::NONE,
            squared_force: 0.0,
            unit_energy: 0.0,
            is_noisy: false,
            phase: 0.0,
        }
    }

    /// Forgets the strikes of the note before.
    pub(super) fn start(&mut self) {
        self.exciter = exciter::Exciter::REST;
        (self.squared_force, self.unit_energy, self.phase) = (0.0, 0.0, 0.0);
    }

    /// Whether any force is still to come.
    pub(super) fn is_active(&self) -> bool {
        self.exciter.is_active()
    }

    /// Frames until it is not.
    pub(super) fn frames_left(&self) -> u32 {
        self.exciter.frames_left()
    }

    /// The force of the next frames, if there is any.
    pub(super) fn drive(&mut self, frames: usize) -> Option<&Drive> {
        self.exciter.is_active().then(|| {
            self.exciter.fill(frames, &mut self.drive);
            &self.drive
        })
    }

    /// Computes each mode's excitation gains. Returns how much more energy the last strike brings for that.
    pub(super) fn set_gains(&mut self, values: &StruckValues, bank: &mut Cells) -> f64 {
        let modes = values.instrument.sound.patch().modes.as_slice();
        let tilt = values.get(Param::Tilt) / (20.0 / LOG2_10);
        let (noise_gain, position) = (gain_from_db(values.get(Param::NoiseLevel)), values.get(Param::Position));
        let tilted = |mode: &Mode| {
            let tilt = if tilt == 0.0 { 1.0 } else { pow(f64::from(mode.ratio), tilt) };
            f64::from(mode.level) * tilt
        };
        let mut balance = 1.0;
        if tilt != 0.0 {
            let plain: f64 = modes.iter().map(|mode| fabs(mode.level.into())).sum();
            let total: f64 = modes.iter().map(|mode| fabs(tilted(mode))).sum();
            balance = if total > 0.0 { plain / total } else { 1.0 };
        }

        let exciter = values.instrument.modulated.choice::<Exciter>(Param::Exciter);
        let (mut noisy, mut energy) = (false, 0.0);
        for (m, mode) in modes.iter().enumerate() {
            let level = tilted(mode) * balance;
            let struck = if exciter == Exciter::Noise { 0.0 } else { level * f64::from(mode.strike) };
            let noise =
                if exciter == Exciter::Noise { level } else { level * (1.0 - f64::from(mode.strike)) } * noise_gain;
            let (push, pull) = match exciter {
                Exciter::Pluck => (0.0, struck * sin(PI * position * 0.01 * f64::from(mode.ratio))),
                _ => (struck, 0.0),
            };
            let gains =
                ExcitationGains { push: push as f32, pull: pull as f32, noise: noise as f32, phase: self.phase };
            bank.set_excitation_gains(m, gains);
            noisy |= noise != 0.0;
            energy += push * push + pull * pull + noise * noise;
        }
        let more = self.squared_force * (energy - self.unit_energy);
        (self.unit_energy, self.is_noisy) = (energy, noisy);
        more
    }

    /// Reads what the patch says of a strike, and strikes. Returns the energy that it brings.
    pub(super) fn strike(&mut self, values: &StruckValues, note: &Note, unison: Unison, bank: &mut Cells) -> f64 {
        // The strike before has brought its energy: this one's is counted below.
        self.squared_force = 0.0;
        // Each unison voice has a phase and noise of its own; together they have the energy of one.
        let (Unison { index, count }, key) = (unison, random::key(values.instrument.seed, note.serial));
        let key = if index == 0 { key } else { random::key(key, index as u64) };
        if count > 1 {
            let phase = random::uniform(random::key(key, PHASE_STREAM), 0);
            self.phase = (PI * values.share(Param::UnisonPhase)) as f32 * phase;
        }
        self.set_gains(values, bank);

        let velocity = f64::from(note.velocity);
        let soft = if note.soft { SOFT_FORCE } else { 1.0 };
        let force = pow(velocity, 2.0 * values.share(Param::Velocity)) * soft / sqrt(count as f64);
        let hardness = values.share(Param::Hardness);
        let hardness = if note.soft { hardness * (1.0 - SOFT_HARDNESS) } else { hardness };
        let contact = SOFTEST_CONTACT * pow(HARDEST_CONTACT / SOFTEST_CONTACT, hardness);
        let frames = |seconds: f64| (seconds * values.instrument.sample_rate + 0.5) as u32;
        let is_impulse = values.instrument.modulated.choice::<Exciter>(Param::Exciter) == Exciter::Impulse;
        let pulse_frames = if is_impulse { 1 } else { frames(contact) };
        let noise_force = if self.is_noisy { force as f32 } else { 0.0 };
        let noise_frames = frames(values.get(Param::NoiseTime));
        self.exciter.strike(force as f32, pulse_frames, noise_force, noise_frames, key);
        self.squared_force = force * force;
        self.squared_force * self.unit_energy
    }
}
