//! The breath of a voice: the pressure in the mouth, the mouthpiece, and what the tube's modes take and give.

use super::line::Line;
use super::values::StruckValues;
use crate::dsp::cells::Cells;
use crate::dsp::exciter::Mouthpiece;
use crate::dsp::mode_bank::MAX_MODES;
use crate::engine::controls::Controls;
use crate::engine::gain::exciter_gain;
use crate::params::{Param, Valve as Kind};
use crate::sound::blown::{amplitude, contact, flow, law, share};
use libm::{exp, fabs, log2, rint, sqrt};

/// The breath comes within 5 % of its pressure in the attack time, and leaves in this many seconds.
const ATTACKS: f64 = 3.0;
const LEAVES: f64 = 0.03;

/// Extra pressure when the tongue lets go fully, as a share of the pressure, and the seconds in which it goes.
const TONGUE: f64 = 1.0;
const TONGUE_SECONDS: f64 = 0.06;

/// The pressure at which a tube's modes are heard as loudly as they are, and the halvings of it after which they get no softer.
const STEEP: f64 = 2.0;
const HALVINGS: f64 = 3.0;
/// Steps in one decibel per octave: a pressure that comes near its own gives the modes no new gains at every tick.
const SLOPES: f64 = 64.0;

/// A reed that is blown harder than this is let more open, so that it comes near the pressure of the second, but never shuts.
const GIVES_WAY: [f64; 2] = [0.8, 0.95];

/// The mouthpiece feels no mode that swings by more than this for a share of 1: some fifty times what the hardest breath gives.
const MOST_FELT: f64 = 100.0;

/// Pressure below which the breath is over.
const NO_BREATH: f64 = 1e-4;

/// The breath of a voice. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blowing {
    mouthpiece: Mouthpiece,
    kind: Kind,
    /// Amplitude of a mode whose level is 1, at a pressure (of a jet, a speed) of 1; 0 without breath.
    amplitude: f64,
    attack: f64,
    tongue: f64,
    pressure: Line,
    /// The pressure at the next control tick.
    reached: f64,
    /// Whether the modes have their contacts; and whether some are left out, so that all are placed again, by the knobs of then, until
    /// none is.
    is_placed: bool,
    leaves_out: bool,
    has_blown: bool,
}

/// A note as breath has it: its frequency with all bends and the sample rate in Hz, and the seconds since its strike.
pub(super) struct Blown {
    pub(super) frequency: f64,
    pub(super) sample_rate: f64,
    pub(super) age: f64,
}

impl Blowing {
    /// No breath.
    pub(super) const OFF: Self = Self {
        mouthpiece: Mouthpiece::REST,
        kind: Kind::Reed,
        amplitude: 0.0,
        attack: 0.0,
        tongue: 0.0,
        pressure: Line::ZERO,
        reached: 0.0,
        is_placed: false,
        leaves_out: false,
        has_blown: false,
    };

    /// Reads the breath's parameters at a strike. `key` is the strike's stream of random numbers, `count` that of unison voices.
    pub(super) fn strike(&mut self, values: &StruckValues, key: u64, count: usize) {
        self.kind = values.instrument.knobs.choice(Param::BreathValve);
        self.amplitude = amplitude(self.kind, exciter_gain(values.get(Param::BreathLevel))) / sqrt(count as f64);
        (self.attack, self.tongue) = (values.get(Param::BreathAttack), TONGUE * values.share(Param::BreathTongue));
        (self.mouthpiece.key, self.is_placed) = (key, false);
    }

    /// The tube has another length, or its modes have got other contacts: they need the mouthpiece's again.
    pub(super) fn lift(&mut self) {
        self.is_placed = false;
    }

    /// Whether there is breath in the tube, or about to be.
    pub(super) fn is_on(&self) -> bool {
        !self.pressure.is_zero()
    }

    /// Whether there has been breath since the voice began. The bloom keeps the energy that is heard and the mouthpiece that of the
    /// swing, so in turn they would let both grow without bound: a body that was blown does not bloom.
    pub(super) fn has_blown(&self) -> bool {
        self.has_blown
    }

    /// Whether breath drives a held note, or would as soon as it has a pressure.
    pub(super) fn may_blow(&self) -> bool {
        self.amplitude > 0.0
    }

    /// How much softer higher modes are heard, in decibels per octave, at most 0.
    ///
    /// A loud wave becomes steeper on its way through a long narrow bore, which brings energy from low partials to high ones: that
    /// makes brass brassy, and lips do not (Hirschberg, Gilbert, Msallam and Wijnands, 1996). Here the modes' own levels are those of
    /// the loudest breath, and a softer one leaves that out: a slope over the modes, no partial that the tube does not have.
    pub(super) fn slope(&self, controls: &Controls) -> f64 {
        if controls.breath_steepening == 0.0 || !self.may_blow() {
            return 0.0;
        }
        let halvings = log2(STEEP / self.reached).clamp(0.0, HALVINGS);
        rint(-SLOPES * controls.breath_steepening * halvings) / SLOPES
    }

