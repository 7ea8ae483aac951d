//! A body: a model with all that makes it this one, and the modes that follow.

use super::fields;
use super::mass;
use super::material::{LN_1000, Loss, Material};
use super::model::Model;
use super::partial::{Pair, Partial, Point};
use super::size::Size;
use crate::dsp::random::{key, uniform};
use crate::units::{gain_from_db, ratio_from_semitones};
use libm::{cos, log, log2, sin};
use std::f64::consts::PI;

/// Frequency of a body that nobody has tuned: C4.
pub const DEFAULT_FREQUENCY: f64 = 261.625_565_300_598_6;

/// Shortest and longest T60 that a mode is given, in seconds.
pub const T60_RANGE: (f64, f64) = (0.001, 60.0);

/// Lowest and highest ratio of a mode: those of a patch's. What lies outside is left out.
pub const RATIO_RANGE: (f64, f64) = (0.01, 1000.0);

/// What a body's frequency comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pitch {
    /// It is said, in Hz. For a body that follows the keys, at this frequency its decays are computed.
    Frequency(f64),
    /// It follows from size and material. Models without a size sound at [`DEFAULT_FREQUENCY`].
    Size(Size),
}

/// A body. What is out of [`super::FIELDS`]' range counts as the nearest value in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// What kind of body it is.
    pub model: Model,
    /// Its frequency, or size.
    pub pitch: Pitch,
    /// What it is made of.
    pub material: Material,
    /// All losses are multiplied by this.
    pub damping: f64,
    /// Where it is struck.
    pub strike: Point,
    /// Where it is heard.
    pub pickup: Point,
    /// Where it is joined to another body.
    pub joint: Point,
    /// Stiffness B: a ratio `r` becomes `r √((1 + B r²) / (1 + B))`, which leaves the pitch alone. For whole multiples this is
    /// the stiff string's `n √(1 + B n²)` (Fletcher 1964).
    pub inharmonicity: f64,
    /// Distance in cents of the two modes of a pair, which beat: a round body's that are turned against each other, or two
    /// directions of movement of a string or bar. At 0 pairs are one mode. Plates, tubes and beds have no pairs.
    pub split: f64,
    /// How far from its law each mode may be, in cents, at random. The mode that is the pitch stays where it is.
    pub spread: f64,
    /// Tilt of the levels, in dB an octave above the body's frequency.
    pub tilt: f64,
    /// How far from the middle each mode may be panned, at random; 1 is hard left and right. The lowest stays in the middle.
    pub pan: f64,
    /// Share of the excitation that is the strike or pluck; the rest is the noise burst.
    pub strike_share: f64,
    /// Whether keys tune it. If not, it sounds at its own frequency whatever is played.
    pub follows_key: bool,
    /// Most modes, 1 to [`super::MAX_MODES`]; the two of a pair count as two.
    pub modes: usize,
    /// Seed of all that is at random.
    pub seed: u64,
}

/// One mode of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMode {
    /// Frequency in Hz.
    pub frequency: f64,
    /// Frequency over the body's.
    pub ratio: f64,
    /// T60 in seconds.
    pub t60: f64,
    /// The mode shape where the body is struck. Shapes belong to modes that have the mass of the whole body.
    pub strike: f64,
    /// The mode shape where it is heard.
    pub pickup: f64,
    /// The mode shape where it is joined to another body.
    pub joint: f64,
    /// `strike · pickup`, tilted; of a custom mode its own level, tilted.
    pub level: f64,
    /// −1 (left) to 1 (right).
    pub pan: f64,
}

/// The mode that the body's pitch is said of.
fn is_pitch(ratio: f64) -> bool {
    (ratio - 1.0).abs() < 1e-9
}

/// Which number of a mode's stream is for what; a bed's own come before.
const SPREAD: u64 = 10;
const AXIS: u64 = 11;
const PAN: u64 = 12;

impl Body {
    /// A body of this model with its own material, at C4, struck and heard where most modes sound. Allocates nothing.
    pub fn new(model: Model) -> Self {
        let material = *model.material();
        let [strike, pickup, joint] = match model {
            // Along both sides, and not at an edge, which may be a node.
            Model::Plate { .. } => [(0.7, 0.4), (0.9, 0.45), (0.95, 0.4)],
            // At the rim, where high modes are.
            Model::Bowl | Model::Glass { .. } => [(0.98, 0.0), (0.98, 0.05), (0.98, 0.0)],
            // Not at the end of a string, which is still.
            _ => [(0.7, 0.0), (0.9, 0.05), (0.95, 0.0)],
        };
        let point = |(x, y)| Point { x, y };
        Self {
            model,
            pitch: Pitch::Frequency(DEFAULT_FREQUENCY),
            material,
            damping: 1.0,
            strike: point(strike),
            pickup: point(pickup),
            joint: point(joint),
            inharmonicity: 0.0,
            split: 0.0,
            spread: 0.0,
            tilt: 0.0,
            pan: 0.0,
            strike_share: 1.0,
            follows_key: true,
            modes: 64,
            seed: 0,
        }
    }

    /// A mass in kg with a damper in N·s/m on a spring in N/m; none if it does not ring.
    pub fn from_spring(mass: f64, damping: f64, stiffness: f64) -> Option<Self> {
        let (frequency, t60) = mass::ringing(mass, damping, stiffness)?;
        let mut body = Self::new(Model::Mass);
        body.pitch = Pitch::Frequency(frequency);
        body.material.loss = Loss { b0: LN_1000 / t60, b1: 0.0, power: 1.0 };
        Some(body)
    }

