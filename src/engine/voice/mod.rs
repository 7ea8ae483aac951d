//! One note: an exciter, a bank of modes, and what moves their pitch, decay and gain.

pub(super) mod key_tracking;
mod strike;
mod tail;

use super::channel::Wheels;
use super::controls::Controls;
use super::damping::Damping;
use super::event::Expression;
use super::expression::Expressions;
use super::fader::Fader;
use super::instrument::Instrument;
use super::modulation::{Modulators, NoteModulation};
use super::note::Note;
use super::voice_manager::Voice;
use crate::dsp::bank::{Bank, Law};
use crate::dsp::exciter::{Drive, Exciter};
use crate::dsp::mode_bank::{MAX_MODES, ModeSetup};
use crate::dsp::pitch::{Glide, SweepEnvelope};
use crate::params::Param;
use crate::units::ratio_from_semitones;
use key_tracking::KeyTracking;
use libm::{pow, sin};
use std::f64::consts::TAU;

/// A voice is over when its modes could not add up to more than this: −120 dBFS.
const SILENCE: f64 = 1e-6;

/// Stock is taken of a voice's energy every so many control ticks, and at every tick below −110 dBFS.
const STOCK_TICKS: u32 = 8;
const NEARLY_SILENT: f64 = 3.2e-6;

/// The time in which a stolen or choked voice is faded out.
const FADE_SECONDS: f64 = 0.012;