    /// Starts a ramp of the pressure that ends in `frames` frames, and sets the mouthpiece. Without `values`, a breath whose modes have
    /// no contacts does not start, or ends.
    pub(super) fn control(
        &mut self,
        controls: &Controls,
        is_held: bool,
        values: Option<&StruckValues>,
        note: impl FnOnce() -> Blown,
        bank: &mut Cells,
        frames: usize,
    ) {
        let wanted = if is_held && self.may_blow() { f64::from(controls.breath_pressure) } else { 0.0 };
        if wanted == 0.0 && !self.is_on() {
            return;
        }
        self.has_blown = true;
        let Blown { frequency, sample_rate, age } = note();
        match values {
            Some(values) if !self.is_placed || self.leaves_out => self.place(values, frequency, sample_rate, bank),
            None if !self.is_placed => {
                // Its sound is gone, and nobody would end its ramp.
                (self.pressure, self.reached) = (Line::ZERO, 0.0);
                return;
            }
            _ => {}
        }
        let left = age / TONGUE_SECONDS;
        let tongued = self.spoken(wanted * (1.0 + self.tongue * exp(-left * left)));
        let seconds = if wanted > 0.0 { self.attack } else { LEAVES };
        let near = if seconds > 0.0 { exp(-ATTACKS * frames as f64 / (seconds * sample_rate)) } else { 0.0 };
        // An event between two ticks finds the pressure on its way.
        let present = if self.pressure.has_arrived() { self.reached } else { self.pressure.now().into() };
        self.reached = tongued + (present - tongued) * near;
        if wanted == 0.0 && self.reached < NO_BREATH {
            self.reached = 0.0;
        }
        self.pressure.aim(self.reached as f32, frames);
        self.mouthpiece.set(law(self.kind, controls.breath_lip, self.reached, frequency), sample_rate);
        self.mouthpiece.breath.opening = flow(controls.breath_opening) as f32;
        self.mouthpiece.breath.per_frame = (frequency / sample_rate) as f32;
        self.mouthpiece.breath.noise = controls.breath_noise;
    }

    /// What of a pressure the valve gets. No player blows a reed shut, which would end the note at its loudest.
    fn spoken(&self, pressure: f64) -> f64 {
        let [from, most] = GIVES_WAY;
        if self.kind != Kind::Reed || pressure <= from {
            return pressure;
        }
        most - (most - from) * exp((from - pressure) / (most - from))
    }

    /// Sets what the modes take and give.
    ///
    /// Both are in proportion to how loudly a mode is heard. So where routes tilt the levels from one strike to the next, a note that is
    /// struck again while it sounds is felt as another swing than it has. What breath could not have blown is then not felt at all, but
    /// rings on by itself: the mouthpiece would pass it on to modes that are heard louder, and to and fro without end.
    fn place(&mut self, values: &StruckValues, frequency: f64, sample_rate: f64, bank: &mut Cells) {
        (self.is_placed, self.leaves_out) = (true, false);
        let [levels, ..] = values.tilted_levels();
        let loudest = levels.iter().fold(0.0, |most, level| f64::max(most, fabs(*level)));
        let (mut contacts, mut shares) = ([[0.0; 2]; MAX_MODES], 0.0);
        for (m, (mode, (ratio, _, _, energy))) in
            values.modes().as_slice().iter().zip(bank.modes()).take(MAX_MODES).enumerate()
        {
            let share = share(mode, frequency * ratio, sample_rate);
            let [take, give] = contact(share, [levels[m], loudest], ratio, self.amplitude);
            if energy * fabs(give.into()) <= MOST_FELT * MOST_FELT * fabs(take.into()) {
                (contacts[m], shares) = ([take, give], shares + share);
            } else {
                self.leaves_out = true;
            }
        }
        self.mouthpiece.breath.shares = shares as f32;
        bank.set_contacts(|m| contacts[m]);
    }

    /// The breath of the next frames, if there is any.
    pub(super) fn blow(&mut self, frames: usize) -> Option<&mut Mouthpiece> {
        if !self.is_on() {
            return None;
        }
        (self.mouthpiece.breath.pressure, self.mouthpiece.breath.passed) = self.pressure.parts();
        self.pressure.advance(frames);
        Some(&mut self.mouthpiece)
    }
}
