//! One note: an exciter, a bank of modes, and what moves their pitch, decay and gain.

use super::channel::Channel;
use super::controls::Controls;
use super::damping::Damping;
use super::fader::Fader;
use super::voice_manager::{Note, Voice};
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

/// Stock is taken of a voice's energy every so many control ticks, and at every tick below −110 dBFS.
const STOCK_TICKS: u32 = 8;
const NEARLY_SILENT: f64 = 3.2e-6;

/// The time in which a stolen or choked voice is faded out.
const FADE_SECONDS: f64 = 0.012;

/// The soft pedal takes this share of the force …
const SOFT_FORCE: f64 = 0.6;
/// … and this much of the hardness.
const SOFT_HARDNESS: f64 = 0.3;

/// Contact times of the softest and the hardest mallet, in seconds.
const SOFTEST_CONTACT: f64 = 0.01;
const HARDEST_CONTACT: f64 = 0.000_05;

/// A sounding note.
pub(crate) struct SynthVoice {
    sample_rate: f64,
    /// Seconds a frame.
    period: f64,
    pub(super) bank: ModeBank,
    exciter: Exciter,
    drive: Drive,
    /// T60 of each mode as a multiple of the decay.
    t60_scale: [f64; MAX_MODES],
    /// Energy that the exciter has still to bring, and that of the bank at the last tick.
    pending_energy: f64,
    energy: f64,
    /// Control ticks until stock is taken of the energy.
    until_stock: u32,

    /// Frames since the (last) strike, at the last control and now.
    controlled_age: u64,
    age: u64,
    pitch: f64,
    tune: f64,
    /// Last offset from the pitch in semitones, and its ratio.
    offset: f64,
    ratio: f64,
    glide: Glide,
    glide_start: u64,
    sweep: SweepEnvelope,
    vibrato_phase: f64,
    vibrato_delay: f64,

    controls: Controls,
    patch: u32,
    key: u8,
    key_scale: f64,
    rings_on: bool,
    released: bool,
    release_scale: f64,
    release_velocity: f64,
    /// Pressure on this key, 0–1.
    pub(crate) pressure: f32,
    damping: Damping,

    fader: Fader,
    /// Pitch and gain are taken as they are at the first control, not slid to.
    fresh: bool,
}

impl SynthVoice {
    /// A voice at rest.
    pub(crate) fn new(sample_rate: f64, controls: Controls) -> Self {
        Self {
            sample_rate,
            period: 1.0 / sample_rate,
            bank: ModeBank::new(sample_rate),
            exciter: Exciter::REST,
            drive: Drive::NONE,
            t60_scale: [1.0; MAX_MODES],
            pending_energy: 0.0,
            energy: 0.0,
            until_stock: 0,
            controlled_age: 0,
            age: 0,
            pitch: 0.0,
            tune: 0.0,
            offset: 0.0,
            ratio: 1.0,
            glide: Glide::new(0.0, 0.0, 0.0),
            glide_start: 0,
            sweep: SweepEnvelope::new(0.0, 0.0, 0.0),
            vibrato_phase: 0.0,
            vibrato_delay: 0.0,
            controls,
            patch: 0,
            key: 0,
            key_scale: 1.0,
            rings_on: false,
            released: false,
            release_scale: 1.0,
            release_velocity: 0.0,
            pressure: 0.0,
            damping: Damping { decay: 1.0, release: 1.0, amount: 0.0 },
            fader: Fader::CLOSED,
            fresh: true,
        }
    }