/// A sounding note.
pub(crate) struct SynthVoice {
    sample_rate: f64,
    /// Seconds a frame.
    period: f64,
    pub(super) bank: Bank,
    exciter: Exciter,
    drive: Drive,
    /// Frequency of each mode as a multiple of the note's, and T60 as a multiple of the decay.
    ratios: [f64; MAX_MODES],
    t60_scale: [f64; MAX_MODES],
    /// Energy that the exciter has still to bring, and that of the bank at the last tick.
    pending_energy: f64,
    energy: f64,
    /// Control ticks until stock is taken of the energy.
    until_stock: u32,
    /// Squared force of the last strike, and the energy that one of force 1 would bring.
    squared_force: f64,
    unit_energy: f64,
    /// The frame, counted as `total_age`, at which the voice will be over, if it is known.
    end: Option<u64>,
    /// Frames since the start.
    total_age: u64,

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
    key: u8,
    key_tracking: KeyTracking,
    key_scale: f64,
    rings_on: bool,
    released: bool,
    release_scale: f64,
    release_velocity: f64,
    /// Note expressions: tuning, volume, pan, pressure, brightness, vibrato.
    expressions: Expressions,
    /// What moves the instrument's parameters for this note.
    modulation: NoteModulation,
    /// What its routes make of its sources.
    modulators: Modulators,
    /// The release that the modulators have still to be told of.
    let_go: Option<f32>,
    /// −0.5 to 0.5.
    brightness: f64,
    damping: Damping,
    /// The T60s of the modes are to be set at the next control, whether or not `damping` changes.
    decay_changed: bool,

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
            bank: Bank::new(sample_rate),
            exciter: Exciter::REST,
            drive: Drive::NONE,
            ratios: [1.0; MAX_MODES],
            t60_scale: [1.0; MAX_MODES],
            pending_energy: 0.0,
            energy: 0.0,
            until_stock: 0,
            squared_force: 0.0,
            unit_energy: 0.0,
            end: None,
            total_age: 0,
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
            key: 0,
            key_tracking: KeyTracking::NONE,
            key_scale: 1.0,
            rings_on: false,
            released: false,
            release_scale: 1.0,
            release_velocity: 0.0,
            expressions: Expressions::new(sample_rate),
            modulation: NoteModulation::NONE,
            modulators: Modulators::none(),
            let_go: None,
            brightness: 0.0,
            damping: Damping { decay: 1.0, release: 1.0, amount: 0.0 },
            decay_changed: false,
            fader: Fader::CLOSED,
            fresh: true,
        }
    }

    fn seconds(&self, frames: u64) -> f64 {
        // A division takes four times as long, and there are a handful a tick.
        frames as f64 * self.period
    }

    /// Offset from the pitch that the bank was loaded at, `ahead` frames from now, in semitones.
    fn offset(&self, wheels: Wheels, ahead: usize) -> f64 {
        let c = &self.controls;
        let age = self.age + ahead as u64;
        let own =
            c.vibrato * if self.vibrato_delay > 0.0 { (self.seconds(age) / self.vibrato_delay).min(1.0) } else { 1.0 };
        let wheel = wheels.most(|channel| channel.wheel).max(self.expressions.vibrato.into());
        let depth = own + c.wheel_vibrato * wheel + c.pressure_vibrato * self.pressure(wheels);
        let phase = self.vibrato_phase + c.vibrato_rate * self.seconds(ahead as u64);
        let vibrato = if depth > 0.0 { depth * sin(TAU * phase) } else { 0.0 };
        let (bend, tuning) = wheels.semitones(c.bend_range);
        self.glide.at(self.seconds(age - self.glide_start))
            + self.sweep.at(self.seconds(age))
            + (c.tune - self.tune)
            + bend
            + tuning
            + f64::from(self.expressions.tuning)
            + vibrato
    }

    /// Pressure on the note, 0–1: its own or its channel's.
    fn pressure(&self, wheels: Wheels) -> f64 {
        wheels.most(|channel| channel.pressure).max(self.expressions.pressure.into())
    }

    /// Sets out for where pitch, decay and gain are to be in `frames` frames: at the next control tick.
    /// There is no instrument for a voice of an earlier patch, which keeps the last controls it had.
    pub(crate) fn control(&mut self, instrument: Option<&Instrument>, wheels: Wheels, frames: usize) {
        let passed = self.seconds(self.age - self.controlled_age);
        self.vibrato_phase += self.controls.vibrato_rate * passed;
        self.vibrato_phase -= libm::floor(self.vibrato_phase);
        self.controlled_age = self.age;
        if let Some(Instrument { smoother, next_controls, .. }) = instrument {
            let own = !self.modulation.is_none();
            self.controls = if own { smoother.modulated(&self.modulation, frames as u32) } else { *next_controls };
        }
        if !self.modulators.are_idle() {
            self.modulators.advance(passed);
            if let Some(velocity) = self.let_go.take() {
                self.modulators.release(velocity);
            }
            if let Some(instrument) = instrument {
                let smoother = &instrument.smoother;
                let (settings, bus) = (&instrument.settings, self.modulators.bus());
                let own = (!self.modulation.is_none())
                    .then(|| smoother.own_settings(&self.modulation, frames as u32, settings, bus));
                self.modulators.follow(own.as_ref().unwrap_or(settings), &instrument.shared);
            }
            // A note starts where its modulation starts: its pitch goes on from there below.
            self.move_controls(wheels, if self.fresh { 0 } else { frames });
        }

        let amount = if self.released { 1.0 } else { self.controls.pressure_damping * self.pressure(wheels) };
        let damping = Damping {
            decay: self.controls.decay * self.key_scale,
            release: if amount == 0.0 { 0.0 } else { self.controls.release * self.release_scale },
            amount,
        };
        if damping != self.damping || std::mem::take(&mut self.decay_changed) {
            self.damping = damping;
            self.end = None;
            for m in 0..self.bank.len() {
                self.bank.set_t60(m, damping.t60(self.t60_scale[m]));
            }
        }
        let mut start = None;
        if self.fresh {
            let ratio = self.ratio(self.offset(wheels, 0));
            self.bank.jump_to(ratio);
            if !self.modulators.are_idle() {
                start = Some([self.controls.gain_left, self.controls.gain_right]);
                self.move_controls(wheels, frames);
            }
        }
        self.ratio(self.offset(wheels, frames));

        if self.fresh {
            self.expressions.land();
        }
        let (left, right) = wheels.gains_after(frames as u32);
        let [own_left, own_right] = self.expressions.gains_after(frames as u32);
        let target = [self.controls.gain_left * left * own_left, self.controls.gain_right * right * own_right];
        if self.fresh {
            self.fader.jump(start.map_or(target, |[start_left, start_right]: [f32; 2]| {
                [start_left * left * own_left, start_right * right * own_right]
            }));
            if start.is_some() {
                self.fader.aim(target, frames);
            }
        } else if self.fader.aim(target, frames) {
            self.end = None;
        }
        self.fresh = false;
    }

    /// Puts the controls where the routes want them in `frames` frames.
    fn move_controls(&mut self, wheels: Wheels, frames: usize) {
        let mut positions = wheels.positions(self.brightness);
        positions.pressure = self.pressure(wheels) as f32;
        positions.wheel = positions.wheel.max(self.expressions.vibrato);
        let (seconds, controls) = (self.seconds(frames as u64), &mut self.controls);
        let before = controls.level_and_pan();
        self.modulators.control(seconds, &positions, |param, value| controls.set(param, value));
        controls.find_gains(before);
    }

    /// Sends the modes to the pitch that [`SynthVoice::control`] has found. Apart from it, so that what one voice
    /// waits for is done while others wait: that gains a tenth.
    pub(crate) fn sweep(&mut self, frames: usize) {
        self.bank.sweep_to(self.ratio, frames);
    }

    /// Measures the remaining energy and puts silent modes to rest, at control ticks. Every few ticks are enough, until the voice is nearly silent or its strike has just ended.
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
        self.total_age += frames as u64;
        self.expressions.advance(frames as u32);
        self.modulation.advance(frames as u32);
    }

    /// Takes in what the note is told; `brightness` is the channel's.
    pub(crate) fn express(
        &mut self,
        instrument: Option<&Instrument>,
        expression: Expression,
        value: f32,
        brightness: f32,
    ) {
        self.expressions.set(expression, value);
        if expression == Expression::Brightness {
            self.shade(instrument, brightness);
        }
    }

    /// Lets go of the key's pressure.
    pub(crate) fn relax(&mut self) {
        self.expressions.set(Expression::Pressure, 0.0);
    }

    /// Modulates a parameter of this note by an offset in knob travel. `now` is the instrument's value.
    pub(crate) fn modulate(&mut self, instrument: &Instrument, param: Param, offset: f32, now: f32) {
        self.modulation.set(param, offset, now);
        self.follow(instrument);
    }

    /// Takes the note's own offsets from the instrument's present values.
    pub(crate) fn follow(&mut self, instrument: &Instrument) {
        self.modulation.aim(&instrument.values, &instrument.modulated, self.sample_rate, self.fresh);
    }

    /// Takes over the brightness of the note and of its channel: into a strike that has yet to begin, and into the
    /// decay of the modes.
    pub(crate) fn shade(&mut self, instrument: Option<&Instrument>, channel: f32) {
        let Some(instrument) = instrument else { return };
        self.brightness = f64::from((self.expressions.brightness + channel).clamp(-0.5, 0.5));
        if self.age == 0 {
            self.set_excitation_gains(instrument);
        }
        self.scale_decay(instrument);
        self.decay_changed = true;
    }
}

