//! The modulation of one voice: the present values of its sources, and the destinations' values at each control tick.

use super::bus::{Bus, places};
use super::destination::Target;
use super::envelope::Times;
use super::link::{Amounts, Mover, Offsets, SOURCES, SOURCES_AT_REST, Sources, bit};
use super::moving::{ENVELOPES, Moving};
use super::settings::{LFOS, Settings, SharedLfos, of_lfo};
use crate::dsp::random;
use crate::params::{Choice, Param, Scope};
use crate::patch::routes::{MAX_ROUTES, Source};

/// Stream number of a strike's random modulation source. It differs from the stream of the strike's noise.
const STRIKE_STREAM: u64 = 0x5354_5249_4b45;

/// Positions of the controllers that routes can read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Positions {
    pub(crate) pressure: f32,
    pub(crate) timbre: f32,
    pub(crate) bend: f32,
    pub(crate) wheel: f32,
    pub(crate) breath: f32,
    pub(crate) expression: f32,
}

impl Positions {
    /// The sources that they are.
    pub(super) fn sources(&self) -> [(Source, f32); 6] {
        [
            (Source::Pressure, self.pressure),
            (Source::Timbre, self.timbre),
            (Source::Bend, self.bend),
            (Source::Wheel, self.wheel),
            (Source::Breath, self.breath),
            (Source::Expression, self.expression),
        ]
    }
}

/// Values that are set at a strike and stay until the next one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Struck {
    pub(crate) velocity: f32,
    /// In semitones on the MIDI scale.
    pub(crate) pitch: f64,
    pub(crate) seed: u64,
    /// Number of the note: each new note has the next one.
    pub(crate) serial: u64,
}

impl Struck {
    /// The stream of random numbers of the strike.
    fn stream(&self) -> u64 {
        random::key(self.seed ^ STRIKE_STREAM, self.serial)
    }

    /// The sources that a strike sets.
    pub(super) fn sources(&self) -> [(Source, f32); 5] {
        [
            (Source::Velocity, self.velocity),
            (Source::ReleaseVelocity, 0.0),
            (Source::Key, Source::key_at(self.pitch)),
            (Source::Random, random::uniform(self.stream(), 0)),
            (Source::Alternation, if self.serial.is_multiple_of(2) { 1.0 } else { -1.0 }),
        ]
    }
}

/// The modulation of one voice. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Modulators {
    bus: Bus,
    settings: Settings,
    /// Values of all sources. The values of the macros include the offsets from routes.
    sources: Sources,
    /// Amounts of the routes, including the offsets from routes.
    amounts: Amounts,
    /// The controllers at the last control tick.
    positions: Positions,
    /// Sources that have changed since the last control tick, one bit each.
    changed: u32,
    /// Whether the next control tick must compute every destination, since the settings have changed or the controls were
    /// replaced.
    unsettled: bool,
    /// Offsets of the destinations in knob travel: at the last control tick (only those that sounding notes follow),
    /// and, in the next field, of all of them at the last strike.
    offsets: Offsets,
    struck_offsets: Offsets,
    /// Modulated rates of the oscillators in Hz: until the next control tick, and, in the next field, from that tick
    /// on.
    rates: [f64; LFOS],
    next_rates: [f64; LFOS],
    moving: Moving,
}

impl Modulators {
    /// Modulators without routes.
    pub(crate) fn none() -> Self {
        Self {
            bus: Bus::EMPTY,
            settings: Settings::STILL,
            sources: SOURCES_AT_REST,
            amounts: [0.0; MAX_ROUTES],
            positions: Positions::default(),
            changed: 0,
            unsettled: true,
            offsets: [0.0; MAX_ROUTES],
            struck_offsets: [0.0; MAX_ROUTES],
            rates: [0.0; LFOS],
            next_rates: [0.0; LFOS],
            moving: Moving::REST,
        }
    }

    /// Whether there are no routes, so that there is nothing to compute.
    pub(crate) fn are_idle(&self) -> bool {
        self.bus.is_empty()
    }