    /// Its size, if its frequency follows from that.
    pub fn size(&self) -> Option<Size> {
        match self.pitch {
            Pitch::Size(size) => Some(size),
            Pitch::Frequency(_) => None,
        }
    }

    /// Its frequency in Hz.
    pub fn frequency(&self) -> f64 {
        let frequency = match &self.pitch {
            Pitch::Frequency(frequency) => *frequency,
            Pitch::Size(size) => self.model.frequency(size, &self.material).unwrap_or(DEFAULT_FREQUENCY),
        };
        fields::FREQUENCY.clamp(frequency)
    }

    /// Its modes in ascending order of frequency, one at least. Not fit for the audio thread: it allocates, and takes up to some
    /// tens of milliseconds.
    ///
    /// Modes are kept however weak they are, so that a place moves levels and nothing else; and however high, since the bank
    /// fades those at the top of the spectrum.
    pub fn modes(&self) -> Vec<BodyMode> {
        let body = fields::in_range(self);
        let frequency = body.frequency();
        let mut stiffness = body.inharmonicity;
        if let Some(size) = body.size() {
            stiffness = (stiffness + body.model.inharmonicity(&size, &body.material)).min(1.0);
        }
        let mut modes = Vec::with_capacity(2 * body.modes);
        let partials = body.model.partials(frequency, &body.material, body.seed, body.modes);
        for (serial, partial) in partials.iter().enumerate() {
            let random = Random(key(body.seed, serial as u64));
            let stiff = ((1.0 + stiffness * partial.ratio * partial.ratio) / (1.0 + stiffness)).sqrt();
            let cents = if is_pitch(partial.ratio) { 0.0 } else { body.spread * random.number(SPREAD) };
            let ratio = partial.ratio * stiff * ratio_from_semitones(0.01 * cents);
            body.push(partial, ratio, frequency, &random, &mut modes);
        }
        modes.retain(|mode| (RATIO_RANGE.0..=RATIO_RANGE.1).contains(&mode.ratio));
        modes.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
        modes.truncate(body.modes);
        if modes.is_empty() {
            let partial = &mass::partials()[0];
            body.push(partial, 1.0, frequency, &Random(0), &mut modes);
            modes.truncate(1);
        }
        if let Some(lowest) = modes.first_mut() {
            lowest.pan = 0.0;
        }
        modes
    }

    /// Adds a resonance's mode, or both of a pair.
    fn push(&self, partial: &Partial, ratio: f64, frequency: f64, random: &Random, modes: &mut Vec<BodyMode>) {
        // An imperfection has an axis on which one mode of a pair has its lobe and the other its node; without one, the strike
        // chooses it.
        let split = self.split > 0.0 && partial.pair != Pair::Single && self.modes > 1;
        let axis = match (partial.pair, split) {
            (Pair::Diameters(_), true) => 0.5 * random.number(AXIS),
            (Pair::Diameters(_), false) => self.strike.y,
            // About half way between the two directions, so that both are heard.
            _ => 0.125 + 0.0625 * random.number(AXIS),
        };
        let cents = if split { 0.5 * self.split } else { 0.0 };
        let sides: &[(f64, bool)] = if split { &[(-1.0, false), (1.0, true)] } else { &[(0.0, false)] };
        for (side, other) in sides {
            let turned = |angle: f64| if *other { sin(angle) } else { cos(angle) };
            let at = |point: Point| {
                let value = (partial.shape)(point);
                match partial.pair {
                    Pair::Diameters(m) => value * turned(2.0 * PI * f64::from(m) * (point.y - axis)),
                    Pair::Directions if split => value * turned(2.0 * PI * axis),
                    _ => value,
                }
            };
            let ratio = ratio * ratio_from_semitones(0.01 * cents * side);
            let (strike, pickup) = (at(self.strike), at(self.pickup));
            modes.push(BodyMode {
                frequency: frequency * ratio,
                ratio,
                t60: self.ring_time(partial, frequency * ratio),
                strike,
                pickup,
                joint: at(self.joint),
                level: partial.gain * strike * pickup * gain_from_db(self.tilt * log2(ratio)),
                pan: self.pan * random.number(PAN) * if *other { -1.0 } else { 1.0 },
            });
        }
    }

    fn ring_time(&self, partial: &Partial, frequency: f64) -> f64 {
        let rate = self.material.loss.rate(frequency) * partial.loss_factor + partial.radiation;
        let t60 = LN_1000 / (self.damping * rate);
        // A rate of 0 rings longest.
        if t60 < T60_RANGE.1 { t60.max(T60_RANGE.0) } else { T60_RANGE.1 }
    }
}

/// The mode whose ratio is nearest to 1 by interval: the one that the body's pitch is said of.
pub(super) fn pitch_mode(modes: &[BodyMode]) -> Option<&BodyMode> {
    modes.iter().min_by(|a, b| log(a.ratio).abs().total_cmp(&log(b.ratio).abs()))
}

/// The random numbers of one resonance.
struct Random(u64);

impl Random {
    /// Uniform over −1 to 1.
    fn number(&self, which: u64) -> f64 {
        f64::from(uniform(self.0, which))
    }
}
