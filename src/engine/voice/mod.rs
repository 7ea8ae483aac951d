//! One voice: the strikes of its note, a bank of modes, and the modulation of their pitch, decay and gain.

mod bloom;
mod blowing;
mod bowing;
mod clock;
mod colour;
mod decay;
mod drift;
mod energy;
mod hammering;
mod held_noise;
mod input;
pub(super) mod key_tracking;
mod line;
pub(super) mod mode_state;
mod notes;
mod pitch;
mod rattling;
mod separation;
mod strike;
mod tension;
mod values;
mod variation;

use super::channel::Wheels;
use super::controls::Controls;
use super::event::Expression;
use super::expression::Expressions;
use super::instrument::Instrument;
use super::modulation::{Modulators, NoteModulation, Settings};
use super::voice_manager::{Footprint, Unison, Voice};
use crate::dsp::cells::Cells;
use crate::dsp::fader::Fader;
use crate::params::Param;
use crate::patch::ModeTable;
use bloom::Bloom;
use blowing::Blown;
use clock::Clock;
use colour::Colour;
use decay::Decay;
use drift::Drift;
use energy::Energy;
use pitch::{Bends, Pitch};
use separation::Separation;
use strike::Strike;
use tension::Tension;
use values::StruckValues;

/// The voices and cells that a note needs, for a patch's modes and a number of unison voices.
pub(crate) fn footprint(modes: &ModeTable, unison: f32) -> Footprint {
    let voices = unison as usize;
    Footprint { voices, cells: voices * Cells::count_for(modes.as_slice().len()) }
}

