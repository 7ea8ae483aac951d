//! The modulation of one voice: its sources as they are now, and what the routes make of them at each control tick.

use super::bus::{Bus, SOURCES, Sources, Sums, Target, bit};
use super::envelope::{Envelope, Times};
use super::lfo::Lfo;
use crate::dsp::random;
use crate::params::{Choice, NoteValue, PARAMS, Param, Scope, Shape};
use crate::patch::routes::{MAX_ROUTES, Source, amount_param};

/// How many slow oscillators and envelopes there are.
const LFOS: usize = 3;
const ENVELOPES: usize = 2;

/// Streams of random numbers beside those of a note's noise.
const STRIKE_STREAM: u64 = 0x5354_5249_4b45;
const LFO_STREAM: u64 = 0x4c46_4f00;

/// The parameter of an oscillator that is `first` of the first one.
fn of_lfo(first: Param, index: usize) -> Param {
    let rows = Param::Lfo2Rate as usize - Param::Lfo1Rate as usize;
    PARAMS[first as usize + index * rows].param
}

/// What voices follow of the modulators' own parameters, and of those that routes lead to. Plain data.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// Counts how often they were made anew.
    serial: u32,
    /// Rounds a second.
    rates: [f64; LFOS],
    /// Whether the rate is that of a note value, which nothing moves.
    are_synchronised: [bool; LFOS],
    shapes: [Shape; LFOS],
    macros: [f32; 8],
    amounts: [f32; MAX_ROUTES],
    /// Values of the bus's destinations before they are moved.
    bases: [f32; MAX_ROUTES],
}

impl Settings {
    /// Nothing moves.
    pub(crate) const STILL: Self = Self {
        serial: 0,
        rates: [0.0; LFOS],
        are_synchronised: [false; LFOS],
        shapes: [Shape::Sine; LFOS],
        macros: [0.0; 8],
        amounts: [0.0; MAX_ROUTES],
        bases: [0.0; MAX_ROUTES],
    };

    /// Those after these: of parameters with these values, at a tempo in beats per second.
    pub(crate) fn next(&self, bus: &Bus, value: impl Fn(Param) -> f32, beat_rate: f64) -> Self {
        let mut bases = [0.0; MAX_ROUTES];
        bus.destinations().iter().zip(&mut bases).for_each(|(destination, base)| *base = value(destination.param));
        let sync = |index| NoteValue::from_value(value(of_lfo(Param::Lfo1Sync, index)));
        Self {
            serial: self.serial.wrapping_add(1),
            bases,
            rates: std::array::from_fn(|index| {
                let rate = f64::from(value(of_lfo(Param::Lfo1Rate, index)));
                super::rate_at(sync(index), rate, beat_rate)
            }),
            are_synchronised: std::array::from_fn(|index| sync(index) != NoteValue::Off),
            shapes: std::array::from_fn(|index| Shape::from_value(value(of_lfo(Param::Lfo1Shape, index)))),
            macros: std::array::from_fn(|index| value(PARAMS[Param::Macro1 as usize + index].param) * 0.01),
            amounts: std::array::from_fn(|place| value(amount_param(place)) * 0.01),
        }
    }

    /// Those of one note, told from all that the instrument will have next.
    pub(crate) fn own(&self, bus: &Bus, value: impl Fn(Param) -> f32, beat_rate: f64) -> Self {
        Self { serial: self.serial.wrapping_sub(1), ..self.next(bus, value, beat_rate) }
    }
}

/// Oscillators that all voices of an instrument can follow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SharedLfos([Lfo; LFOS]);

impl SharedLfos {
    /// At their start, for a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(std::array::from_fn(|index| Lfo::new(0.0, random::key(seed, LFO_STREAM + index as u64))))
    }

    /// Lets time pass.
    pub(crate) fn advance(&mut self, settings: &Settings, seconds: f64) {
        self.0.iter_mut().zip(settings.rates).for_each(|(lfo, rate)| lfo.advance(rate * seconds));
    }
}

