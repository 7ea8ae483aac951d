//! The models by name: the modes and the frequency of each, and their starting values.

use super::bar::{self, Ends};
use super::bed::{self, Bed, BedKind};
use super::material::Material;
use super::partial::{Pair, Partial};
use super::plate::{self, Edge};
use super::size::Size;
use super::timpani::{self, Drum};
use super::{bell, bowl, disc, glass, mass, membrane, string, tube};
use std::sync::Arc;

/// One mode of [`Model::Custom`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CustomMode {
    /// Frequency as a multiple of the body's frequency.
    pub ratio: f64,
    /// Level; a negative level inverts the phase.
    pub level: f64,
    /// T60 as a multiple of the material's T60 at this frequency.
    pub decay: f64,
}

/// The kind of body. Its frequency is that of the mode with ratio 1. This is the lowest mode, unless stated otherwise
/// below.
#[derive(Clone, Debug, PartialEq)]
pub enum Model {
    /// A single mass. No size, no places.
    Mass,
    /// A string. Places: `x` along it. Size: length, thickness (diameter), tension; the size also determines its
    /// stiffness.
    String,
    /// A uniform bar with free ends: a glockenspiel's. Places: `x` along it. Size: length and thickness.
    FreeBar,
    /// A bar tuned 1 : 4 : 10. Places: as for a free bar; no size.
    Marimba,
    /// Like [`Model::Marimba`], but of metal.
    Vibraphone,
    /// A bar tuned 1 : 3 : 6. Places: as for a free bar; no size.
    Xylophone,
    /// A bar clamped at `x = 0`: a kalimba's, a music box's, an electric piano's. Size: length and thickness.
    Tine,
    /// A round membrane. Places: `x` from centre to rim, `y` round it. Size: length (diameter), thickness, tension.
    Membrane,
    /// A kettledrum. Its frequency is that of mode (1,1); mode (0,1) is lower. Places: as for a membrane. Size: tension
    /// only.
    Timpani(Drum),
    /// A rectangular plate. Places: `x` and `y` along its sides. Size: length along `x`, and thickness.
    Plate {
        /// How its edge is held.
        edge: Edge,
        /// Length of the side along `x` over that along `y`.
        aspect: f64,
    },
    /// A round plate. Places: as for a membrane. Size: length (diameter) and thickness.
    Disc {
        /// How its rim is held.
        edge: Edge,
    },
    /// A church bell. Its frequency is that of the prime, an octave above the hum. Places: `y` round it; no size.
    ChurchBell,
    /// A hand bell. Its frequency is that of its lowest mode. Places: `y` round it; no size.
    HandBell,
    /// A tubular bell. Its frequency is the pitch that is heard, an octave below its fourth mode. Places: `x` along it.
    /// Size: length and thickness (outer diameter).
    TubularBell,
    /// Air in a tube with open ends. Places: `x` along it. Size: length and thickness (bore).
    OpenTube,
    /// Air in a tube closed at `x = 0`. Places and size: as for an open tube.
    StoppedTube,
    /// Air in a cone, closed at its narrow end `x = 0`. Size: length and thickness (diameter at the mouth).
    Cone {
        /// The length that is cut off at the apex over the remaining length.
        truncation: f64,
    },
    /// A wine glass. Places: `x` from foot to rim, `y` round it. Size: length (diameter) and thickness (of the wall).
    Glass {
        /// Height of its bowl over its radius.
        slenderness: f64,
    },
    /// A singing bowl. Places: `x` from the bottom to the rim, `y` round it; no size.
    Bowl,
    /// Dense modes, known only by their statistics. Places: `x` and `y` on a flat surface; no size.
    Bed(Bed),
    /// A given list of modes. No size, no places.
    Custom(Arc<[CustomMode]>),
}

impl Model {
    /// The name of [`Model::Custom`] in presets, which give it a list of modes.
    pub(crate) const CUSTOM: &str = "custom";

    /// One of each model with its starting values, and its name in presets. [`Model::Custom`] is not among them, because
    /// it has no modes to start with.
    pub const ALL: &[(&str, Model)] = &[
        ("mass", Model::Mass),
        ("string", Model::String),
        ("free_bar", Model::FreeBar),
        ("marimba", Model::Marimba),
        ("vibraphone", Model::Vibraphone),
        ("xylophone", Model::Xylophone),
        ("tine", Model::Tine),
        ("membrane", Model::Membrane),
        ("timpani", Model::Timpani(Drum::DEFAULT)),
        ("plate", Model::Plate { edge: Edge::Supported, aspect: 2.0 }),
        ("free_plate", Model::Plate { edge: Edge::Free, aspect: 1.5 }),
        ("disc", Model::Disc { edge: Edge::Supported }),
        ("free_disc", Model::Disc { edge: Edge::Free }),
        ("church_bell", Model::ChurchBell),
        ("hand_bell", Model::HandBell),
        ("tubular_bell", Model::TubularBell),
        ("open_tube", Model::OpenTube),
        ("stopped_tube", Model::StoppedTube),
        ("cone", Model::Cone { truncation: 0.2 }),
        ("glass", Model::Glass { slenderness: 2.0 }),
        ("bowl", Model::Bowl),
        ("shell", Model::Bed(Bed::new(BedKind::Shell))),
        ("box", Model::Bed(Bed::new(BedKind::Box))),
        ("wires", Model::Bed(Bed::new(BedKind::Wires))),
        ("wash", Model::Bed(Bed::new(BedKind::Wash))),
        ("air", Model::Bed(Bed::new(BedKind::Air))),
    ];

