//! The sources of a voice that change with time: its oscillators and envelopes, now and at the next control tick.

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
    /// The state now and the state `ahead_seconds` later, which is usually the next control tick. `now` is the index of the
    /// current state: if no event ends the tick early, the two swap roles and nothing is computed twice.
    states: [State; 2],
    now: usize,
    ahead_seconds: f64,
    times: [Times; ENVELOPES],
    /// Phase at which each oscillator starts, 0–1 of a cycle.
    phases: [f64; LFOS],
    /// Fade-in time of each oscillator in seconds.
    fades: [f64; LFOS],
    /// Whether each oscillator takes its phase from the instrument's shared one. Copied here, since a voice can outlive
    /// its patch and must then run alone.
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
}

impl Moving {
    /// At rest.
    pub(super) const REST: Self = Self {
        states: [State::REST; 2],
        now: 0,
        ahead_seconds: 0.0,
        times: [Times::NONE; ENVELOPES],
        phases: [0.0; LFOS],
        fades: [0.0; LFOS],
        are_shared: [false; LFOS],
    };

    /// Sets the start phases and which oscillators are shared. The `first` strike of a note also starts the
    /// oscillators, with random numbers of a `stream`.
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

    /// Starts the envelopes and sets the fade-in times, both as modulated at the strike.
    pub(super) fn start(&mut self, times: [Times; ENVELOPES], fades: [f64; LFOS]) {
        self.fades = fades;
        let state = &mut self.states[self.now];
        for ((envelope, times), before) in state.envelopes.iter_mut().zip(&times).zip(&self.times) {
            envelope.strike(times, before);
        }
        self.times = times;
        self.states[1 - self.now] = *state;
    }

    /// Handles the release of the key: envelopes go to their release stage.
    pub(super) fn release(&mut self) {
        let envelopes = self.states[self.now].envelopes.iter_mut();
        envelopes.zip(&self.times).for_each(|(envelope, times)| envelope.release(times));
    }

    /// How far the oscillators are in their cycle, and the envelopes in their stages; −1 for those that no route reads.
    pub(super) fn progress(&self, bus: &Bus) -> [f32; LFOS + ENVELOPES] {
        let state = &self.states[self.now];
        std::array::from_fn(|index| match index.checked_sub(LFOS) {
            None if bus.reads_nth(Source::Lfo1, index) => state.lfos[index].phase(),
            Some(index) if bus.reads_nth(Source::Envelope1, index) => {
                state.envelopes[index].progress(&self.times[index])
            }
            _ => -1.0,
        })
    }

    /// Copies the phases of the instrument's oscillators to those that are shared.
    pub(super) fn share(&mut self, shared: &SharedLfos) {
        for (index, common) in shared.0.iter().enumerate().filter(|(index, _)| self.are_shared[*index]) {
            let lfo = &mut self.states[self.now].lfos[index];
            *lfo = common.after(self.phases[index]);
        }
    }

    /// Advances by some seconds, with these rates in Hz.
    pub(super) fn advance(&mut self, bus: &Bus, rates: &[f64; LFOS], seconds: f64) {
        if seconds != self.ahead_seconds {
            // An event has ended the tick early.
            self.compute_ahead(bus, rates, seconds);
        }
        self.now = 1 - self.now;
    }

    /// Computes, into the other state, the sources that routes read as they will be in some seconds.
    fn compute_ahead(&mut self, bus: &Bus, rates: &[f64; LFOS], seconds: f64) {
        self.ahead_seconds = seconds;
        let [first, second] = &mut self.states;
        let (now, ahead) = if self.now == 0 { (first, second) } else { (second, first) };
        ahead.age = now.age + seconds;
        for (index, rate) in rates.iter().enumerate() {
            if bus.reads_nth(Source::Lfo1, index) {
                ahead.lfos[index] = now.lfos[index].after(rate * seconds);
            }
        }
        for (index, times) in self.times.iter().enumerate() {
            if bus.reads_nth(Source::Envelope1, index) {
                ahead.envelopes[index] = now.envelopes[index].after(seconds, times);
            }
        }
    }

    /// Computes the sources as they will be in some seconds. Calls `set` for each one that routes read, with the first
    /// source of its kind, its index from there, and its value.
    pub(super) fn look_ahead(
        &mut self,
        bus: &Bus,
        rates: &[f64; LFOS],
        shapes: &[Shape; LFOS],
        seconds: f64,
        mut set: impl FnMut(Source, usize, f32),
    ) {
        self.compute_ahead(bus, rates, seconds);
        let ahead = &self.states[1 - self.now];
        for (index, shape) in shapes.iter().enumerate() {
            if bus.reads_nth(Source::Lfo1, index) {
                let fade = self.fades[index];
                let fade = if ahead.age < fade { (ahead.age / fade) as f32 } else { 1.0 };
                set(Source::Lfo1, index, fade * ahead.lfos[index].value(*shape));
            }
        }
        for (index, times) in self.times.iter().enumerate() {
            if bus.reads_nth(Source::Envelope1, index) {
                set(Source::Envelope1, index, ahead.envelopes[index].level(times));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Param;
    use crate::patch::routes::{Route, Routes};

    const TICK: f64 = 32.0 / 48_000.0;
    const RATES: [f64; LFOS] = [5.0, 0.7, 11.0];
    const SHAPES: [Shape; LFOS] = [Shape::Sine, Shape::Triangle, Shape::Drift];
    const SOURCES: [Source; 5] = [Source::Lfo1, Source::Lfo2, Source::Lfo3, Source::Envelope1, Source::Envelope2];

    /// Moving sources of a note that has just been struck, and a bus that reads all of them.
    fn struck() -> (Moving, Bus) {
        let mut routes = Routes::NONE;
        for (place, source) in SOURCES.into_iter().enumerate() {
            routes.set(place, Some(Route::linear(source, Param::Tune)));
        }
        let mut moving = Moving::REST;
        moving.strike([0.0, 0.25, 0.5], [false; LFOS], true, 7);
        let times = |index| Times::new(index, |param| f64::from(param.info().default));
        moving.start(std::array::from_fn(times), [0.0, 0.01, 0.0]);
        (moving, Bus::new(&routes))
    }

    /// The values of all sources `frames` frames from now.
    fn ahead(moving: &mut Moving, bus: &Bus, frames: f64) -> [f32; 5] {
        let mut values = [f32::NAN; 5];
        moving.look_ahead(bus, &RATES, &SHAPES, frames / 48_000.0, |first, index, value| {
            values[index + if first == Source::Lfo1 { 0 } else { LFOS }] = value;
        });
        values
    }

    #[test]
    fn a_tick_that_events_cut_short_ends_where_a_whole_one_does() {
        for is_released in [false, true] {
            let [(mut whole, bus), (mut cut, _)] = [struck(), struck()];
            for tick in 0..50 {
                let values = ahead(&mut whole, &bus, 32.0);
                assert!(values.iter().all(|value| value.is_finite()), "{values:?}");
                whole.advance(&bus, &RATES, TICK);
                // The first look ahead reaches the end of the tick, but an event comes after 7 frames.
                ahead(&mut cut, &bus, 32.0);
                cut.advance(&bus, &RATES, 7.0 / 48_000.0);
                let rest = ahead(&mut cut, &bus, 25.0);
                cut.advance(&bus, &RATES, 25.0 / 48_000.0);
                for (whole, rest) in values.iter().zip(rest) {
                    assert!((whole - rest).abs() < 1e-5, "tick {tick}, released: {is_released}: {whole} {rest}");
                }
                if is_released && tick == 20 {
                    whole.release();
                    cut.release();
                }
            }
        }
    }
}
