//! One note: its strikes, a bank of modes, and what moves their pitch, decay and gain.

mod clock;
mod decay;
mod energy;
pub(super) mod key_tracking;
mod notes;
mod pitch;
mod strike;
mod values;

use super::channel::Wheels;
use super::controls::Controls;
use super::event::Expression;
use super::expression::Expressions;
use super::fader::Fader;
use super::instrument::Instrument;
use super::modulation::{Modulators, NoteModulation};
use super::voice_manager::{Footprint, Unison, Voice};
use crate::dsp::cells::Cells;
use crate::params::Param;
use crate::patch::ModeTable;
use clock::Clock;
use decay::Decay;
use energy::Energy;
use pitch::{Bends, Pitch};
use strike::Strike;
use values::StruckValues;

/// What a note takes of a patch's modes and of so many unison voices.
pub(crate) fn footprint(modes: &ModeTable, unison: f32) -> Footprint {
    let voices = unison as usize;
    Footprint { voices, cells: voices * Cells::count_for(modes.as_slice().len()) }
}

/// A sounding note, or one of its unison voices.
pub(crate) struct SynthVoice {
    sample_rate: f64,
    pub(super) bank: Cells,
    /// Which of the note's voices it is.
    unison: Unison,
    clock: Clock,
    strike: Strike,
    energy: Energy,
    pitch: Pitch,
    decay: Decay,
    fader: Fader,
    /// The parameters that it follows, as they will be at the next control tick.
    controls: Controls,
    /// The count of the instrument's controls that these are made of, if they are.
    controls_serial: Option<u32>,
    key: u8,
    /// −0.5 to 0.5.
    brightness: f64,
    /// Note expressions: tuning, volume, pan, pressure, brightness, vibrato.
    expressions: Expressions,
    /// What moves the instrument's parameters for this note.
    modulation: NoteModulation,
    /// What its routes make of its sources.
    modulators: Modulators,
    /// The release that the modulators have still to be told of.
    let_go: Option<f32>,
    /// Pitch and gain are taken as they are at the first control, not slid to.
    fresh: bool,
}

impl SynthVoice {
    /// A voice at rest.
    pub(crate) fn new(sample_rate: f64, controls: Controls) -> Self {
        Self {
            sample_rate,
            bank: Cells::EMPTY,
            unison: Unison::ONE,
            clock: Clock::new(sample_rate),
            strike: Strike::new(),
            energy: Energy::NONE,
            pitch: Pitch::new(),
            decay: Decay::new(),
            fader: Fader::CLOSED,
            controls,
            controls_serial: None,
            key: 0,
            brightness: 0.0,
            expressions: Expressions::new(sample_rate),
            modulation: NoteModulation::NONE,
            modulators: Modulators::none(),
            let_go: None,
            fresh: true,
        }
    }

    /// Sets out for where pitch, decay and gain are to be in `frames` frames: at the next control tick.
    /// There is no instrument for a voice of an earlier patch, which keeps the last controls it had.
    pub(crate) fn control(&mut self, instrument: Option<&Instrument>, wheels: Wheels, frames: usize) {
        let passed = self.clock.since_control();
        self.clock.control();
        self.pitch.advance(self.controls.vibrato_rate, passed);
        let base = instrument.filter(|_| self.modulation.is_none()).map(|instrument| &instrument.next_controls);
        let mut is_new = self.fresh;
        if let Some(Instrument { smoother, controls_serial, .. }) = instrument {
            let serial = base.map(|_| *controls_serial);
            if serial.is_none() || serial != self.controls_serial {
                let own = || smoother.modulated(&self.modulation, frames as u32);
                (self.controls, self.controls_serial) = (base.copied().unwrap_or_else(own), serial);
                self.modulators.unsettle();
                is_new = true;
            }
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
                self.modulators.follow(own.as_ref().unwrap_or(settings), own.is_some(), &instrument.shared);
            }
            // A note starts where its modulation starts: its pitch goes on from there below.
            is_new |= self.move_controls(base, wheels, if self.fresh { 0 } else { frames });
        }