    /// Finds the model with this name, with its starting values.
    pub fn find(id: &str) -> Option<&'static Model> {
        Self::ALL.iter().find(|(name, _)| *name == id).map(|(_, model)| model)
    }

    /// Its name in presets, which does not depend on its values.
    pub fn id(&self) -> &'static str {
        Self::ALL.iter().find(|(_, model)| model.is_same_kind(self)).map_or(Self::CUSTOM, |(id, _)| id)
    }

    fn is_same_kind(&self, other: &Model) -> bool {
        match (self, other) {
            (Model::Plate { edge, .. }, Model::Plate { edge: others, .. }) => edge == others,
            (Model::Disc { edge }, Model::Disc { edge: others }) => edge == others,
            (Model::Bed(bed), Model::Bed(others)) => bed.kind == others.kind,
            _ => std::mem::discriminant(self) == std::mem::discriminant(other),
        }
    }

    /// The material of a new body of this model.
    pub(crate) fn material(&self) -> &'static Material {
        let id = match self {
            Self::String => "wire",
            Self::Mass | Self::FreeBar | Self::Tine | Self::Plate { .. } | Self::Custom(_) => "steel",
            Self::Marimba | Self::Xylophone => "rosewood",
            Self::Vibraphone => "aluminium",
            Self::Membrane => "skin",
            Self::Timpani(_) => "mylar",
            Self::TubularBell => "brass",
            Self::ChurchBell | Self::HandBell | Self::Bowl | Self::Disc { .. } => "bronze",
            Self::OpenTube | Self::StoppedTube | Self::Cone { .. } => "air",
            Self::Glass { .. } => "glass",
            Self::Bed(bed) => match bed.kind {
                BedKind::Shell => "maple",
                BedKind::Box => "spruce",
                BedKind::Wires => "snare_wire",
                BedKind::Wash => "bronze",
                BedKind::Air => "air",
            },
        };
        Material::find(id).expect("every model's material is in the table")
    }

    /// The lowest `count` resonances of a body with this frequency in Hz, in ascending order; fewer if there are no
    /// more.
    pub(super) fn partials(&self, frequency: f64, material: &Material, seed: u64, count: usize) -> Vec<Partial> {
        match self {
            Self::Mass => mass::partials(),
            Self::String => string::partials(count),
            Self::FreeBar => bar::partials(Ends::Free, count),
            Self::Marimba | Self::Vibraphone => bar::tuned(&[1.0, 4.0, 10.0], count),
            Self::Xylophone => bar::tuned(&[1.0, 3.0, 6.0], count),
            Self::Tine => bar::partials(Ends::Clamped, count),
            Self::Membrane => membrane::partials(count),
            Self::Timpani(drum) => timpani::partials(drum, frequency, count),
            Self::Plate { edge, aspect } => plate::partials(*edge, *aspect, material.poisson, count),
            Self::Disc { edge } => disc::partials(*edge, material.poisson, count),
            Self::ChurchBell => bell::church(count),
            Self::HandBell => bell::hand(count),
            Self::TubularBell => bell::tubular(count),
            Self::OpenTube => tube::open(count),
            Self::StoppedTube => tube::stopped(count),
            Self::Cone { truncation } => tube::cone(*truncation, count),
            Self::Glass { slenderness } => glass::partials(*slenderness, count),
            Self::Bowl => bowl::partials(count),
            Self::Bed(bed) => bed::partials(bed, seed, count),
            Self::Custom(modes) => modes.iter().take(count).map(custom).collect(),
        }
    }

    /// The frequency in Hz that follows from a size; `None` for models without a size.
    pub(crate) fn frequency(&self, size: &Size, material: &Material) -> Option<f64> {
        Some(match self {
            Self::String => string::frequency(size, material),
            Self::FreeBar => bar::frequency(Ends::Free, size, material),
            Self::Tine => bar::frequency(Ends::Clamped, size, material),
            Self::Membrane => membrane::frequency(size, material),
            Self::Timpani(drum) => timpani::frequency(drum, size.tension),
            Self::Plate { edge, aspect } => plate::frequency(*edge, *aspect, size, material),
            Self::Disc { edge } => disc::frequency(*edge, size, material),
            Self::TubularBell => bell::frequency(size, material),
            Self::OpenTube => tube::open_frequency(size),
            Self::StoppedTube => tube::stopped_frequency(size),
            Self::Cone { truncation } => tube::cone_frequency(*truncation, size),
            Self::Glass { slenderness } => glass::frequency(*slenderness, size, material),
            Self::Mass
            | Self::Marimba
            | Self::Vibraphone
            | Self::Xylophone
            | Self::ChurchBell
            | Self::HandBell
            | Self::Bowl
            | Self::Bed(_)
            | Self::Custom(_) => return None,
        })
    }

    /// Inharmonicity that follows from a size, in addition to [`super::Body::inharmonicity`]: that of a string's
    /// stiffness.
    pub(super) fn inharmonicity(&self, size: &Size, material: &Material) -> f64 {
        if *self == Self::String { string::inharmonicity(size, material) } else { 0.0 }
    }
}

fn custom(mode: &CustomMode) -> Partial {
    Partial { loss_factor: 1.0 / mode.decay, gain: mode.level, ..Partial::new(mode.ratio, Pair::Single, |_| 1.0) }
}