/// Positions of the controllers that routes can read.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Positions {
    pub(crate) pressure: f32,
    pub(crate) timbre: f32,
    pub(crate) bend: f32,
    pub(crate) wheel: f32,
    pub(crate) breath: f32,
    pub(crate) expression: f32,
}

/// What a strike says that stays until the next.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Struck {
    pub(crate) velocity: f32,
    /// In semitones on the MIDI scale.
    pub(crate) pitch: f64,
    pub(crate) seed: u64,
    /// Counts the notes.
    pub(crate) serial: u64,
}

/// The modulation of one voice. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Modulators {
    bus: Bus,
    settings: Settings,
    sources: Sources,
    /// Sources that have changed since they were last looked at, as bits.
    changed: u32,
    /// The settings have changed since then.
    unsettled: bool,
    /// How far each destination of the bus is moved, and was at the strike; and the value that it is moved to.
    offsets: Sums,
    struck_offsets: Sums,
    values: [f32; MAX_ROUTES],
    /// Rounds a second as they are modulated: until the next control, and from then on.
    rates: [f64; LFOS],
    next_rates: [f64; LFOS],
    moving: Moving,
    /// What moves, as it will be `ahead_seconds` later: at the next control tick, as a rule.
    ahead: Moving,
    ahead_seconds: f64,
    /// Share of a round at which each oscillator starts.
    phases: [f64; LFOS],
    /// Seconds in which it fades in.
    fades: [f64; LFOS],
    /// Whether it is where the shared one is. A copy of that: a voice that outlives its patch goes on by itself.
    are_shared: [bool; LFOS],
}

/// The sources that move by themselves.
#[derive(Clone, Copy, Debug)]
struct Moving {
    lfos: [Lfo; LFOS],
    envelopes: [Envelope; ENVELOPES],
    /// Seconds since the strike.
    age: f64,
}

impl Moving {
    const REST: Self = Self { lfos: [Lfo::REST; LFOS], envelopes: [Envelope::REST; ENVELOPES], age: 0.0 };

    /// Lets time pass for what routes read.
    fn advance(&mut self, bus: &Bus, rates: &[f64; LFOS], seconds: f64) {
        self.age += seconds;
        for (index, lfo) in self.lfos.iter_mut().enumerate().filter(|(index, _)| bus.reads_nth(Source::Lfo1, *index)) {
            lfo.advance(rates[index] * seconds);
        }
        let envelopes = self.envelopes.iter_mut().enumerate();
        for (_, envelope) in envelopes.filter(|(index, _)| bus.reads_nth(Source::Envelope1, *index)) {
            envelope.advance(seconds);
        }
    }
}

impl Modulators {
    /// Without routes.
    pub(crate) fn none() -> Self {
        Self {
            bus: Bus::EMPTY,
            settings: Settings::STILL,
            sources: [0.0; SOURCES],
            changed: 0,
            unsettled: true,
            offsets: [0.0; MAX_ROUTES],
            struck_offsets: [0.0; MAX_ROUTES],
            values: [0.0; MAX_ROUTES],
            rates: [0.0; LFOS],
            next_rates: [0.0; LFOS],
            moving: Moving::REST,
            ahead: Moving::REST,
            ahead_seconds: 0.0,
            phases: [0.0; LFOS],
            fades: [0.0; LFOS],
            are_shared: [false; LFOS],
        }
    }

    /// Whether there are no routes: then there is nothing to do.
    pub(crate) fn are_idle(&self) -> bool {
        self.bus.is_empty()
    }

    /// Whether oscillators or envelopes move what decides when a note is over.
    pub(crate) fn move_the_end(&self) -> bool {
        self.bus.moves_the_end()
    }

    /// Takes over the routes of an instrument. Those that a voice is started with are its own until it ends.
    pub(crate) fn load(&mut self, bus: &Bus) {
        self.bus = *bus;
    }

