//! The modulation of one voice: its sources as they are now, and what the routes make of them at each control tick.

use super::bus::{Bus, places};
use super::destination::Target;
use super::envelope::Times;
use super::link::{Amounts, Offsets, SOURCES, Sources, bit};
use super::moving::Moving;
use super::settings::{LFOS, Settings, SharedLfos, of_lfo};
use crate::dsp::random;
use crate::params::{Choice, Param, Scope};
use crate::patch::routes::{MAX_ROUTES, Source};

/// The stream of a strike's random numbers, beside that of its noise.
const STRIKE_STREAM: u64 = 0x5354_5249_4b45;

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
    /// Macros among them are where routes have moved them.
    sources: Sources,
    /// Amounts of the routes, where routes have moved them.
    amounts: Amounts,
    /// Sources that have changed since they were last looked at, as bits.
    changed: u32,
    /// All destinations are to be computed at the next control: settings have changed, or the controls were replaced.
    unsettled: bool,
    /// How far each destination of the bus is moved that sounding notes follow; and how far all were at the strike.
    offsets: Offsets,
    struck_offsets: Offsets,
    /// Rounds a second as they are modulated: until the next control, and from then on.
    rates: [f64; LFOS],
    next_rates: [f64; LFOS],
    moving: Moving,
}

