//! One note: an exciter, a bank of modes, and what moves their pitch, decay and gain.

use super::channel::Channel;
use super::controls::Controls;
use super::voice_manager::{Note, Voice};
use crate::dsp::CONTROL_FRAMES;
use crate::dsp::exciter::{Drive, Exciter};
use crate::dsp::mode_bank::{Coupling, Law, MAX_MODES, ModeBank, ModeSetup};
use crate::dsp::pitch::{Glide, SweepEnvelope};
use crate::dsp::random;
use crate::params::Param;
use crate::patch::Patch;
use crate::units::{frequency_from_key, gain_from_db, ratio_from_semitones};
use libm::{fabs, pow, sin};
use std::f64::consts::{LOG2_10, PI, TAU};

/// What a voice reads of the instrument when a note starts.
pub(crate) struct Instrument {
    pub(crate) patch: Patch,
    pub(crate) sample_rate: f64,
    pub(crate) seed: u64,
    /// Live parameters at this frame.
    pub(crate) controls: Controls,
    /// Pitch of the note before, in semitones, to glide from.
    pub(crate) last_pitch: Option<f64>,
}

impl Instrument {
    fn value(&self, param: Param) -> f64 {
        self.patch.get(param).into()
    }

    /// The pitch of a note in semitones on the MIDI scale, tracking included.
    pub(crate) fn pitch(&self, note: &Note) -> f64 {
        MIDDLE_C + (f64::from(note.key) + f64::from(note.detune) - MIDDLE_C) * self.value(Param::KeyTrack) * 0.01
    }
}

const MIDDLE_C: f64 = 60.0;

/// A voice is over when its modes could not add up to more than this: −120 dBFS.
const SILENCE: f64 = 1e-6;

/// The time in which a stolen or choked voice is faded out.
const FADE_SECONDS: f64 = 0.012;

/// The soft pedal takes this share of the force …
const SOFT_FORCE: f64 = 0.6;
/// … and this much of the hardness.
const SOFT_HARDNESS: f64 = 0.3;

/// Contact times of the softest and the hardest mallet, in seconds.
const SOFTEST_CONTACT: f64 = 0.01;
const HARDEST_CONTACT: f64 = 0.000_05;

/// T60 below which a mode is a click whatever its pitch.
const SHORTEST_T60: f64 = 0.000_5;

/// How the note is damped.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Damping {
    /// T60 of a held note of ratio 1, in seconds.
    decay: f64,
    /// T60 of a damped mode, in seconds; 0 where `amount` is.
    release: f64,
    /// How far it is damped, 0–1.
    amount: f64,
}

/// A sounding note.
pub(crate) struct SynthVoice {
    sample_rate: f64,
    pub(super) bank: ModeBank,
    exciter: Exciter,
    drive: Drive,
    /// T60 of each mode as a multiple of the decay.
    t60_scale: [f64; MAX_MODES],
    /// Sum of the squared levels: the energy that a strike of force 1 brings.
    full_energy: f64,
    /// Energy that the exciter has still to bring, and that of the bank at the last tick.
    pending_energy: f64,
    energy: f64,

    /// Frames since the (last) strike, at the last control and now.
    controlled_age: u64,
    age: u64,
    pitch: f64,
    tune: f64,
    glide: Glide,
    glide_start: u64,
    sweep: SweepEnvelope,
    vibrato_phase: f64,
    vibrato_delay: f64,

    controls: Controls,
    patch: u32,
    decay_key: f64,
    key_scale: f64,
    rings_on: bool,
    released: bool,
    release_scale: f64,
    release_velocity: f64,
    /// Pressure on this key, 0–1.
    pub(crate) pressure: f32,
    damping: Damping,

    gain: [f32; 2],
    gain_step: [f32; 2],
    /// Pitch and gain are taken as they are at the first control, not slid to.
    fresh: bool,
    fade_frames: u32,
    faded: u32,
}