    /// A note is struck while the controllers are at `positions`. `value` has the instrument's parameters. A
    /// `first` strike starts the oscillators.
    pub(crate) fn strike(
        &mut self,
        struck: &Struck,
        positions: &Positions,
        settings: &Settings,
        shared: &SharedLfos,
        value: impl Fn(Param) -> f32,
        first: bool,
    ) {
        let stream = random::key(struck.seed ^ STRIKE_STREAM, struck.serial);
        (self.settings, self.unsettled) = (*settings, true);
        self.ahead_seconds = 0.0;
        let strike = [
            (Source::Velocity, struck.velocity),
            (Source::ReleaseVelocity, 0.0),
            (Source::Key, key_position(struck.pitch)),
            (Source::Random, random::uniform(stream, 0)),
            (Source::Alternation, if struck.serial.is_multiple_of(2) { 1.0 } else { -1.0 }),
        ];
        strike.into_iter().for_each(|(source, value)| self.set_source(source, value));
        self.moving.age = 0.0;
        for index in 0..LFOS {
            self.phases[index] = f64::from(value(of_lfo(Param::Lfo1Phase, index))) * 0.01;
            self.are_shared[index] = Scope::from_value(value(of_lfo(Param::Lfo1Scope, index))) == Scope::Shared;
            if first {
                let stream = random::key(stream, LFO_STREAM + index as u64);
                self.moving.lfos[index] = Lfo::new(self.phases[index], stream);
            }
        }
        self.share(shared);
        if first {
            (self.rates, self.next_rates) = (settings.rates, settings.rates);
            self.moving.envelopes = [Envelope::REST; ENVELOPES];
            self.fades = [0.0; LFOS];
        }
        // The envelopes' times and the fades follow from where the sources are before they start.
        self.look_ahead(0.0, positions);
        self.struck_offsets = self.offsets;
        for index in 0..ENVELOPES {
            let times = Times::new(index, |param| f64::from(self.struck_value(param, &value)));
            self.moving.envelopes[index].strike(times);
        }
        self.fades = std::array::from_fn(|index| self.struck_value(of_lfo(Param::Lfo1Fade, index), &value).into());
        self.ahead = self.moving;
        // The first control finds the values of all destinations.
        self.unsettled = true;
    }

    /// The value that a parameter has for the strike.
    pub(crate) fn struck_value(&self, param: Param, value: impl Fn(Param) -> f32) -> f32 {
        let place = self.bus.destinations().iter().position(|destination| destination.param == param);
        match place {
            Some(place) => self.bus.destinations()[place].moved(value(param), self.struck_offsets[place]),
            None => value(param),
        }
    }

    /// The brightness of a note has changed before its strike has begun, and with it what the strike reads.
    pub(crate) fn shade(&mut self, timbre: f32) {
        self.set_source(Source::Timbre, timbre);
        self.struck_offsets = self.bus.offsets(&self.sources, &self.settings.amounts);
    }

    /// The key has come up.
    pub(crate) fn release(&mut self, velocity: f32) {
        self.set_source(Source::ReleaseVelocity, velocity);
        self.moving.envelopes.iter_mut().for_each(Envelope::release);
    }

    /// Lets time pass.
    pub(crate) fn advance(&mut self, seconds: f64) {
        if !self.bus.reads_moving() {
            return;
        }
        if seconds == self.ahead_seconds {
            self.moving = self.ahead;
        } else {
            self.moving.advance(&self.bus, &self.rates, seconds);
        }
        self.rates = self.next_rates;
    }

    /// The note has slid to another pitch, in semitones on the MIDI scale.
    pub(crate) fn set_pitch(&mut self, pitch: f64) {
        self.set_source(Source::Key, key_position(pitch));
    }

    /// Takes over the instrument's present settings, or those of this note alone, and where its oscillators are.
    pub(crate) fn follow(&mut self, settings: &Settings, are_own: bool, shared: &SharedLfos) {
        if are_own || settings.serial != self.settings.serial {
            (self.settings, self.unsettled) = (*settings, true);
        }
        self.share(shared);
    }

    /// The routes, for [`Settings`] of this note alone.
    pub(crate) fn bus(&self) -> &Bus {
        &self.bus
    }

