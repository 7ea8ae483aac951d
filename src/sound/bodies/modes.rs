//! Computes the modes of a body from the resonances of its model and from the body's own numbers.

use super::body::{Body, RATIO_RANGE, T60_RANGE};
use super::fields;
use super::mass;
use super::material::LN_1000;
use super::partial::{Pair, Partial, Point};
use crate::dsp::random::{key, uniform};
use crate::units::{gain_from_db, ratio_from_semitones};
use libm::{cos, log, log2, sin};
use std::f64::consts::PI;

/// One mode of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMode {
    /// Frequency in Hz.
    pub frequency: f64,
    /// Frequency as a multiple of the body's frequency.
    pub ratio: f64,
    /// T60 in seconds.
    pub t60: f64,
    /// The mode shape where the body is struck. Shapes are scaled so that every mode has the mass of the whole body.
    pub strike: f64,
    /// The mode shape where the body is heard.
    pub pickup: f64,
    /// The mode shape where the body is joined to another body.
    pub joint: f64,
    /// Factor of the level in addition to the shapes: the tilt, and a custom mode's own level.
    pub gain: f64,
    /// `strike · pickup · gain`.
    pub level: f64,
    /// −1 (left) to 1 (right).
    pub pan: f64,
}

/// Whether the mode with this ratio is the one that sets the body's pitch.
fn is_pitch(ratio: f64) -> bool {
    (ratio - 1.0).abs() < 1e-9
}

/// Indices into the random numbers of a mode. Lower indices are for beds.
const SPREAD: u64 = 10;
const AXIS: u64 = 11;
const PAN: u64 = 12;

impl Body {
    /// The modes in ascending order of frequency; at least one. Not real-time safe: it allocates, and takes up to some
    /// tens of milliseconds.
    ///
    /// Weak modes are kept, so that another point of strike or pickup changes only levels. High modes are kept too, because the
    /// bank fades those at the top of the spectrum.
    pub fn modes(&self) -> Vec<BodyMode> {
        self.modes_at(&[]).into_iter().map(|(mode, _)| mode).collect()
    }

    /// As [`Body::modes`], each with its shape at these places, scaled as [`BodyMode::strike`]. A display uses them to draw the
    /// body.
    pub fn modes_at(&self, places: &[Point]) -> Vec<(BodyMode, Vec<f64>)> {
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
            body.push(partial, ratio, frequency, &random, places, &mut modes);
        }
        modes.retain(|(mode, _)| (RATIO_RANGE.0..=RATIO_RANGE.1).contains(&mode.ratio));
        modes.sort_by(|(a, _), (b, _)| a.ratio.total_cmp(&b.ratio));
        modes.truncate(body.modes);
        if modes.is_empty() {
            let partial = &mass::partials()[0];
            body.push(partial, 1.0, frequency, &Random(0), places, &mut modes);
            modes.truncate(1);
        }
        if let Some((lowest, _)) = modes.first_mut() {
            lowest.pan = 0.0;
        }
        modes
    }

    /// Adds the mode of a resonance, or both modes of a pair.
    fn push(
        &self,
        partial: &Partial,
        ratio: f64,
        frequency: f64,
        random: &Random,
        places: &[Point],
        modes: &mut Vec<(BodyMode, Vec<f64>)>,
    ) {
        // The imperfection of a body has an axis: one mode of a pair has a lobe there and the other a node. Without a
        // split, the strike determines the axis.
        let split = self.split > 0.0 && partial.pair != Pair::Single && self.modes > 1;
        let axis = match (partial.pair, split) {
            (Pair::Diameters(_), true) => 0.5 * random.number(AXIS),
            (Pair::Diameters(_), false) => self.strike.y,
            // About half way between the two directions, so that both modes are heard.
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
            let tilt = gain_from_db(self.tilt * log2(ratio));
            let mode = BodyMode {
                frequency: frequency * ratio,
                ratio,
                t60: self.ring_time(partial, frequency * ratio),
                strike,
                pickup,
                joint: at(self.joint),
                gain: partial.gain * tilt,
                level: partial.gain * strike * pickup * tilt,
                pan: self.pan * random.number(PAN) * if *other { -1.0 } else { 1.0 },
            };
            modes.push((mode, places.iter().map(|place| at(*place)).collect()));
        }
    }

    fn ring_time(&self, partial: &Partial, frequency: f64) -> f64 {
        let rate = self.material.loss.rate(frequency) * partial.loss_factor + partial.radiation;
        let t60 = LN_1000 / (self.damping * rate);
        // With a rate of 0, the T60 is the longest possible.
        if t60 < T60_RANGE.1 { t60.max(T60_RANGE.0) } else { T60_RANGE.1 }
    }
}

/// The mode that sets the body's pitch: the one whose ratio is nearest to 1 as an interval.
pub(super) fn pitch_mode(modes: &[BodyMode]) -> Option<&BodyMode> {
    modes.iter().min_by(|a, b| log(a.ratio).abs().total_cmp(&log(b.ratio).abs()))
}

/// The stream of random numbers of one resonance.
struct Random(u64);

impl Random {
    /// The random number with this index: uniform from −1 to 1.
    fn number(&self, which: u64) -> f64 {
        f64::from(uniform(self.0, which))
    }
}