impl SynthVoice {
    /// A voice at rest.
    pub(crate) fn new(sample_rate: f64, controls: Controls) -> Self {
        Self {
            sample_rate,
            bank: ModeBank::new(sample_rate),
            exciter: Exciter::REST,
            drive: Drive::NONE,
            t60_scale: [1.0; MAX_MODES],
            full_energy: 0.0,
            pending_energy: 0.0,
            energy: 0.0,
            controlled_age: 0,
            age: 0,
            pitch: 0.0,
            tune: 0.0,
            glide: Glide::new(0.0, 0.0, 0.0),
            glide_start: 0,
            sweep: SweepEnvelope::new(0.0, 0.0, 0.0),
            vibrato_phase: 0.0,
            vibrato_delay: 0.0,
            controls,
            patch: 0,
            decay_key: 0.0,
            key_scale: 1.0,
            rings_on: false,
            released: false,
            release_scale: 1.0,
            release_velocity: 0.0,
            pressure: 0.0,
            damping: Damping { decay: 1.0, release: 1.0, amount: 0.0 },
            gain: [0.0; 2],
            gain_step: [0.0; 2],
            fresh: true,
            fade_frames: 0,
            faded: 0,
        }
    }

    fn seconds(&self, frames: u64) -> f64 {
        frames as f64 / self.sample_rate
    }

    /// Offset from the pitch that the bank was loaded at, `ahead` frames from now, in semitones.
    fn offset(&self, channel: &Channel, ahead: usize) -> f64 {
        let c = &self.controls;
        let age = self.age + ahead as u64;
        let bend_range = channel.bend_range.unwrap_or(c.bend_range);
        let own =
            c.vibrato * if self.vibrato_delay > 0.0 { (self.seconds(age) / self.vibrato_delay).min(1.0) } else { 1.0 };
        let pressure = f64::from(self.pressure.max(channel.pressure));
        let depth = own + c.wheel_vibrato * f64::from(channel.wheel) + c.pressure_vibrato * pressure;
        let phase = self.vibrato_phase + c.vibrato_rate * self.seconds(ahead as u64);
        let vibrato = if depth > 0.0 { depth * sin(TAU * phase) } else { 0.0 };
        self.glide.at(self.seconds(age - self.glide_start))
            + self.sweep.at(self.seconds(age))
            + (c.tune - self.tune)
            + f64::from(channel.bend) * f64::from(bend_range)
            + f64::from(channel.tuning)
            + vibrato
    }

    /// Sets out for where pitch, decay and gain are to be in `frames` frames: at the next control tick.
    /// `controls` are the instrument's at that time; a voice of an earlier patch keeps the last it had.
    pub(crate) fn control(&mut self, controls: &Controls, patch: u32, channel: &Channel, frames: usize) {
        let passed = self.seconds(self.age - self.controlled_age);
        self.vibrato_phase += self.controls.vibrato_rate * passed;
        self.vibrato_phase -= libm::floor(self.vibrato_phase);
        self.controlled_age = self.age;
        if patch == self.patch {
            self.controls = *controls;
        }

        let pressure = f64::from(self.pressure.max(channel.pressure));
        let amount = if self.released { 1.0 } else { self.controls.pressure_damping * pressure };
        let damping = Damping {
            decay: self.controls.decay * self.key_scale,
            release: if amount == 0.0 { 0.0 } else { self.controls.release * self.release_scale },
            amount,
        };
        if damping != self.damping {
            self.damping = damping;
            for m in 0..self.bank.len() {
                self.bank.set_t60(m, damped_t60(damping, self.t60_scale[m]));
            }
        }
        if self.fresh {
            self.bank.jump_to(ratio_from_semitones(self.offset(channel, 0)));
        }
        self.bank.sweep_to(ratio_from_semitones(self.offset(channel, frames)), frames);

        let (left, right) = channel.gains_after(frames as u32);
        let target = [self.controls.gain_left * left, self.controls.gain_right * right];
        for ((gain, step), target) in self.gain.iter_mut().zip(&mut self.gain_step).zip(target) {
            if self.fresh {
                *gain = target;
            }
            *step = (target - *gain) / frames as f32;
        }
        self.fresh = false;
    }

    /// Takes stock at a control tick: what energy is left, and which modes have come to rest.
    pub(crate) fn settle(&mut self) {
        self.energy = self.bank.settle();
        if !self.exciter.is_active() {
            self.pending_energy = 0.0;
        }
    }

