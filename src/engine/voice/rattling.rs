//! The rattle of a voice: what the body hits as it swings.

use super::hammering::strengths;
use super::values::StruckValues;
use crate::dsp::cells::Cells;
use crate::dsp::exciter::{Rattle, RattleKind, RattleLaw};
use crate::dsp::mode_bank::MAX_MODES;
use crate::params::{Param, Rattle as Kind};
use crate::sound::contact::contact_time;
use libm::{fabs, sin, sqrt};
use std::f64::consts::{PI, TAU};

/// A mode that the strike does not move, such as those of wires and shell, hears the rattle without giving way to it: this share
/// of the weight of others.
const HEARD_ONLY: f64 = 0.01;

/// A point that a full strike gives less speed than this does not move.
const LEAST_SPEED: f64 = 1e-12;

/// The rattle feels no mode that swings further than so many full strikes at its antinode would make it swing now. Such a mode was moved
/// when it was heard louder: its swing would be thrown into modes that are heard louder now, and to and fro without end.
const MOST_FELT: f64 = 4.0;

/// Below this share of a full strike's energy, nothing rattles any more: −80 dB.
const STILL: f64 = 1e-8;

/// By this share the pitch may be off what a rattle began at. The modes take its force, and give their place, as at that pitch: further
/// off, each contact could add energy.
const DRIFT: f64 = 0.03;

/// The rattle of a voice. Real-time safe.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rattling {
    kind: Kind,
    rattle: Option<Rattle>,
    /// The pitch ratio of the modes when it began.
    ratio: f64,
    /// Whether the body has bloomed since the voice began.
    has_bloomed: bool,
}

impl Rattling {
    /// Nothing rattles.
    pub(super) const OFF: Self = Self { kind: Kind::Off, rattle: None, ratio: 1.0, has_bloomed: false };

    /// Prepares what a strike makes rattle; it begins at the next [`Rattling::control`].
    pub(super) fn strike(&mut self, kind: Kind) {
        (self.kind, self.rattle) = (kind, None);
    }

    /// Whether anything rattles, or may begin to.
    pub(super) fn is_on(&self) -> bool {
        self.kind != Kind::Off
    }

    /// Begins the rattle at a control tick, unless a hammer or a player touches the body. Begins it anew when the pitch has left that at
    /// which it began; while the pitch moves fast, it waits. Ends it when the body has nearly come to rest. `energy` is the body's, as a
    /// share of that of a full strike; `full` the force of that strike, `note` the note's frequency and the sample rate in Hz, and
    /// `ratio` the pitch at the next tick. Returns whether the modes have got its contacts.
    pub(super) fn control(
        &mut self,
        values: Option<&StruckValues>,
        [energy, full]: [f64; 2],
        note: [f64; 2],
        ratio: f64,
        is_touched: bool,
        bank: &mut Cells,
    ) -> bool {
        if !self.is_on() || is_touched {
            return false;
        }
        let is_near = |other: f64| (ratio / other - 1.0).abs() <= DRIFT;
        if !is_near(self.ratio) || bank.is_transposed() {
            self.interrupt();
        }
        if energy < STILL {
            self.strike(Kind::Off);
        } else if let (None, Some(values), Some(now)) = (&self.rattle, values, bank.pitch().filter(|now| is_near(*now)))
        {
            self.ratio = now;
            self.rattle = self.begin(values, full, note, bank);
            if self.rattle.is_none() {
                // A body that no strike moves hits nothing.
                self.strike(Kind::Off);
            }
            return true;
        }
        false
    }

    /// Prepares the modes, and finds the rattle's law; none if the body does not move under a strike.
    fn begin(
        &self,
        values: &StruckValues,
        full: f64,
        [frequency, sample_rate]: [f64; 2],
        bank: &mut Cells,
    ) -> Option<Rattle> {
        let modes = values.modes().as_slice();
        let place = values.share(Param::RattlePosition);
        let mut weights = strengths(modes, frequency, place);
        let [levels, ..] = values.tilted_levels();
        // A mode's level is that of an impulse at its antinode.
        let mut pushes = [0.0; MAX_MODES];
        for ((push, mode), level) in pushes.iter_mut().zip(modes).zip(levels) {
            *push = level * sin(PI * place * f64::from(mode.ratio));
        }
        if self.has_bloomed {
            weigh_as_heard(&mut weights[..MAX_MODES], &pushes);
        }
        let struck = |m: usize| if self.has_bloomed { 1.0 } else { f64::from(modes[m].strike) };
        // Speed and swing of the point after a full strike, from modes of any phases.
        let (mut speeds, mut swings) = (0.0, 0.0);
        for (m, mode) in modes.iter().enumerate().take(MAX_MODES) {
            let speed = full * weights[m] * struck(m);
            let swing = speed * sample_rate / (TAU * frequency * f64::from(mode.ratio));
            (speeds, swings) = (speeds + speed * speed, swings + swing * swing);
        }
        let (speed, swing) = (sqrt(speeds), sqrt(swings));
        if speed < LEAST_SPEED {
            return None;
        }
        let mut swing_of = [0.0; MAX_MODES];
        swing_of.iter_mut().zip(bank.masses()).for_each(|(swing, (_, energy))| *swing = sqrt(energy.into()));
        let touch = |m: usize| {
            let weight = weights[m] * struck(m).max(HEARD_ONLY);
            let is_felt = swing_of[m] <= MOST_FELT * full * fabs(levels[m]);
            if is_felt { [pushes[m], weight] } else { [0.0; 2] }
        };
        let compliance = bank.set_touched(1, |m, _| touch(m)).iter().sum();
        let kind = match self.kind {
            Kind::Loose => RattleKind::Loose {
                mass: values.get(Param::RattleMass),
                pull: 2.0 * speed * values.get(Param::RattleRate) / sample_rate,
            },
            Kind::Off | Kind::Edge => RattleKind::Edge { gap: swing * values.share(Param::RattleGap) },
        };
        let contact = contact_time(values.share(Param::RattleHardness)) * sample_rate;
        Some(Rattle::new(RattleLaw { kind, speed, contact, compliance }))
    }

    /// What rattles in the next frames.
    pub(super) fn rattle(&mut self) -> Option<&mut Rattle> {
        self.rattle.as_mut()
    }

    /// A hammer or a player has taken the modes' contacts: the rattle begins anew.
    pub(super) fn interrupt(&mut self) {
        self.rattle = None;
    }

    /// The body blooms: the point that rattles is suddenly elsewhere. So the rattle begins anew at every control tick, and a loose mass
    /// hardly leaves the body.
    pub(super) fn bloom(&mut self) {
        (self.rattle, self.has_bloomed) = (None, true);
    }
}

/// Gives all modes the same energy for the same level, as the bloom counts it, in place of that of their swing; the body as a whole gives
/// way as before. What one of them moved to modes that are heavy for the other would come back louder, each time anew.
fn weigh_as_heard(weights: &mut [f64], pushes: &[f64]) {
    let [before, after] = [weights.iter().sum(), pushes.iter().map(|push| push * push).sum::<f64>()];
    let share = if after > 0.0 { before / after } else { 0.0 };
    weights.iter_mut().zip(pushes).for_each(|(weight, push)| *weight = share * push * push);
}