    /// Finds where the destinations are to be in some seconds, and hands each with its value to `set`.
    pub(crate) fn control(&mut self, seconds: f64, positions: &Positions, mut set: impl FnMut(Param, f32)) {
        let moved = self.look_ahead(seconds, positions);
        self.next_rates = self.settings.rates;
        for (place, destination) in self.bus.destinations().iter().enumerate() {
            if moved & 1 << place != 0 {
                self.values[place] = destination.moved(self.settings.bases[place], self.offsets[place]);
            }
            let value = self.values[place];
            match destination.target {
                Target::Strike => {}
                Target::Control => set(destination.param, value),
                Target::Lfo(index) if self.settings.are_synchronised[usize::from(index)] => {}
                Target::Lfo(index) => self.next_rates[usize::from(index)] = f64::from(value),
            }
        }
        if seconds == 0.0 {
            self.rates = self.next_rates;
        }
    }

    fn share(&mut self, shared: &SharedLfos) {
        if !self.bus.reads_moving() {
            return;
        }
        for (index, common) in shared.0.iter().enumerate().filter(|(index, _)| self.are_shared[*index]) {
            self.moving.lfos[index] = *common;
            self.moving.lfos[index].advance(self.phases[index]);
        }
    }

    /// Reads the sources as they will be in some seconds, and finds how far they move what the routes lead to. Returns a bit
    /// for each destination of which that may have changed.
    fn look_ahead(&mut self, seconds: f64, positions: &Positions) -> u32 {
        for (source, value) in [
            (Source::Pressure, positions.pressure),
            (Source::Timbre, positions.timbre),
            (Source::Bend, positions.bend),
            (Source::Wheel, positions.wheel),
            (Source::Breath, positions.breath),
            (Source::Expression, positions.expression),
        ] {
            self.set_source(source, value);
        }
        if self.bus.reads_moving() {
            self.move_sources(seconds);
        }
        let moved = if std::mem::take(&mut self.unsettled) {
            let macros = &mut self.sources[Source::Macro1 as usize..];
            macros.iter_mut().zip(self.settings.macros).for_each(|(source, value)| *source = value);
            u32::MAX
        } else {
            self.bus.moved_by(self.changed & self.bus.read())
        };
        self.changed = 0;
        if moved != 0 {
            self.bus.update(&mut self.offsets, moved, &self.sources, &self.settings.amounts);
        }
        debug_assert_eq!(
            self.bus.offsets(&self.sources, &self.settings.amounts)[..self.bus.destinations().len()],
            self.offsets[..self.bus.destinations().len()]
        );
        moved
    }

    /// Reads the sources that move by themselves as they will be in some seconds.
    fn move_sources(&mut self, seconds: f64) {
        (self.ahead, self.ahead_seconds) = (self.moving, seconds);
        self.ahead.advance(&self.bus, &self.rates, seconds);
        let Moving { lfos, envelopes, age } = self.ahead;
        for (index, lfo) in lfos.iter().enumerate() {
            if self.bus.reads_nth(Source::Lfo1, index) {
                let fade = if age < self.fades[index] { (age / self.fades[index]) as f32 } else { 1.0 };
                self.set_nth(Source::Lfo1, index, fade * lfo.value(self.settings.shapes[index]));
            }
        }
        for (index, envelope) in envelopes.iter().enumerate() {
            if self.bus.reads_nth(Source::Envelope1, index) {
                self.set_nth(Source::Envelope1, index, envelope.level());
            }
        }
    }

    fn set_source(&mut self, source: Source, value: f32) {
        self.set_nth(source, 0, value);
    }

    /// Sets the source that is so many after `first`, and notes whether it has changed.
    fn set_nth(&mut self, first: Source, nth: usize, value: f32) {
        let source = &mut self.sources[first as usize + nth];
        if *source != value {
            *source = value;
            self.changed |= bit(first) << nth;
        }
    }
}

/// Where a pitch lies for [`Source::Key`].
fn key_position(pitch: f64) -> f32 {
    ((pitch - 60.0) / 60.0).clamp(-1.0, 1.0) as f32
}