    /// Adds the next frames, at most [`CONTROL_FRAMES`], to `left` and `right`.
    pub(crate) fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        let frames = left.len();
        let (mut bank_left, mut bank_right) = ([0.0; CONTROL_FRAMES], [0.0; CONTROL_FRAMES]);
        let (bank_left, bank_right) = (&mut bank_left[..frames], &mut bank_right[..frames]);
        if self.exciter.is_active() {
            self.exciter.fill(frames, &mut self.drive);
            self.bank.render(Some(&self.drive), bank_left, bank_right);
        } else {
            self.bank.render(None, bank_left, bank_right);
        }
        self.age += frames as u64;
        for i in 0..frames {
            for side in 0..2 {
                self.gain[side] += self.gain_step[side];
            }
            let fade = self.next_fade();
            left[i] += bank_left[i] * (self.gain[0] * fade);
            right[i] += bank_right[i] * (self.gain[1] * fade);
        }
    }

    /// Gain of the fade that ends a stolen or choked voice: an S-curve, so that neither end has a corner.
    fn next_fade(&mut self) -> f32 {
        if self.fade_frames == 0 {
            return 1.0;
        }
        self.faded = (self.faded + 1).min(self.fade_frames);
        let u = self.faded as f32 / self.fade_frames as f32;
        1.0 - u * u * (3.0 - 2.0 * u)
    }

    /// Reads what the patch says of a strike, and strikes.
    fn excite(&mut self, instrument: &Instrument, note: &Note) {
        let value = |param| instrument.value(param);
        let velocity = f64::from(note.velocity);
        let percent = |param| value(param) * 0.01;
        let soft = if note.soft { SOFT_FORCE } else { 1.0 };

        let modes = instrument.patch.modes.as_slice();
        let tilt = value(Param::Tilt) / (20.0 / LOG2_10);
        let tilted = |mode: &crate::patch::Mode| f64::from(mode.level) * pow(f64::from(mode.ratio), tilt);
        let plain: f64 = modes.iter().map(|mode| fabs(mode.level.into())).sum();
        let total: f64 = modes.iter().map(|mode| fabs(tilted(mode))).sum();
        let balance = if tilt != 0.0 && total > 0.0 { plain / total } else { 1.0 };

        let exciter = instrument.patch.get(Param::Exciter) as u32;
        let noise_gain = gain_from_db(value(Param::NoiseLevel));
        let (mut noisy, mut energy) = (false, 0.0);
        for (m, mode) in modes.iter().enumerate() {
            let level = tilted(mode) * balance;
            let struck = if exciter == NOISE { 0.0 } else { level * f64::from(mode.strike) };
            let noise = if exciter == NOISE { level } else { level * (1.0 - f64::from(mode.strike)) } * noise_gain;
            let plucked = struck * sin(PI * percent(Param::Position) * f64::from(mode.ratio));
            let (push, pull) = if exciter == PLUCK { (0.0, plucked) } else { (struck, 0.0) };
            self.bank.set_coupling(m, Coupling { push: push as f32, pull: pull as f32, noise: noise as f32 });
            noisy |= noise != 0.0;
            energy += push * push + pull * pull + noise * noise;
        }
        self.full_energy = energy;

        let force = pow(velocity, 2.0 * percent(Param::Velocity)) * soft;
        let hardness = percent(Param::Hardness) * (1.0 - percent(Param::HardnessVelocity) * (1.0 - velocity));
        let hardness = if note.soft { hardness * (1.0 - SOFT_HARDNESS) } else { hardness };
        let contact = SOFTEST_CONTACT * pow(HARDEST_CONTACT / SOFTEST_CONTACT, hardness);
        let frames = |seconds: f64| (seconds * self.sample_rate + 0.5) as u32;
        let pulse_frames = if exciter == IMPULSE { 1 } else { frames(contact) };
        let noise_force = if noisy { force as f32 } else { 0.0 };
        let noise_frames = frames(value(Param::NoiseTime));
        let key = random::key(instrument.seed, note.serial);
        self.exciter.strike(force as f32, pulse_frames, noise_force, noise_frames, key);
        self.pending_energy = force * force * self.full_energy;

        let depth = value(Param::Sweep) * (1.0 - percent(Param::SweepVelocity) * (1.0 - velocity));
        self.sweep = SweepEnvelope::new(depth, value(Param::SweepTime), percent(Param::SweepCurve));
        self.vibrato_delay = value(Param::VibratoDelay);
        self.rings_on = instrument.patch.get(Param::NoteOff) != 0.0;
        self.release_velocity = percent(Param::ReleaseVelocity);
    }

    /// Makes the pitch and decay those of `note`, sliding from where the pitch is.
    fn aim(&mut self, instrument: &Instrument, note: &Note) {
        let from = self.glide.at(self.seconds(self.age - self.glide_start));
        self.glide = Glide::new(from, instrument.pitch(note) - self.pitch, instrument.value(Param::Glide));
        self.glide_start = self.age;
        self.key_scale = ratio_from_semitones(self.decay_key * (MIDDLE_C - instrument.pitch(note)));
        self.released = false;
    }
}

