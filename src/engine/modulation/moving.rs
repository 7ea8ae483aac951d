//! The sources of a voice that move by themselves: its oscillators and envelopes, now and at the next control tick.

use super::bus::Bus;
use super::envelope::{Envelope, Times};
use super::lfo::Lfo;
use super::settings::{LFO_STREAM, LFOS, SharedLfos};
use crate::dsp::random;
use crate::params::Shape;
use crate::patch::routes::Source;

/// How many envelopes there are.
pub(super) const ENVELOPES: usize = 2;

/// Oscillators and envelopes of a voice. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving {
    /// As they are, and as they will be `ahead_seconds` later: at the next control tick, as a rule. `now` says which is which, so
    /// that a tick without events need not copy what it has found to be ahead.
    states: [State; 2],
    now: usize,
    ahead_seconds: f64,
    /// Share of a round at which each oscillator starts.
    phases: [f64; LFOS],
    /// Seconds in which it fades in.
    fades: [f64; LFOS],
    /// Whether it is where the shared one is. A copy of that: a voice that outlives its patch goes on by itself.
    are_shared: [bool; LFOS],
}

#[derive(Clone, Copy, Debug)]
struct State {
    lfos: [Lfo; LFOS],
    envelopes: [Envelope; ENVELOPES],
    /// Seconds since the strike.
    age: f64,
}

impl State {
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

impl Moving {
    /// At rest.
    pub(super) const REST: Self = Self {
        states: [State::REST; 2],
        now: 0,
        ahead_seconds: 0.0,
        phases: [0.0; LFOS],
        fades: [0.0; LFOS],
        are_shared: [false; LFOS],
    };

    /// A strike sets where the oscillators start and which are shared; a `first` one starts them, with random numbers of a
    /// `stream`.
    pub(super) fn strike(&mut self, phases: [f64; LFOS], are_shared: [bool; LFOS], first: bool, stream: u64) {
        (self.phases, self.are_shared, self.ahead_seconds) = (phases, are_shared, 0.0);
        let state = &mut self.states[self.now];
        state.age = 0.0;
        if first {
            let lfo = |index| Lfo::new(phases[index], random::key(stream, LFO_STREAM + index as u64));
            state.lfos = std::array::from_fn(lfo);
            state.envelopes = [Envelope::REST; ENVELOPES];
            self.fades = [0.0; LFOS];
        }
    }

    /// What the strike has found of envelopes and fades, and with it their start.
    pub(super) fn start(&mut self, times: [Times; ENVELOPES], fades: [f64; LFOS]) {
        self.fades = fades;
        let state = &mut self.states[self.now];
        state.envelopes.iter_mut().zip(times).for_each(|(envelope, times)| envelope.strike(times));
        self.states[1 - self.now] = *state;
    }

    /// The key has come up.
    pub(super) fn release(&mut self) {
        self.states[self.now].envelopes.iter_mut().for_each(Envelope::release);
    }

    /// Puts the oscillators that are shared where those of the instrument are.
    pub(super) fn share(&mut self, shared: &SharedLfos) {
        for (index, common) in shared.0.iter().enumerate().filter(|(index, _)| self.are_shared[*index]) {
            let lfo = &mut self.states[self.now].lfos[index];
            *lfo = *common;
            lfo.advance(self.phases[index]);
        }
    }

    /// Lets time pass, at these rates.
    pub(super) fn advance(&mut self, bus: &Bus, rates: &[f64; LFOS], seconds: f64) {
        if seconds == self.ahead_seconds {
            self.now = 1 - self.now;
        } else {
            self.states[self.now].advance(bus, rates, seconds);
        }
    }

    /// Hands the value that each source that is read will have in some seconds to `set`, as so many after a first one.
    pub(super) fn look_ahead(
        &mut self,
        bus: &Bus,
        rates: &[f64; LFOS],
        shapes: &[Shape; LFOS],
        seconds: f64,
        mut set: impl FnMut(Source, usize, f32),
    ) {
        self.ahead_seconds = seconds;
        let mut ahead = self.states[self.now];
        ahead.advance(bus, rates, seconds);
        for (index, lfo) in ahead.lfos.iter().enumerate().filter(|(index, _)| bus.reads_nth(Source::Lfo1, *index)) {
            let fade = if ahead.age < self.fades[index] { (ahead.age / self.fades[index]) as f32 } else { 1.0 };
            set(Source::Lfo1, index, fade * lfo.value(shapes[index]));
        }
        let envelopes = ahead.envelopes.iter().enumerate();
        for (index, envelope) in envelopes.filter(|(index, _)| bus.reads_nth(Source::Envelope1, *index)) {
            set(Source::Envelope1, index, envelope.level());
        }
        self.states[1 - self.now] = ahead;
    }
}