    /// Whether oscillators or envelopes modulate a parameter that decides when a note is over.
    pub(crate) fn move_the_end(&self) -> bool {
        self.bus.moves_the_end()
    }

    /// Whether any route reads the source.
    pub(crate) fn reads(&self, source: Source) -> bool {
        self.bus.reads(source)
    }

    /// Copies the routes of an instrument. A voice keeps the routes that it was started with until it ends.
    pub(crate) fn load(&mut self, bus: &Bus) {
        if !(bus.is_empty() && self.are_idle()) {
            self.bus = *bus;
        }
    }

    /// Sets the sources for a strike. `positions` are the controllers now, `value` reads the instrument's parameters.
    /// The `first` strike of a note also starts the oscillators.
    pub(crate) fn strike(
        &mut self,
        struck: &Struck,
        positions: &Positions,
        settings: &Settings,
        shared: &SharedLfos,
        value: impl Fn(Param) -> f32,
        first: bool,
    ) {
        (self.settings, self.unsettled) = (*settings, true);
        struck.sources().into_iter().for_each(|(source, value)| self.set_source(source, value));
        let phases = std::array::from_fn(|index| f64::from(value(of_lfo(Param::Lfo1Phase, index))) * 0.01);
        let is_shared = |index| Scope::from_value(value(of_lfo(Param::Lfo1Scope, index))) == Scope::Shared;
        self.moving.strike(phases, std::array::from_fn(is_shared), first, struck.stream());
        self.share(shared);
        if first {
            (self.rates, self.next_rates) = (settings.rates, settings.rates);
        }
        // Envelope times and fades can be destinations of routes, so they are computed from the sources before
        // envelopes start.
        self.look_ahead(0.0, positions);
        self.struck_offsets = self.all_offsets();
        let times = |index| Times::new(index, |param| f64::from(self.struck_value(param, &value)));
        let fade = |index| f64::from(self.struck_value(of_lfo(Param::Lfo1Fade, index), &value));
        let (times, fades) = (std::array::from_fn(times), std::array::from_fn(fade));
        self.moving.start(times, fades);
        // Makes the first control tick compute the values of all destinations.
        self.unsettled = true;
    }

    /// The modulated value of a parameter at the strike.
    pub(crate) fn struck_value(&self, param: Param, value: impl Fn(Param) -> f32) -> f32 {
        let place = self.bus.destinations().iter().position(|destination| destination.param == param);
        match place {
            Some(place) => self.bus.destinations()[place].moved(value(param), self.struck_offsets[place]),
            None => value(param),
        }
    }

    /// Calls `tell` with each destination and its value at the last control tick. A destination that only strikes read has the
    /// value of the last strike.
    pub(crate) fn each_value(&self, mut tell: impl FnMut(Param, f32)) {
        for (place, destination) in self.bus.destinations().iter().enumerate() {
            let base = self.settings.bases[place];
            let value = match (Mover::of(destination.param), destination.target) {
                (Some(Mover::Amount(route)), _) => 100.0 * self.amounts[usize::from(route)],
                (Some(Mover::Macro(index)), _) => 100.0 * self.sources[Source::Macro1 as usize + usize::from(index)],
                (None, Target::Strike) => destination.moved(base, self.struck_offsets[place]),
                (None, Target::Lfo(index)) if self.settings.are_synchronised[usize::from(index)] => continue,
                (None, Target::Control | Target::Behind | Target::Lfo(_)) => {
                    destination.moved(base, self.offsets[place])
                }
            };
            tell(destination.param, value);
        }
    }

    /// The values of all sources.
    pub(crate) fn sources(&self) -> [f32; SOURCES] {
        std::array::from_fn(|source| self.sources[source])
    }

    /// How far oscillators and envelopes are.
    pub(crate) fn progress(&self) -> [f32; LFOS + ENVELOPES] {
        self.moving.progress(&self.bus)
    }

