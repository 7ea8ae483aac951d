//! Parameter values that the modulators of all voices of an instrument use, and the oscillators that notes can share.

use super::bus::Bus;
use super::lfo::Lfo;
use super::link::Amounts;
use crate::dsp::random;
use crate::params::{Choice, NoteValue, PARAMS, Param, Shape};
use crate::patch::routes::{MAX_ROUTES, amount_param};

/// Number of low-frequency oscillators (LFOs).
pub(super) const LFOS: usize = 3;

/// Random number stream of the first LFO; the others follow.
pub(super) const LFO_STREAM: u64 = 0x4c46_4f00;

/// The parameter of LFO `index` that corresponds to `first`, a parameter of the first LFO.
pub(super) fn of_lfo(first: Param, index: usize) -> Param {
    let rows = Param::Lfo2Rate as usize - Param::Lfo1Rate as usize;
    PARAMS[first as usize + index * rows].param
}

/// Values that voices use: those of the modulators' own parameters and of the routes' destinations. Plain data.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    /// Rates in Hz.
    pub(super) rates: [f64; LFOS],
    /// Whether the rate follows the tempo. Such a rate cannot be modulated.
    pub(super) are_synchronised: [bool; LFOS],
    pub(super) shapes: [Shape; LFOS],
    pub(super) macros: [f32; 8],
    pub(super) amounts: Amounts,
    /// Values of the destinations before modulation, in the bus's order.
    pub(super) bases: [f32; MAX_ROUTES],
}

impl Settings {
    /// Settings without any modulation.
    pub(crate) const STILL: Self = Self {
        rates: [0.0; LFOS],
        are_synchronised: [false; LFOS],
        shapes: [Shape::Sine; LFOS],
        macros: [0.0; 8],
        amounts: [0.0; MAX_ROUTES],
        bases: [0.0; MAX_ROUTES],
    };

    /// Settings with parameters from `value`, at a tempo in beats per second.
    pub(crate) fn new(bus: &Bus, value: impl Fn(Param) -> f32, beat_rate: f64) -> Self {
        let mut bases = [0.0; MAX_ROUTES];
        bus.destinations().iter().zip(&mut bases).for_each(|(destination, base)| *base = value(destination.param));
        let sync = |index| NoteValue::from_value(value(of_lfo(Param::Lfo1Sync, index)));
        Self {
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
}

/// LFOs that all voices of an instrument can share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SharedLfos(pub(super) [Lfo; LFOS]);

impl SharedLfos {
    /// LFOs at the start of their cycles, with random numbers from a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(std::array::from_fn(|index| Lfo::new(0.0, random::key(seed, LFO_STREAM + index as u64))))
    }

    /// Advances by some seconds.
    pub(crate) fn advance(&mut self, settings: &Settings, seconds: f64) {
        self.0.iter_mut().zip(settings.rates).for_each(|(lfo, rate)| *lfo = lfo.after(rate * seconds));
    }
}