    fn seconds(&self, frames: u64) -> f64 {
        // A division takes four times as long, and there are a handful a tick.
        frames as f64 * self.period
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
            + f64::from(channel.tuning())
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
                self.bank.set_t60(m, damping.t60(self.t60_scale[m]));
            }
        }
        if self.fresh {
            let ratio = self.ratio(self.offset(channel, 0));
            self.bank.jump_to(ratio);
        }
        self.ratio(self.offset(channel, frames));

        let (left, right) = channel.gains_after(frames as u32);
        let target = [self.controls.gain_left * left, self.controls.gain_right * right];
        if self.fresh {
            self.fader.jump(target);
        } else {
            self.fader.aim(target, frames);
        }
        self.fresh = false;
    }

    /// Sends the modes to the pitch that [`SynthVoice::control`] has found. Apart from it, so that what one voice
    /// waits for is done while others wait: that gains a tenth.
    pub(crate) fn sweep(&mut self, frames: usize) {
        self.bank.sweep_to(self.ratio, frames);
    }

    /// Takes stock at a control tick: what energy is left, and which modes have come to rest. Every few ticks are
    /// enough, until the voice is nearly silent or its strike has just ended.
    pub(crate) fn settle(&mut self) {
        let strike_over = self.pending_energy > 0.0 && !self.exciter.is_active();
        if self.until_stock == 0 || strike_over || self.loudest() < NEARLY_SILENT * NEARLY_SILENT {
            self.energy = self.bank.settle();
            self.until_stock = STOCK_TICKS;
            if !self.exciter.is_active() {
                self.pending_energy = 0.0;
            }
        }
        self.until_stock -= 1;
    }

    /// The square of what the modes could add up to, were they all in phase: n amplitudes whose squares sum to E add
    /// up to √(n E) at most.
    fn loudest(&self) -> f64 {
        let gain = f64::from(self.fader.loudest()).max(1.0);
        self.energy * self.bank.len() as f64 * gain * gain
    }

    /// The pitch ratio of an offset, which seldom changes, in semitones.
    fn ratio(&mut self, offset: f64) -> f64 {
        if offset != self.offset {
            (self.offset, self.ratio) = (offset, ratio_from_semitones(offset));
        }
        self.ratio
    }

    /// Adds the next frames, at most [`CONTROL_FRAMES`], to `left` and `right`.
    pub(crate) fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        let frames = left.len();
        let drive = self.exciter.is_active().then(|| {
            self.exciter.fill(frames, &mut self.drive);
            &self.drive
        });
        self.fader.mix(self.bank.render(drive, frames), [left, right]);
        self.age += frames as u64;
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
        // Energy is what a strike of force 1 brings: the sum of the squared levels.
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
        self.pending_energy += force * force * energy;

        let depth = value(Param::Sweep) * (1.0 - percent(Param::SweepVelocity) * (1.0 - velocity));
        self.sweep = SweepEnvelope::new(depth, value(Param::SweepTime), percent(Param::SweepCurve));
        self.vibrato_delay = value(Param::VibratoDelay);
        self.rings_on = instrument.patch.get(Param::NoteOff) != 0.0;
        self.release_velocity = percent(Param::ReleaseVelocity);
    }

    /// Takes the pitch and decay of `note`; returns the frequency of a mode of ratio 1.
    fn place(&mut self, instrument: &Instrument, note: &Note) -> f64 {
        let value = |param| instrument.value(param);
        (self.pitch, self.tune) = (instrument.pitch(note), instrument.controls.tune);
        self.key_scale = ratio_from_semitones(value(Param::DecayKey) * 0.01 * (MIDDLE_C - self.pitch));
        self.damping = Damping { decay: instrument.controls.decay * self.key_scale, release: 0.0, amount: 0.0 };
        for (scale, mode) in self.t60_scale.iter_mut().zip(instrument.patch.modes.as_slice()) {
            *scale = f64::from(mode.decay) * pow(mode.ratio.into(), -value(Param::DecayTilt));
        }
        self.released = false;
        frequency_from_key(self.pitch + self.tune, value(Param::Tuning))
    }

    /// Frequency and T60 of each mode, after [`SynthVoice::place`].
    fn tuning(&self, instrument: &Instrument, frequency: f64) -> impl Iterator<Item = (f64, f64)> + use<> {
        let (damping, scales, table) = (self.damping, self.t60_scale, instrument.patch.modes);
        let stretch = instrument.value(Param::Stretch);
        scales.into_iter().enumerate().map_while(move |(m, scale)| {
            let ratio = f64::from(table.as_slice().get(m)?.ratio);
            let ratio = if stretch == 1.0 { ratio } else { pow(ratio, stretch) };
            Some((frequency * ratio, damping.t60(scale)))
        })
    }

    /// Makes the sounding voice that of `note`, sliding from where its pitch is.
    fn aim(&mut self, instrument: &Instrument, note: &Note) {
        let from = self.pitch + self.glide.at(self.seconds(self.age - self.glide_start));
        if note.key != self.key {
            self.pressure = 0.0;
        }
        self.key = note.key;
        let frequency = self.place(instrument, note);
        self.glide = Glide::new(from - self.pitch, 0.0, instrument.value(Param::Glide));
        self.glide_start = self.age;
        let tuning = self.tuning(instrument, frequency);
        self.bank.retune(tuning);
    }
}

/// Values of [`Param::Exciter`].
const IMPULSE: u32 = 0;
const PLUCK: u32 = 2;
const NOISE: u32 = 3;

impl Voice for SynthVoice {
    type Context = Instrument;

    fn start(&mut self, instrument: &Instrument, note: &Note) {
        *self = Self { patch: note.patch, key: note.key, ..Self::new(instrument.sample_rate, instrument.controls) };
        let frequency = self.place(instrument, note);
        let from = instrument.last_pitch.unwrap_or(self.pitch) - self.pitch;
        self.glide = Glide::new(from, 0.0, instrument.value(Param::Glide));
        let law = if instrument.patch.get(Param::Coefficients) == 0.0 { Law::Exact } else { Law::Classic };
        let width = instrument.value(Param::Width) * 0.01;
        let tuning = self.tuning(instrument, frequency);
        let setup = tuning.zip(instrument.patch.modes.as_slice()).map(|((frequency, t60), mode)| {
            let (left, right) = super::channel::pan_gains((f64::from(mode.pan) * width * 0.5 + 0.5) as f32);
            ModeSetup { frequency, t60, left, right }
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
        self.fader.fade((FADE_SECONDS * self.sample_rate) as u32);
    }

    fn energy(&self) -> f64 {
        self.energy.max(self.pending_energy) * self.fader.remaining()
    }

    fn is_over(&self) -> bool {
        self.fader.is_closed() || (self.pending_energy == 0.0 && self.loudest() < SILENCE * SILENCE)
    }
}