impl Modulators {
    /// Without routes.
    pub(crate) fn none() -> Self {
        Self {
            bus: Bus::EMPTY,
            settings: Settings::STILL,
            sources: [0.0; SOURCES],
            amounts: [0.0; MAX_ROUTES],
            changed: 0,
            unsettled: true,
            offsets: [0.0; MAX_ROUTES],
            struck_offsets: [0.0; MAX_ROUTES],
            rates: [0.0; LFOS],
            next_rates: [0.0; LFOS],
            moving: Moving::REST,
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

    /// Whether any route reads the source.
    pub(crate) fn reads(&self, source: Source) -> bool {
        self.bus.reads(source)
    }

    /// Takes over the routes of an instrument. Those that a voice is started with are its own until it ends.
    pub(crate) fn load(&mut self, bus: &Bus) {
        if !(bus.is_empty() && self.are_idle()) {
            self.bus = *bus;
        }
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
        let strike = [
            (Source::Velocity, struck.velocity),
            (Source::ReleaseVelocity, 0.0),
            (Source::Key, key_position(struck.pitch)),
            (Source::Random, random::uniform(stream, 0)),
            (Source::Alternation, if struck.serial.is_multiple_of(2) { 1.0 } else { -1.0 }),
        ];
        strike.into_iter().for_each(|(source, value)| self.set_source(source, value));
        let phases = std::array::from_fn(|index| f64::from(value(of_lfo(Param::Lfo1Phase, index))) * 0.01);
        let is_shared = |index| Scope::from_value(value(of_lfo(Param::Lfo1Scope, index))) == Scope::Shared;
        self.moving.strike(phases, std::array::from_fn(is_shared), first, stream);
        self.share(shared);
        if first {
            (self.rates, self.next_rates) = (settings.rates, settings.rates);
        }
        // The envelopes' times and the fades follow from where the sources are before they start.
        self.look_ahead(0.0, positions);
        self.struck_offsets = self.all_offsets();
        let times = |index| Times::new(index, |param| f64::from(self.struck_value(param, &value)));
        let fade = |index| f64::from(self.struck_value(of_lfo(Param::Lfo1Fade, index), &value));
        let (times, fades) = (std::array::from_fn(times), std::array::from_fn(fade));
        self.moving.start(times, fades);
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
        self.struck_offsets = self.all_offsets();
    }

    /// The key has come up.
    pub(crate) fn release(&mut self, velocity: f32) {
        self.set_source(Source::ReleaseVelocity, velocity);
        self.moving.release();
    }

    /// Lets time pass.
    pub(crate) fn advance(&mut self, seconds: f64) {
        if self.bus.reads_moving() {
            self.moving.advance(&self.bus, &self.rates, seconds);
            self.rates = self.next_rates;
        }
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

    /// The controls were replaced by unmoved ones: the next control writes every destination again.
    pub(crate) fn unsettle(&mut self) {
        self.unsettled = true;
    }

    /// The routes, for [`Settings`] of this note alone.
    pub(crate) fn bus(&self) -> &Bus {
        &self.bus
    }

    /// Finds where the destinations are to be in some seconds, and hands each that may have changed since the control before
    /// to `set`, with its value.
    pub(crate) fn control(&mut self, seconds: f64, positions: &Positions, mut set: impl FnMut(Param, f32)) {
        let unsettled = self.unsettled;
        let moved = self.look_ahead(seconds, positions);
        if unsettled {
            self.next_rates = self.settings.rates;
        }
        for place in places(moved & self.bus.followed()) {
            let destination = &self.bus.destinations()[place];
            self.offsets[place] = self.bus.offset(place, &self.sources, &self.amounts);
            let value = destination.moved(self.settings.bases[place], self.offsets[place]);
            match destination.target {
                Target::Strike => {}
                Target::Control => set(destination.param, value),
                Target::Lfo(index) if self.settings.are_synchronised[usize::from(index)] => {}
                Target::Lfo(index) => self.next_rates[usize::from(index)] = f64::from(value),
            }
        }
        debug_assert!({
            let all = self.all_offsets();
            places(self.bus.followed()).all(|place| all[place] == self.offsets[place])
        });
        if seconds == 0.0 {
            self.rates = self.next_rates;
        }
    }

    fn share(&mut self, shared: &SharedLfos) {
        if self.bus.reads_moving() {
            self.moving.share(shared);
        }
    }

    /// Reads the sources as they will be in some seconds, and lets routes move others. Returns a bit for each destination that
    /// may be moved otherwise than before.
    fn look_ahead(&mut self, seconds: f64, positions: &Positions) -> u32 {
        for (source, value) in [
            (Source::Pressure, positions.pressure),
            (Source::Timbre, positions.timbre),
            (Source::Bend, positions.bend),
            (Source::Wheel, positions.wheel),
            (Source::Breath, positions.breath),
            (Source::Expression, positions.expression),
        ] {
            // Not read, it would be written and compared for nothing.
            if self.bus.reads(source) {
                self.set_source(source, value);
            }
        }
        if self.bus.reads_moving() {
            let Self { bus, settings, sources, changed, rates, moving, .. } = self;
            let set = |first, nth, value| set_nth(sources, changed, first, nth, value);
            moving.look_ahead(bus, rates, &settings.shapes, seconds, set);
        }
        let changed = std::mem::take(&mut self.changed);
        if std::mem::take(&mut self.unsettled) || changed & self.bus.read_by_movers() != 0 {
            set_macros(&mut self.sources, &self.settings);
            self.amounts = self.settings.amounts;
            self.bus.move_routes(&mut self.sources, &mut self.amounts);
            u32::MAX
        } else {
            self.bus.moved_by(changed)
        }
    }

    /// How far each destination is moved now, worked out from the beginning.
    fn all_offsets(&self) -> Offsets {
        let mut sources = self.sources;
        set_macros(&mut sources, &self.settings);
        self.bus.offsets(sources, self.settings.amounts)
    }

    fn set_source(&mut self, source: Source, value: f32) {
        set_nth(&mut self.sources, &mut self.changed, source, 0, value);
    }
}

/// Sets the source that is so many after `first`, and notes whether it has changed.
fn set_nth(sources: &mut Sources, changed: &mut u32, first: Source, nth: usize, value: f32) {
    let source = &mut sources[first as usize + nth];
    *changed |= u32::from(*source != value) * (bit(first) << nth);
    *source = value;
}

/// Puts the macros where the settings have them.
fn set_macros(sources: &mut Sources, settings: &Settings) {
    let macros = &mut sources[Source::Macro1 as usize..];
    macros.iter_mut().zip(settings.macros).for_each(|(source, value)| *source = value);
}

/// Where a pitch lies for [`Source::Key`].
fn key_position(pitch: f64) -> f32 {
    ((pitch - 60.0) / 60.0).clamp(-1.0, 1.0) as f32
}
