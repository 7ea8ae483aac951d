//! How long the modes of a note ring: their decay, how it follows the key, and the damper.

use super::instrument::StruckValues;
use super::key_tracking::MIDDLE_C;
use crate::dsp::bank::Bank;
use crate::dsp::mode_bank::MAX_MODES;
use crate::engine::controls::Controls;
use crate::engine::damping::Damping;
use crate::params::Param;
use crate::units::ratio_from_semitones;
use libm::pow;

/// The decay of a voice. Real-time safe.
pub(super) struct Decay {
    /// Octaves of T60 per octave of pitch, and what that makes of the note's.
    per_octave: f64,
    key_scale: f64,
    /// T60 of each mode as a multiple of the decay.
    pub(super) t60_scale: [f64; MAX_MODES],
    damping: Damping,
    /// The T60s of the modes are to be set at the next control, whether or not `damping` changes.
    changed: bool,
    /// A release changes nothing.
    rings_on: bool,
    released: bool,
    /// How far release velocity changes the release time, in octaves each way, and what it has made of it.
    release_velocity: f64,
    release_scale: f64,
}

impl Decay {
    /// Of a voice that has had no note.
    pub(super) fn new() -> Self {
        Self {
            per_octave: 0.0,
            key_scale: 1.0,
            t60_scale: [1.0; MAX_MODES],
            damping: Damping { decay: 1.0, release: 1.0, amount: 0.0 },
            changed: false,
            rings_on: false,
            released: false,
            release_velocity: 0.0,
            release_scale: 1.0,
        }
    }

    /// Reads how the patch's modes ring and follow the key.
    pub(super) fn read(&mut self, values: &StruckValues, brightness: f64) {
        self.per_octave = values.share(Param::DecayKey);
        self.read_scale(values, brightness);
    }

    /// Each mode's T60 as a multiple of the decay: the higher, the shorter; dull notes lose their high modes sooner.
    fn read_scale(&mut self, values: &StruckValues, brightness: f64) {
        let tilt = -values.get(Param::DecayTilt);
        let dullness = 2.0 * brightness.min(0.0);
        for (scale, mode) in self.t60_scale.iter_mut().zip(values.instrument.modulated.modes.as_slice()) {
            *scale = f64::from(mode.decay) * pow(mode.ratio.into(), tilt);
            if dullness < 0.0 && mode.ratio > 1.0 {
                *scale *= pow(mode.ratio.into(), dullness);
            }
        }
    }

    /// Takes over another brightness at the next control.
    pub(super) fn shade(&mut self, values: &StruckValues, brightness: f64) {
        self.read_scale(values, brightness);
        self.changed = true;
    }

    /// Takes the decay of a note at a pitch in semitones, with its key down.
    pub(super) fn place(&mut self, pitch: f64, controls: &Controls) {
        self.key_scale = ratio_from_semitones(self.per_octave * (MIDDLE_C - pitch));
        self.damping = Damping { decay: controls.decay * self.key_scale, release: 0.0, amount: 0.0 };
        self.released = false;
    }

    /// The first note of a voice starts, after [`Decay::place`].
    pub(super) fn start(&mut self) {
        (self.changed, self.release_scale) = (false, 1.0);
    }

    /// Reads what a strike says of the release.
    pub(super) fn strike(&mut self, values: &StruckValues) {
        self.rings_on = values.instrument.modulated.get(Param::NoteOff) != 0.0;
        self.release_velocity = values.share(Param::ReleaseVelocity);
    }

    /// The key comes up, with a velocity 0–1.
    pub(super) fn release(&mut self, velocity: f32) {
        if !self.rings_on {
            self.released = true;
            self.release_scale = pow(2.0, self.release_velocity * (1.0 - 2.0 * f64::from(velocity)));
        }
    }

    /// T60 in seconds of each mode.
    pub(super) fn t60s(&self) -> impl Iterator<Item = f64> + '_ {
        self.t60_scale.iter().map(|scale| self.damping.t60(*scale))
    }

    /// Sets the T60s of the bank if they have changed. Returns whether they have.
    pub(super) fn control(&mut self, controls: &Controls, pressure: f64, bank: &mut Bank) -> bool {
        let amount = if self.released { 1.0 } else { controls.pressure_damping * pressure };
        let damping = Damping {
            decay: controls.decay * self.key_scale,
            release: if amount == 0.0 { 0.0 } else { controls.release * self.release_scale },
            amount,
        };
        let changes = damping != self.damping || std::mem::take(&mut self.changed);
        if changes {
            self.damping = damping;
            self.t60s().take(bank.len()).enumerate().for_each(|(m, t60)| bank.set_t60(m, t60));
        }
        changes
    }
}
