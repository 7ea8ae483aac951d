//! The numbers of bodies and of their joint on the page of the body: names, values with units, and help texts.

use sprung::internals::editor::{FIELDS, LINK_FIELDS};
use sprung::sound::bodies::Body;
use sprung::units::{note_name, number_in_unit, parse_key};
use sprung_picture::Origin;

/// A4 in Hz with which a typed frequency becomes a key.
const A4: f64 = 440.0;

/// One of two bodies, or the joint between them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Part {
    #[default]
    First,
    Second,
    Joint,
}

/// A number that can be changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Number {
    /// Its name in files.
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) range: [f64; 2],
    pub(super) value: f64,
}

/// The numbers by their names in files, with the names that are shown, and help texts.
const ABOUT: [(&str, &str, &str); 41] = [
    (
        "frequency",
        "Frequency",
        "The frequency at which losses are computed; of a body that does not follow the keys, its pitch.",
    ),
    (
        "length",
        "Length",
        "Length, of round bodies the diameter. Sets the pitch at which losses are computed, and a string’s stiffness.",
    ),
    ("thickness", "Thickness", "Thickness, of strings and tubes the diameter."),
    ("tension", "Tension", "Force that stretches it."),
    ("material_density", "Density of material", "Mass of the material per volume."),
    ("young", "Young’s modulus", "Stiffness of the material."),
    ("poisson", "Poisson’s ratio", "How much thinner the material gets when it is stretched."),
    ("loss_b0", "Loss of all modes", "Loss of all modes alike: T60 is 6.9 divided by it."),
    ("loss_b1", "Loss of high modes", "Loss that rises with frequency: high modes ring shorter."),
    ("loss_power", "Rise of that loss", "How steeply that loss rises with frequency."),
    ("damping", "Damping", "Multiplies all losses: a cloth on it, or better suspension."),
    ("strike", "Strike place", "Where it is struck. Modes with a node there stay silent."),
    ("strike_y", "Strike, across", "Where it is struck: around a round body, or along the other side of a plate."),
    ("pickup", "Pickup place", "Where it is heard. Modes with a node there stay silent."),
    ("pickup_y", "Pickup, across", "Where it is heard: around a round body, or along the other side of a plate."),
    ("joint", "Joint place", "Where it is joined to the other body."),
    ("joint_y", "Joint, across", "Where it is joined: around a round body, or along the other side of a plate."),
    (
        "inharmonicity",
        "Inharmonicity",
        "Stiffness that stretches the partials: a piano’s below 0.001, metal from 0.01.",
    ),
    ("split", "Split of pairs", "Distance of the two modes of a pair, which beat."),
    ("spread", "Spread of modes", "Random deviation of each mode: hand-made metal."),
    ("tilt", "Tilt", "Level per octave above the pitch: darker below 0."),
    ("pan", "Stereo spread", "Random place of each mode between left and right."),
    ("strike_share", "Share of strikes", "Share of mallet and pluck in what moves it; noise has the rest."),
    ("count", "Number of modes", "Most modes. More are richer, and cost more."),
    ("seed", "Specimen", "Which random numbers: another specimen of the same kind."),
    ("aspect", "Ratio of sides", "Length of one side over that of the other."),
    ("truncation", "Cut at the apex", "What is cut off at the apex, over what remains."),
    ("slenderness", "Slenderness", "Height over radius."),
    ("head_radius", "Head radius", "Radius of the head."),
    ("head_density", "Density of head", "Mass of the head per area."),
    ("kettle_volume", "Kettle volume", "Air that is shut in below the head."),
    ("low", "Lowest mode", "The lowest mode, as a multiple of the frequency."),
    ("high", "Highest mode", "The highest mode, as a multiple of the frequency."),
    ("mode_density", "Crowding of modes", "How the modes lie: 0 evenly, above it denser towards the high ones."),
    ("stiffness", "Stiffness", "The spring between the bodies, as the frequency at which the first would swing on it."),
    ("mass", "Mass of second", "Mass of the second body over that of the first."),
    ("struck", "Struck on second", "Share of a strike that falls on the second body."),
    ("heard", "Heard of second", "Share of the second body in what is heard."),
    ("polarisation", "Polarisation", "How much the first body also swings across the joint, where it decays slowly."),
    ("lowest", "Lowest key", "The lowest key with modes of its own."),
    ("highest", "Highest key", "The highest key with modes of its own."),
];