impl Voice for SynthVoice {
    type Context = Instrument;

    fn start(&mut self, instrument: &Instrument, note: &Note) {
        *self = Self {
            key: note.key,
            brightness: note.brightness.into(),
            ..Self::new(instrument.sample_rate, instrument.controls)
        };
        self.expressions.begin(note.gain, note.pan);
        if !instrument.bus.is_empty() {
            self.modulators.load(&instrument.bus);
            self.strike_modulators(instrument, note, true);
        }
        self.read_body(instrument);
        let frequency = self.place(note, instrument.controls);
        let from = instrument.last_pitch.unwrap_or(self.pitch) - self.pitch;
        self.glide = Glide::new(from, 0.0, self.key_tracking.glide_seconds);
        let law = if instrument.modulated.get(Param::Coefficients) == 0.0 { Law::Exact } else { Law::Classic };
        if law != Law::Exact {
            // A new voice has a bank of the exact law already.
            self.bank = Bank::of(law, instrument.sample_rate);
        }
        let width = self.value(instrument, Param::Width) * 0.01;
        let tuning = self.tuning(frequency);
        let setup = tuning.zip(instrument.sound.patch().modes.as_slice()).map(|((frequency, t60), mode)| {
            let (left, right) = super::gain::pan_gains((f64::from(mode.pan) * width * 0.5 + 0.5) as f32);
            ModeSetup { frequency, t60, left, right }
        });
        self.bank.load(setup);
        self.excite(instrument, note);
    }

    fn restrike(&mut self, instrument: &Instrument, note: &Note) {
        if !self.modulators.are_idle() {
            self.modulators.advance(self.seconds(self.age - self.controlled_age));
            self.let_go = None;
            self.strike_modulators(instrument, note, false);
        }
        self.aim(Some(instrument), note);
        self.excite(instrument, note);
        // The age starts again with the sweep; the glide starts now anyway, and the vibrato keeps its phase.
        self.vibrato_phase += self.controls.vibrato_rate * self.seconds(self.age - self.controlled_age);
        (self.age, self.controlled_age, self.glide_start) = (0, 0, 0);
    }

    fn retune(&mut self, instrument: Option<&Instrument>, note: &Note) {
        self.aim(instrument, note);
    }

    fn release(&mut self, velocity: f32) {
        self.let_go = Some(velocity);
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
