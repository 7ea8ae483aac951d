//! What the first page of window and browser shows of a sound: what moves it, what it is and is made of, and knobs that matter.

use sprung::params::Param;

/// An exciter, which has a tile.
#[derive(Clone, Copy, Debug)]
pub struct Exciter {
    /// The section of its parameters.
    pub section: &'static str,
    /// The parameter that is least while it is off.
    pub level: Param,
    /// Another parameter that must be least as well.
    pub also: Option<Param>,
    /// The value of the first for an exciter that has not been on before.
    pub on: f32,
}

const fn exciter(section: &'static str, level: Param, on: f32) -> Exciter {
    Exciter { section, level, also: None, on }
}

/// What moves the body.
pub const EXCITERS: [Exciter; 6] = [
    exciter("Mallet", Param::MalletLevel, 0.0),
    exciter("Pluck", Param::PluckLevel, 0.0),
    Exciter { also: Some(Param::NoiseHeld), ..exciter("Noise", Param::NoiseLevel, -6.0) },
    exciter("Bow", Param::BowLevel, 0.0),
    exciter("Breath", Param::BreathLevel, -18.0),
    exciter("Input", Param::InputLevel, 0.0),
];

/// Models with tiles, and their names there.
pub const MODELS: [(&str, &str); 9] = [
    ("free_bar", "Bar"),
    ("membrane", "Head"),
    ("free_plate", "Plate"),
    ("church_bell", "Bell"),
    ("string", "String"),
    ("open_tube", "Tube"),
    ("glass", "Glass"),
    ("free_disc", "Gong"),
    ("bowl", "Bowl"),
];

/// Materials with a disc of their colour.
pub const DISCS: [&str; 10] =
    ["bronze", "steel", "brass", "aluminium", "glass", "rosewood", "maple", "spruce", "porcelain", "nylon"];

/// Knobs that matter for most sounds, and their names.
pub const ESSENTIALS: [(Param, &str); 6] = [
    (Param::Decay, "Decay"),
    (Param::Tilt, "Brightness"),
    (Param::Width, "Width"),
    (Param::VaryPosition, "Vary"),
    (Param::SpaceMix, "Reverb mix"),
    (Param::SpaceSize, "Reverb size"),
];

/// Whether a knob does nothing as long as there is no space.
pub fn needs_space(param: Param) -> bool {
    matches!(param, Param::SpaceMix | Param::SpaceSize)
}

/// Names of the spaces as floors, by their values.
pub const FLOORS: [&str; 4] = ["None", "Plate", "Spring", "Room"];