/// The titles of numbers that belong together.
pub(super) const GROUPS: [&str; 5] = ["", "Size and pitch", "Material", "Places", "Modes"];

impl Part {
    pub(super) fn body(self, origin: &Origin) -> Option<&Body> {
        match self {
            Self::First => origin.body(),
            Self::Second => origin.pair().map(|pair| &pair.second),
            Self::Joint => None,
        }
    }

    pub(super) fn body_mut(self, origin: &mut Origin) -> Option<&mut Body> {
        match self {
            Self::First => origin.body_mut(),
            Self::Second => origin.pair_mut().map(|pair| &mut pair.second),
            Self::Joint => None,
        }
    }

    /// Its numbers, in the order of the tables.
    pub(super) fn numbers(self, origin: &Origin) -> Vec<Number> {
        let number = |name, unit, range, value: Option<f64>| value.map(|value| Number { name, unit, range, value });
        match (self.body(origin), origin.pair()) {
            (Some(body), _) => FIELDS
                .iter()
                // A single body has no joint.
                .filter(|field| origin.pair().is_some() || !field.name.starts_with("joint"))
                .filter_map(|field| number(field.name, field.unit, [field.min, field.max], (field.get)(body)))
                .collect(),
            (None, Some(pair)) => LINK_FIELDS
                .iter()
                .filter_map(|field| number(field.name, field.unit, [field.min, field.max], (field.get)(pair)))
                .collect(),
            (None, None) => Vec::new(),
        }
    }

    /// Sets the number of this name. The lowest and the highest key of a joint push each other.
    pub(super) fn set(self, origin: &mut Origin, name: &str, value: f64) {
        if let Some(body) = self.body_mut(origin) {
            if let Some(field) = FIELDS.iter().find(|field| field.name == name) {
                (field.set)(body, field.clamp(value));
            }
        } else if let Some(pair) = origin.pair_mut()
            && let Some(field) = LINK_FIELDS.iter().find(|field| field.name == name)
        {
            (field.set)(pair, value.clamp(field.min, field.max));
            match name {
                "lowest" => pair.keys[1] = pair.keys[1].max(pair.keys[0]),
                "highest" => pair.keys[0] = pair.keys[0].min(pair.keys[1]),
                _ => {}
            }
        }
    }
}

impl Number {
    /// Its name as shown to the user, and its help text.
    pub(super) fn about(&self) -> [&'static str; 2] {
        // The damping of a joint differs from that of a body.
        if self.name == "damping" && self.range[0] == 0.0 {
            return ["Damping", "Damping between the bodies, as a share of the critical one."];
        }
        ABOUT.iter().find(|(name, ..)| *name == self.name).map_or([self.name, ""], |(_, title, help)| [title, help])
    }

    /// The title of the numbers to which it belongs; those of a joint are few and have none.
    pub(super) fn group(&self) -> &'static str {
        match self.name {
            "damping" if self.range[0] == 0.0 => "",
            "stiffness" | "mass" | "struck" | "heard" | "polarisation" | "lowest" | "highest" => "",
            "frequency" | "length" | "thickness" | "tension" | "aspect" | "truncation" | "slenderness" => {
                "Size and pitch"
            }
            "head_radius" | "head_density" | "kettle_volume" => "Size and pitch",
            "material_density" | "young" | "poisson" | "loss_b0" | "loss_b1" | "loss_power" | "damping" => "Material",
            "strike" | "strike_y" | "pickup" | "pickup_y" | "joint" | "joint_y" => "Places",
            _ => "Modes",
        }
    }

    /// A value as text: a key as a note, others in few letters and with their unit.
    pub(super) fn written(&self, value: f64) -> String {
        if self.is_key() { note_name(value as u8) } else { written(value, self.unit) }
    }

    /// The value of a text.
    pub(super) fn read(&self, text: &str) -> Option<f64> {
        if self.is_key() { parse_key(text, A4).ok() } else { number_in_unit(self.unit, text) }
    }

    fn is_key(&self) -> bool {
        ["lowest", "highest"].contains(&self.name)
    }

    pub(super) fn is_whole(&self) -> bool {
        self.is_key() || ["count", "seed"].contains(&self.name)
    }

    /// The change for each pixel that the mouse is dragged.
    pub(super) fn speed(&self) -> f64 {
        let [min, max] = self.range;
        if self.is_whole() {
            0.25
        } else if max - min <= 200.0 {
            (max - min) / 200.0
        } else {
            // A range of several decades: changes by 1 % of the value.
            (0.01 * self.value.abs()).max(1e-4)
        }
    }
}

