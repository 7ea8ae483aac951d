//! The hammer of a voice: how heavy and how fast it is, and how the modes give way to it.

use super::values::StruckValues;
use crate::dsp::cells::{Cells, MAX_CELLS};
use crate::dsp::exciter::{Hammer, HammerLaw, MOST_GIVEN};
use crate::dsp::mode_bank::MAX_MODES;
use crate::params::Param;
use crate::patch::Mode;
use libm::sin;
use std::f64::consts::PI;

/// Mass of a hammer of 1 over that of the body, times half the period of the note, in seconds: pianos have 1.1 to 1.4 ms in all
/// octaves (table I of Chaigne and Askenfelt, "Numerical simulations of piano strings" II, JASA 95, 1994).
const HEAVINESS: f64 = 0.0012;

/// The point of the strike as a share of the length: that of pianos but for their highest octaves.
const PLACE: f64 = 0.12;

/// Modes whose ratios differ by less than this share are the same partial of several strings, which share the hammer.
const CHOIR: f32 = 0.005;

/// Area of a hammer's force over its momentum: a piano's hammer comes back with half of its speed, more or less, so that a strike
/// is as loud as one by another pulse.
const REBOUND: f64 = 1.5;

/// The most that a hammer gives, as a multiple of the strike's area.
pub(super) const MOST: f64 = MOST_GIVEN / REBOUND;

/// A hammer is caught after this many seconds.
const CAUGHT: f64 = 0.05;

/// The hammer of a voice. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hammering {
    pub(super) hammer: Hammer,
    /// The last strike's hammer, and whether it has not begun to fly, since the modes had no pitch yet.
    law: HammerLaw,
    is_waiting: bool,
}

impl Hammering {
    /// No hammer.
    pub(super) const OFF: Self = Self { hammer: Hammer::AWAY, law: HammerLaw::NONE, is_waiting: false };

    /// Prepares a strike of these areas of its force, the whole strike's and that of a full one. `contact` is the contact time at a
    /// wall in frames.
    pub(super) fn strike(&mut self, values: &StruckValues, [area, full]: [f64; 2], contact: f64) {
        let mass = values.get(Param::MalletMass);
        let speed = |area: f64| area / (REBOUND * mass);
        let longest = (CAUGHT * values.instrument.sample_rate) as u32;
        let (speed, full_speed) = (speed(area), speed(full.max(area)));
        self.law = HammerLaw { mass, speed, full_speed, contact, longest, ..HammerLaw::NONE };
        (self.hammer, self.is_waiting) = (Hammer::AWAY, true);
    }

    /// Prepares the last strike again, if it has just been made: the modes' gains are new.
    pub(super) fn prepare_again(&mut self) {
        self.is_waiting = self.is_on();
    }

    /// Lets a prepared hammer fly, on modes that have their pitch. `frequency` is the note's in Hz.
    pub(super) fn begin(&mut self, values: &StruckValues, frequency: f64, bank: &mut Cells) {
        if !std::mem::take(&mut self.is_waiting) {
            return;
        }
        let weights = strengths(values.modes().as_slice(), frequency, PLACE);
        let [compliance, stillness] = bank.set_touched(MAX_CELLS, |m, push| [push, weights[m]]);
        self.hammer = Hammer::new(HammerLaw { compliance, stillness, ..self.law });
    }

    /// Takes back a hammer that has not begun to fly: the patch of its note was replaced in the same frame.
    pub(super) fn give_up(&mut self) {
        self.is_waiting = false;
    }

    /// Whether a hammer touches the body, or is about to.
    pub(super) fn is_on(&self) -> bool {
        self.is_waiting || self.hammer.is_there()
    }

    /// Frames until the hammer is gone, at most.
    pub(super) fn frames_left(&self) -> u32 {
        if self.is_waiting { self.law.longest } else { self.hammer.frames_left() }
    }
}

/// The speed that an impulse of 1 gives the body at a `place`, a share of its length, by each mode, where a hammer has a mass of 1.
/// `frequency` is the note's in Hz. For every body the place counts as on a string.
pub(super) fn strengths(modes: &[Mode], frequency: f64, place: f64) -> [f64; MAX_CELLS * MAX_MODES] {
    let mut weights = [0.0; MAX_CELLS * MAX_MODES];
    let mut from = 0;
    while from < modes.len() {
        let first = modes[from].ratio;
        let (choir, of_choir) = (&modes[from..], first..=first * (1.0 + CHOIR));
        let choir = &choir[..choir.iter().position(|mode| !of_choir.contains(&mode.ratio)).unwrap_or(choir.len())];
        let struck = choir.iter().filter(|mode| mode.strike > 0.0).count().max(1);
        let shape = sin(PI * place * f64::from(modes[from].ratio));
        weights[from..from + choir.len()].fill(4.0 * frequency * HEAVINESS * shape * shape / struck as f64);
        from += choir.len();
    }
    weights
}