        let modes = instrument.map(|instrument| instrument.sound.patch().modes.as_slice());
        if self.decay.control(&self.controls, is_new, modes, &mut self.bank) {
            self.energy.forget_end();
        }
        let bends = Bends { wheels, tuning: self.expressions.tuning.into() };
        let mut start = None;
        if self.fresh {
            self.bank.jump_to(self.pitch.aim(&self.controls, &bends, &self.clock, 0));
            if !self.modulators.are_idle() {
                start = Some([self.controls.gain_left, self.controls.gain_right]);
                if self.move_controls(base, wheels, frames) {
                    self.decay.unsettle();
                }
            }
        }
        self.pitch.aim(&self.controls, &bends, &self.clock, frames);
        self.aim_gain(start, wheels, frames);
        self.fresh = false;
    }

    /// Sets out for where the gain is to be in `frames` frames. A fresh voice begins at the gains `start`, or there.
    fn aim_gain(&mut self, start: Option<[f32; 2]>, wheels: Wheels, frames: usize) {
        if self.fresh {
            self.expressions.land();
        }
        let (left, right) = wheels.gains_after(frames as u32);
        let [own_left, own_right] = self.expressions.gains_after(frames as u32);
        let told = |[to_left, to_right]: [f32; 2]| [to_left * left * own_left, to_right * right * own_right];
        let target = told([self.controls.gain_left, self.controls.gain_right]);
        if self.fresh {
            self.fader.jump(start.map_or(target, told));
            if start.is_some() {
                self.fader.aim(target, frames);
            }
        } else if self.fader.aim(target, frames) {
            self.energy.forget_end();
        }
    }

    /// Puts the controls, which are those of `base` if that is known, where the routes want them in `frames` frames. Returns
    /// whether any has moved.
    fn move_controls(&mut self, base: Option<&Controls>, wheels: Wheels, frames: usize) -> bool {
        let mut positions = wheels.positions(self.brightness, |source| self.modulators.reads(source));
        positions.pressure = positions.pressure.max(self.expressions.pressure);
        positions.wheel = positions.wheel.max(self.expressions.vibrato);
        let (seconds, controls) = (self.clock.seconds(frames as u64), &mut self.controls);
        let (before, mut has_moved) = (controls.level_and_pan(), false);
        self.modulators.control(seconds, &positions, |param, value| {
            controls.set(param, value);
            has_moved = true;
        });
        if has_moved {
            controls.find_gains(before, base);
        }
        has_moved
    }

    /// Sends the modes to the pitch that [`SynthVoice::control`] has found. Apart from it, so that what one voice
    /// waits for is done while others wait: that gains a tenth.
    pub(crate) fn sweep(&mut self, frames: usize) {
        self.bank.sweep_to(self.pitch.ratio(), frames);
    }

    /// Measures the remaining energy and puts silent modes to rest, at control ticks.
    pub(crate) fn settle(&mut self) {
        self.energy.settle(&mut self.bank, &self.strike, &self.fader);
    }

    /// Frames until the voice is over if it is left alone, `to_tick` frames before the next control tick: see
    /// [`Energy::tail_frames`]. Without end where routes move decay or gain: nobody knows where they will be.
    ///
    /// Real-time safe. Some microseconds after a strike, release or change of gain or decay, next to nothing otherwise.
    pub(crate) fn tail_frames(&mut self, to_tick: u64) -> u64 {
        if self.is_over() {
            to_tick
        } else if self.modulators.move_the_end() {
            u64::MAX
        } else {
            self.energy.tail_frames(&self.bank, &self.strike, &self.fader, self.clock.total, to_tick)
        }
    }

    /// Adds the next frames, at most [`crate::dsp::CONTROL_FRAMES`], to `left` and `right`.
    pub(crate) fn render(&mut self, left: &mut [f32], right: &mut [f32]) {
        let frames = left.len();
        self.fader.mix(self.bank.render(self.strike.drive(frames), frames), [left, right]);
        self.clock.advance(frames as u64);
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

    /// Takes over the brightness of the note and of its channel: also into a strike that has yet to begin.
    pub(crate) fn shade(&mut self, instrument: Option<&Instrument>, channel: f32) {
        self.brightness = (self.expressions.brightness + channel).clamp(-0.5, 0.5).into();
        if let Some(instrument) = instrument.filter(|_| self.clock.age == 0 && !self.modulators.are_idle()) {
            self.modulators.shade((2.0 * self.brightness) as f32);
            let values = StruckValues { instrument, modulators: &self.modulators };
            self.energy.expect(self.strike.set_gains(&values, &mut self.bank));
        }
    }
}
