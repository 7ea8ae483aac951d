//! A body: a model with its size or pitch, its material, and everything else that determines its modes.

use super::material::Material;
use super::model::Model;
use super::partial::Point;
use super::size::Size;
use crate::patch::MAX_MODES;

/// Default frequency of a body in Hz: C4.
pub(crate) const DEFAULT_FREQUENCY: f64 = 261.625_565_300_598_6;

/// Lowest and highest frequency of a body, in Hz.
pub(super) const FREQUENCY_RANGE: (f64, f64) = (1.0, 20_000.0);

/// Shortest and longest T60 of a mode, in seconds. Others are clamped.
pub(crate) const T60_RANGE: (f64, f64) = (0.001, 60.0);

/// Lowest and highest ratio of a mode, the same as in a patch. Modes outside this range are left out.
pub(crate) const RATIO_RANGE: (f64, f64) = (0.01, 1000.0);

/// What determines the frequency of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pitch {
    /// A given frequency in Hz. For a body that follows the keys, its decays are computed at this frequency.
    Frequency(f64),
    /// The frequency follows from size and material. Models without a size have that of middle C.
    Size(Size),
}

/// A body. Numbers outside the ranges in [`super::FIELDS`] are clamped when they are used.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The kind of body.
    pub model: Model,
    /// Its frequency or size.
    pub pitch: Pitch,
    /// The material it is made of.
    pub material: Material,
    /// All losses are multiplied by this.
    pub damping: f64,
    /// Where it is struck.
    pub strike: Point,
    /// Where it is heard.
    pub pickup: Point,
    /// Where it is joined to another body.
    pub joint: Point,
    /// Stiffness B: a ratio `r` becomes `r √((1 + B r²) / (1 + B))`, which does not change the pitch. For integer
    /// ratios this is the stiff string's `n √(1 + B n²)` (Fletcher 1964).
    pub inharmonicity: f64,
    /// Distance in cents of the two modes of a pair, which then beat. In a round body these are the same mode turned by
    /// half a lobe; in a string or bar, two directions of movement. At 0, a pair is one mode. Plates, tubes and beds
    /// have no pairs.
    pub split: f64,
    /// Largest random deviation of each mode from its law, in cents. The mode that sets the pitch does not move.
    pub spread: f64,
    /// Tilt of the levels, in dB per octave above the body's frequency.
    pub tilt: f64,
    /// Largest random pan of each mode; 1 is hard left or right. The lowest mode stays in the middle.
    pub pan: f64,
    /// Share of the excitation that is the strike or pluck; the rest is a noise burst.
    pub strike_share: f64,
    /// Whether keys set the pitch. If not, the body sounds at its own frequency for every key.
    pub follows_key: bool,
    /// Maximum number of modes, 1 to [`MAX_MODES`]; a split pair counts as two.
    pub modes: usize,
    /// Seed of all random numbers.
    pub seed: u64,
}

impl Body {
    /// A body of this model with its usual material, at C4, struck and heard where most modes sound. Allocates nothing.
    pub fn new(model: Model) -> Self {
        let material = *model.material();
        let [strike, pickup, joint] = match model {
            // Inside along both sides: an edge may be a node.
            Model::Plate { .. } => [(0.7, 0.4), (0.9, 0.45), (0.95, 0.4)],
            // At the rim, where high modes move most.
            Model::Bowl | Model::Glass { .. } => [(0.98, 0.0), (0.98, 0.05), (0.98, 0.0)],
            // Not at the very end, where a string does not move.
            _ => [(0.7, 0.0), (0.9, 0.05), (0.95, 0.0)],
        };
        let point = |(x, y)| Point { x, y };
        let modes = if let Model::Custom(modes) = &model { modes.len().clamp(1, MAX_MODES) } else { 64 };
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
            modes,
            seed: 0,
        }
    }

    /// Its size, if its frequency follows from the size.
    pub(crate) fn size(&self) -> Option<Size> {
        match self.pitch {
            Pitch::Size(size) => Some(size),
            Pitch::Frequency(_) => None,
        }
    }

    /// Its frequency in Hz.
    pub(crate) fn frequency(&self) -> f64 {
        let frequency = match &self.pitch {
            Pitch::Frequency(frequency) => *frequency,
            Pitch::Size(size) => self.model.frequency(size, &self.material).unwrap_or(DEFAULT_FREQUENCY),
        };
        if frequency >= FREQUENCY_RANGE.0 { frequency.min(FREQUENCY_RANGE.1) } else { FREQUENCY_RANGE.0 }
    }
}