/// Values of [`Param::Exciter`].
const IMPULSE: u32 = 0;
const PLUCK: u32 = 2;
const NOISE: u32 = 3;

/// T60 in seconds of a mode whose T60 is `scale` times the decay: between its own and the damper's, by ratio.
fn damped_t60(damping: Damping, scale: f64) -> f64 {
    let held = (damping.decay * scale).max(SHORTEST_T60);
    let damped = held.min(damping.release).max(SHORTEST_T60);
    if damping.amount == 0.0 {
        held
    } else if damping.amount == 1.0 {
        damped
    } else {
        held * pow(damped / held, damping.amount)
    }
}

impl Voice for SynthVoice {
    type Context = Instrument;

    fn start(&mut self, instrument: &Instrument, note: &Note) {
        let value = |param| instrument.value(param);
        let percent = |param| value(param) * 0.01;
        *self = Self { patch: note.patch, ..Self::new(instrument.sample_rate, instrument.controls) };
        self.pitch = instrument.pitch(note);
        self.tune = instrument.controls.tune;
        self.decay_key = percent(Param::DecayKey);
        let from = instrument.last_pitch.unwrap_or(self.pitch) - self.pitch;
        self.glide = Glide::new(from, 0.0, value(Param::Glide));
        self.key_scale = ratio_from_semitones(self.decay_key * (MIDDLE_C - self.pitch));
        self.damping = Damping { decay: instrument.controls.decay * self.key_scale, release: 0.0, amount: 0.0 };

        let law = if instrument.patch.get(Param::Coefficients) == 0.0 { Law::Exact } else { Law::Classic };
        let frequency = frequency_from_key(self.pitch + self.tune, value(Param::Tuning));
        let (stretch, decay_tilt, width) = (value(Param::Stretch), value(Param::DecayTilt), percent(Param::Width));
        let modes = instrument.patch.modes.as_slice();
        for (scale, mode) in self.t60_scale.iter_mut().zip(modes) {
            *scale = f64::from(mode.decay) * pow(mode.ratio.into(), -decay_tilt);
        }
        let (damping, scales) = (self.damping, self.t60_scale);
        let setup = modes.iter().zip(scales).map(|(mode, scale)| {
            let (left, right) = super::channel::pan_gains((f64::from(mode.pan) * width * 0.5 + 0.5) as f32);
            let ratio = if stretch == 1.0 { f64::from(mode.ratio) } else { pow(mode.ratio.into(), stretch) };
            ModeSetup { frequency: frequency * ratio, t60: damped_t60(damping, scale), left, right }
        });
        self.bank.load(law, setup);
        self.excite(instrument, note);
    }

    fn restrike(&mut self, instrument: &Instrument, note: &Note) {
        self.aim(instrument, note);
        self.excite(instrument, note);
        // The age starts again with the sweep; the glide starts now anyway, and the vibrato keeps its phase.
        self.vibrato_phase += self.controls.vibrato_rate * self.seconds(self.age - self.controlled_age);
        (self.age, self.controlled_age, self.glide_start) = (0, 0, 0);
    }

    fn retune(&mut self, instrument: &Instrument, note: &Note) {
        self.aim(instrument, note);
    }

    fn release(&mut self, velocity: f32) {
        if !self.rings_on {
            self.released = true;
            self.release_scale = pow(2.0, self.release_velocity * (1.0 - 2.0 * f64::from(velocity)));
        }
    }

    fn fade(&mut self) {
        self.fade_frames = (FADE_SECONDS * self.sample_rate) as u32;
    }

    fn energy(&self) -> f64 {
        self.energy.max(self.pending_energy)
    }

    fn is_over(&self) -> bool {
        let faded = self.fade_frames > 0 && self.faded >= self.fade_frames;
        // n amplitudes whose squares sum to E add up to √(n E) at most.
        let loudest = self.energy * self.bank.len() as f64;
        let gain = f64::from(self.gain[0].max(self.gain[1])).max(1.0);
        faded || (self.pending_energy == 0.0 && loudest * gain * gain < SILENCE * SILENCE)
    }
}