    /// Sets the note's brightness between the setup of the strike and its first frame, and computes the strike's offsets
    /// again.
    pub(crate) fn shade(&mut self, timbre: f32) {
        self.set_source(Source::Timbre, timbre);
        self.struck_offsets = self.all_offsets();
    }

    /// Handles the release of the key, at a velocity 0–1.
    pub(crate) fn release(&mut self, velocity: f32) {
        self.set_source(Source::ReleaseVelocity, velocity);
        self.moving.release();
    }

    /// Advances oscillators and envelopes by some seconds.
    pub(crate) fn advance(&mut self, seconds: f64) {
        if self.bus.reads_moving() {
            self.moving.advance(&self.bus, &self.rates, seconds);
            self.rates = self.next_rates;
        }
    }

    /// Sets the note's pitch after a slide, in semitones on the MIDI scale.
    pub(crate) fn set_pitch(&mut self, pitch: f64) {
        self.set_source(Source::Key, Source::key_at(pitch));
    }

    /// Copies the settings, if there are new ones, and the phases of the shared oscillators. With new settings come new
    /// controls without modulation, so the next control tick computes every destination.
    pub(crate) fn follow(&mut self, settings: Option<&Settings>, shared: &SharedLfos) {
        if let Some(settings) = settings {
            (self.settings, self.unsettled) = (*settings, true);
        }
        self.share(shared);
    }

    /// The routes of the voice, to make [`Settings`] for this note only.
    pub(crate) fn bus(&self) -> &Bus {
        &self.bus
    }

    /// Whether [`Modulators::control`] would change nothing, since no source has moved since the last control tick.
    pub(crate) fn are_still(&self, positions: &Positions) -> bool {
        !self.unsettled && self.changed == 0 && !self.bus.reads_moving() && *positions == self.positions
    }

    /// Computes the destinations for a time `seconds` from now. Calls `set` with the parameter and the value of each
    /// destination that may have changed since the control tick before.
    pub(crate) fn control(&mut self, seconds: f64, positions: &Positions, mut set: impl FnMut(Param, f32)) {
        let unsettled = self.unsettled;
        let moved = self.look_ahead(seconds, positions);
        if unsettled {
            self.next_rates = self.settings.rates;
        }
        let moved = moved & self.bus.followed();
        if moved != 0 {
            self.offsets = [0.0; MAX_ROUTES];
            self.bus.add_offsets(&self.sources, &self.amounts, &mut self.offsets);
        }
        for place in places(moved) {
            let destination = &self.bus.destinations()[place];
            let value = destination.moved(self.settings.bases[place], self.offsets[place]);
            match destination.target {
                Target::Strike | Target::Behind => {}
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

    /// Reads the sources as they will be in some seconds, and applies the routes that modulate macros and amounts.
    /// Returns a bit for each destination whose offset may have changed.
    fn look_ahead(&mut self, seconds: f64, positions: &Positions) -> u32 {
        self.positions = *positions;
        for (source, value) in positions.sources() {
            // A source that no route reads need not be written and compared.
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

    /// The offsets of all destinations, computed from the sources without the results of earlier ticks.
    fn all_offsets(&self) -> Offsets {
        let mut sources = self.sources;
        set_macros(&mut sources, &self.settings);
        self.bus.offsets(sources, self.settings.amounts)
    }

    fn set_source(&mut self, source: Source, value: f32) {
        set_nth(&mut self.sources, &mut self.changed, source, 0, value);
    }
}

/// Sets the `nth` source after `first` (0 is `first` itself), and sets its bit in `changed` if the value is new.
fn set_nth(sources: &mut Sources, changed: &mut u32, first: Source, nth: usize, value: f32) {
    let source = &mut sources[first as usize + nth];
    *changed |= u32::from(*source != value) * (bit(first) << nth);
    *source = value;
}

/// Resets the macros to their values in the settings.
pub(super) fn set_macros(sources: &mut Sources, settings: &Settings) {
    let macros = &mut sources[Source::Macro1 as usize..];
    macros.iter_mut().zip(settings.macros).for_each(|(source, value)| *source = value);
}