/// A value in a unit, in few letters; [`sprung::units::number_in_unit`] reads it again.
pub(crate) fn written(value: f64, unit: &str) -> String {
    let (value, unit) = match unit {
        "m" if value < 0.01 => (value * 1000.0, "mm"),
        "m" if value < 1.0 => (value * 100.0, "cm"),
        "Hz" if value >= 10_000.0 => (value / 1000.0, "kHz"),
        _ => (value, unit),
    };
    let size = value.abs();
    let text = match size {
        0.0 => "0".to_owned(),
        1e5.. | ..1e-3 => format!("{value:.2e}"),
        _ => {
            let digits = [1000.0, 100.0, 10.0, 1.0, 0.1, 0.01].iter().filter(|decade| size < **decade).count();
            let text = format!("{value:.digits$}");
            if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
        }
    };
    if unit.is_empty() { text } else { format!("{text} {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::sound::bodies::Model;

    #[test]
    fn numbers_that_are_written_can_be_read() {
        for field in FIELDS {
            for share in [0.0, 1e-6, 1e-3, 0.1, 0.456_789, 1.0] {
                let value = field.min + share * (field.max - field.min);
                let text = written(value, field.unit);
                let read = number_in_unit(field.unit, &text).unwrap_or_else(|| panic!("{}: {text}", field.name));
                assert!((read - value).abs() <= 6e-3 * value.abs(), "{}: {value} as {text}", field.name);
            }
        }
        assert_eq!(["m", "m", "Hz", ""].map(|unit| written(0.62, unit)), ["62 cm", "62 cm", "0.62 Hz", "0.62"]);
        assert_eq!((written(2e11, "Pa"), written(64.0, "")), ("2.00e11 Pa".to_owned(), "64".to_owned()));
    }

    #[test]
    fn keys_are_written_as_notes_and_read_as_notes_or_numbers() {
        let key = Number { name: "lowest", unit: "", range: [0.0, 127.0], value: 36.0 };
        assert_eq!(key.written(36.0), "C2");
        assert_eq!(["C2", "36", "x"].map(|text| key.read(text)), [Some(36.0), Some(36.0), None]);
    }

    #[test]
    fn every_number_is_explained_and_can_be_set() {
        let names = || FIELDS.iter().map(|field| field.name).chain(LINK_FIELDS.iter().map(|field| field.name));
        for name in names() {
            assert!(ABOUT.iter().any(|(known, ..)| *known == name), "{name}");
        }
        for (name, ..) in ABOUT {
            assert!(names().any(|known| known == name), "{name}");
        }
        let in_a_group =
            |origin: &Origin, part: Part| part.numbers(origin).iter().all(|number| GROUPS.contains(&number.group()));
        for (_, model) in Model::ALL {
            let mut origin = Origin::FromBody(Box::new(Body::new(model.clone())));
            assert!(in_a_group(&origin, Part::First));
            for number in Part::First.numbers(&origin) {
                let [min, max] = number.range;
                let value = ((min + max) / 2.0).floor().max(min);
                Part::First.set(&mut origin, number.name, value);
                let now = Part::First.numbers(&origin).into_iter().find(|now| now.name == number.name);
                assert_eq!(now.map(|now| now.value), Some(value), "{}", number.name);
            }
        }
    }
}