/// A sounding note, or one of its unison voices.
pub(crate) struct SynthVoice {
    sample_rate: f64,
    pub(super) bank: Cells,
    /// The voice's position among the unison voices of its note.
    unison: Unison,
    clock: Clock,
    strike: Strike,
    energy: Energy,
    pitch: Pitch,
    decay: Decay,
    colour: Colour,
    drift: Drift,
    tension: Tension,
    bloom: Bloom,
    fader: Fader,
    /// The smoothed and modulated parameters, at the next control tick.
    controls: Controls,
    /// The instrument's serial number when `controls` was copied; none if the note has offsets of its own.
    serial: Option<u32>,
    key: u8,
    /// The index of the note's table of modes; see [`ModeTable::place`].
    table: usize,
    /// −0.5 to 0.5.
    brightness: f64,
    /// Note expressions: tuning, volume, pan, pressure, brightness, vibrato.
    expressions: Expressions,
    /// Offsets that the host sets for this note only.
    modulation: NoteModulation,
    /// The sources and routes of this voice.
    modulators: Modulators,
    /// Velocity of a release that the modulators have not received yet; they receive it at the next control tick.
    let_go: Option<f32>,
    /// Whether the voice has had no control tick yet. The first one sets pitch and gain without a ramp.
    fresh: bool,
    /// Whether the key is down or a pedal holds the note. Only then do bow, breath, held noise and input drive the modes.
    is_held: bool,
    /// Whether routes of the patch modulate tension or bloom.
    may_move: bool,
    /// Whether routes of the patch modulate the level of the bow, of held noise or of the input.
    may_be_driven: bool,
    /// The strikes told apart, if labels are wanted.
    separation: Option<Box<Separation>>,
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
            colour: Colour::full(1.0),
            drift: Drift::new(0),
            tension: Tension::NONE,
            bloom: Bloom::NONE,
            fader: Fader::closed(),
            controls,
            serial: None,
            key: 0,
            table: 0,
            brightness: 0.0,
            expressions: Expressions::new(sample_rate),
            modulation: NoteModulation::NONE,
            modulators: Modulators::none(),
            let_go: None,
            fresh: true,
            is_held: false,
            may_move: false,
            may_be_driven: false,
            separation: None,
        }
    }

    /// Computes pitch, decay and gain for the next control tick, `frames` frames from now, and starts ramps to them.
    /// `instrument` is none for a voice whose patch was replaced; such a voice keeps its last controls.
    pub(crate) fn control(&mut self, instrument: Option<&Instrument>, wheels: Wheels, frames: usize) {
        let passed = self.clock.since_control();
        self.clock.control();
        self.pitch.advance(self.controls.vibrato_rate, passed);
        let base = instrument.filter(|_| self.modulation.is_none()).map(|instrument| &instrument.next_controls);
        let modulation = &self.modulation;
        let own_value = |instrument: &Instrument, param| {
            modulation.after(param, frames as u32).unwrap_or_else(|| instrument.knobs.after(param, frames as u32))
        };
        // A note with offsets of its own takes new values at every tick; others, when the instrument has new ones.
        let serial = base.and(instrument).map(|instrument| instrument.serial);
        let changed = instrument.filter(|_| serial.is_none() || serial != self.serial);
        if let Some(instrument) = changed {
            let own = || Controls::new(|param| own_value(instrument, param), instrument.beat_rate);
            (self.controls, self.serial) = (base.copied().unwrap_or_else(own), serial);
        }
        if !self.modulators.are_idle() {
            self.modulators.advance(passed);
            if let Some(velocity) = self.let_go.take() {
                self.modulators.release(velocity);
            }
            if let Some(instrument) = instrument {
                let own = changed.filter(|_| base.is_none()).map(|instrument| {
                    Settings::new(self.modulators.bus(), |param| own_value(instrument, param), instrument.beat_rate)
                });
                let settings = changed.map(|instrument| own.as_ref().unwrap_or(&instrument.settings));
                self.modulators.follow(settings, &instrument.shared);
            }
            // A new note starts with its routes applied for this frame. The ramp to the next tick, below, begins at these values.
            self.move_controls(base, wheels, if self.fresh { 0 } else { frames });
        }

        let table = self.table;
        let modes = || instrument.map(|instrument| instrument.sound.patch().modes.at(table));
        if self.decay.control(&self.controls, modes, &mut self.bank) {
            self.energy.forget_end();
        }
        let is_played = self.is_played();
        self.drift.control(&self.controls, is_played, [passed, self.clock.seconds(frames as u64)]);
        // What plays or touches feels the pitches of the modes.
        let is_felt = self.strike.is_touched() || self.strike.rattling.is_on();
        let frequency = (!is_felt).then(|| self.pitch.frequency());
        self.colour.control(self.slope(), &self.drift, frequency, modes, &mut self.bank);
        self.energy.measure_always(self.may_move || self.controls.tension > 0.0 || self.blooms());
        let energy = || self.energy.now(self.strike.coming()) / self.strike.full_energy();
        let tension = self.tension.control(&self.controls, energy, self.fresh, self.sample_rate, frames);
        let bends = Bends { wheels, tuning: self.expressions.tuning.into(), tension };
        let mut start = None;
        if self.fresh {
            self.bank.jump_to(self.pitch.aim(&self.controls, &bends, &self.clock, 0));
            if !self.modulators.are_idle() {
                start = Some([self.controls.gain_left, self.controls.gain_right]);
                self.move_controls(base, wheels, frames);
                self.drift.control(&self.controls, is_played, [0.0, self.clock.seconds(frames as u64)]);
                self.colour.control(self.slope(), &self.drift, frequency, modes, &mut self.bank);
            }
        }
        match instrument {
            Some(instrument) => self.begin_hammer(instrument),
            None => self.strike.hammering.give_up(),
        }
        self.pitch.aim(&self.controls, &bends, &self.clock, frames);
        self.control_rattle(instrument);
        self.aim_gain(start, wheels, frames);
        self.control_driven(instrument, frames);
        self.fresh = false;
    }

    /// How much softer higher modes are heard, in decibels per octave.
    fn slope(&self) -> f64 {
        self.controls.colour + self.strike.blowing.slope(&self.controls)
    }

    /// Lets a hammer fly that waits for the pitch of the modes.
    fn begin_hammer(&mut self, instrument: &Instrument) {
        let values = StruckValues { instrument, modulators: &self.modulators, table: self.table };
        self.strike.hammering.begin(&values, self.pitch.frequency(), &mut self.bank);
    }

    /// Lets what rattles begin or end.
    fn control_rattle(&mut self, instrument: Option<&Instrument>) {
        if !self.strike.rattling.is_on() {
            return;
        }
        let Self { strike, modulators, bank, sample_rate, pitch, table, energy, .. } = self;
        let values = instrument.map(|instrument| StruckValues { instrument, modulators, table: *table });
        let (share, note) = (energy.now(strike.coming()) / strike.full_energy(), [pitch.frequency(), *sample_rate]);
        let is_touched = strike.is_touched();
        let full = strike.full_force();
        if strike.rattling.control(values.as_ref(), [share, full], note, pitch.ratio(), is_touched, bank) {
            strike.bowing.lift();
            strike.blowing.lift();
        }
    }

    /// Starts the ramps of bow, breath, noise and input, which end in `frames` frames.
    fn control_driven(&mut self, instrument: Option<&Instrument>, frames: usize) {
        let Self { strike, controls, is_held, modulators, bank, sample_rate, pitch, table, clock, .. } = self;
        if *is_held || strike.is_played() {
            let while_held = |gain| if *is_held { gain } else { 0.0 };
            strike.input.control(while_held(controls.input_gain), *sample_rate, frames);
            strike.held_noise.control(while_held(controls.noise_gain), *sample_rate, frames);
            let values = instrument.map(|instrument| StruckValues { instrument, modulators, table: *table });
            let note = || [pitch.frequency(), *sample_rate];
            let is_blown = strike.blowing.is_on();
            if is_blown {
                strike.bowing.lift();
            }
            if strike.bowing.control(controls, [*is_held, is_blown], values.as_ref(), note, bank, frames) {
                strike.blowing.lift();
            }
            let note = || Blown {
                frequency: pitch.frequency() * pitch.ratio(),
                sample_rate: *sample_rate,
                age: clock.seconds(clock.age),
            };
            strike.blowing.control(controls, *is_held, values.as_ref(), note, bank, frames);
        }
    }

    /// Whether a bow or breath drives the note, or is about to.
    fn is_played(&self) -> bool {
        self.is_held && (self.controls.bow_speed > 0.0 || self.strike.blowing.may_blow())
    }

    /// Whether bow, breath, noise or input drive the note, or may start to.
    fn is_driven(&self) -> bool {
        let Controls { bow_speed, input_gain, noise_gain, .. } = self.controls;
        let is_driven = [bow_speed, input_gain, noise_gain].iter().any(|gain| *gain > 0.0);
        let may_be = is_driven || self.strike.blowing.may_blow() || self.may_be_driven;
        (self.is_held && may_be) || self.strike.is_played() || self.strike.rattling.is_on()
    }

    /// Starts a ramp to the gain `frames` frames from now. A fresh voice has no gain yet: it begins at the gains
    /// `start`, or, if there are none, at the target.
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

    /// Applies the routes to the controls, for the time `frames` frames from now. `base` has the instrument's controls,
    /// if they are those of the voice.
    fn move_controls(&mut self, base: Option<&Controls>, wheels: Wheels, frames: usize) {
        let mut positions = wheels.positions(self.brightness, |source| self.modulators.reads(source));
        positions.pressure = positions.pressure.max(self.expressions.pressure);
        positions.wheel = positions.wheel.max(self.expressions.vibrato);
        if self.modulators.are_still(&positions) {
            return;
        }
        let (seconds, controls) = (self.clock.seconds(frames as u64), &mut self.controls);
        let (before, mut has_moved) = (controls.level_and_pan(), false);
        self.modulators.control(seconds, &positions, |param, value| {
            controls.set(param, value);
            has_moved = true;
        });
        if has_moved {
            controls.find_gains(before, base);
        }
    }

    /// Starts the modes' ramp to the pitch that [`SynthVoice::control`] has computed. A separate loop over all voices calls it,
    /// so that the CPU can overlap the latencies of one voice with the work of others: this takes a tenth less time.
    pub(crate) fn sweep(&mut self, frames: usize) {
        self.bank.sweep_to(self.pitch.ratio(), frames);
    }

    /// Measures the remaining energy and puts silent modes to rest, at control ticks. A note that starts at this tick has no
    /// energy yet.
    pub(crate) fn settle(&mut self) {
        if self.fresh {
            return;
        }
        let blooms = self.blooms();
        let rings = !blooms && !self.strike.is_active() && !self.is_driven();
        self.energy.settle(&mut self.bank, &self.strike, &self.fader, rings);
        if blooms {
            self.bloom.climb(&self.controls, self.strike.full_energy(), self.sample_rate, &mut self.bank);
            self.strike.rattling.bloom();
        }
    }

    /// Whether energy moves to higher modes.
    fn blooms(&self) -> bool {
        let energy = self.energy.now(self.strike.coming()) / self.strike.full_energy();
        !self.strike.blowing.has_blown() && Bloom::acts(&self.controls, energy)
    }

    /// Frames until the voice is over if no event comes, `to_tick` frames before the next control tick: see
    /// [`Energy::tail_frames`]. `u64::MAX` if oscillators or envelopes modulate decay or gain, since the end is then
    /// unknown.
    ///
    /// Real-time safe. Takes some microseconds after a strike, a release or a change of gain or decay, and nearly no
    /// time otherwise.
    pub(crate) fn tail_frames(&mut self, to_tick: u64) -> u64 {
        if self.is_over() {
            to_tick
        } else if self.modulators.move_the_end() || self.is_driven() {
            u64::MAX
        } else {
            let (blooms, times) = (self.blooms(), [self.clock.total, to_tick]);
            self.energy.tail_frames(&self.bank, &self.strike, &self.fader, blooms, times)
        }
    }

    /// Upper bound of the absolute samples from now on, if no event comes. Real-time safe.
    pub(crate) fn peak(&self) -> f64 {
        self.energy.peak(&self.bank, &self.fader)
    }

    /// Adds the next frames, at most [`crate::dsp::CONTROL_FRAMES`], to `left` and `right`.
    /// `input` is the incoming sound: empty, or one sample for each frame.
    pub(crate) fn render(&mut self, input: &[f32], left: &mut [f32], right: &mut [f32]) {
        let frames = left.len();
        if let Some(separation) = &mut self.separation {
            separation.render(&self.strike, &self.bank, frames);
        }
        let (drive, player) = self.strike.forces(frames, input);
        self.fader.mix(self.bank.render(drive, player, frames), [left, right]);
        self.tension.advance(frames);
        self.clock.advance(frames as u64);
        self.expressions.advance(frames as u32);
        self.modulation.advance(frames as u32);
    }

    /// Pushes mode `m`, if there is one, in the direction in which it moves; `share` is 0–1.
    pub(crate) fn nudge(&mut self, instrument: &Instrument, m: usize, share: f32) {
        let values = StruckValues { instrument, modulators: &self.modulators, table: self.table };
        let amplitude = f64::from(share) * strike::most_nudged(&values, m, self.unison.count);
        if amplitude > 0.0 {
            self.bank.nudge(m, amplitude as f32);
            self.energy.nudge(amplitude);
        }
    }

    /// Applies a note expression. `brightness` is the channel's.
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

    /// Resets the key's pressure.
    pub(crate) fn relax(&mut self) {
        self.expressions.set(Expression::Pressure, 0.0);
    }

    /// Modulates a parameter of this note by an offset in knob travel. `now` is the instrument's value.
    pub(crate) fn modulate(&mut self, instrument: &Instrument, param: Param, offset: f32, now: f32) {
        self.modulation.set(param, offset, now);
        self.follow(instrument);
    }

    /// Computes the targets of the note's own offsets again, from the instrument's present values.
    pub(crate) fn follow(&mut self, instrument: &Instrument) {
        let knobs = &instrument.knobs;
        self.modulation.aim(|param| knobs.value(param), |param| knobs.modulated(param), self.sample_rate, self.fresh);
    }

    /// Sets the brightness to the sum of the note's and its channel's. It also changes the note's strike if that has
    /// not begun.
    pub(crate) fn shade(&mut self, instrument: Option<&Instrument>, channel: f32) {
        self.brightness = (self.expressions.brightness + channel).clamp(-0.5, 0.5).into();
        if let Some(instrument) = instrument.filter(|_| self.clock.age == 0 && !self.modulators.are_idle()) {
            self.modulators.shade((2.0 * self.brightness) as f32);
            let values = StruckValues { instrument, modulators: &self.modulators, table: self.table };
            self.energy.expect(self.strike.set_gains(&values, &mut self.bank));
            self.strike.hammering.prepare_again();
            if !self.fresh {
                self.begin_hammer(instrument);
            }
        }
    }
}
