//! One table of all numbers of a body: files and knobs are built from it, and it keeps bodies within their ranges.

use super::bed::Bed;
use super::body::{Body, FREQUENCY_RANGE, Pitch};
use super::model::Model;
use super::size::Size;
use super::timpani::Drum;

/// One number of a body.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Its name in files.
    pub name: &'static str,
    /// Its unit, or an empty string.
    pub unit: &'static str,
    /// Smallest and largest value.
    pub min: f64,
    /// See `min`.
    pub max: f64,
    /// Its value; `None` if the body has no such number at present, for example a frequency if it has a size.
    pub get: fn(&Body) -> Option<f64>,
    /// Sets the value. Does nothing if the body's model has no such number. Integers drop the fraction.
    pub set: fn(&mut Body, f64),
}

impl Field {
    /// The nearest value in range; `min` for NaN.
    pub fn clamp(&self, value: f64) -> f64 {
        if value >= self.min { value.min(self.max) } else { self.min }
    }
}

macro_rules! field {
    ($name:literal, $unit:literal, $min:expr, $max:expr, $get:expr, $set:expr) => {
        Field { name: $name, unit: $unit, min: $min, max: $max, get: $get, set: $set }
    };
    // A number that every body has.
    ($name:literal, $unit:literal, $min:expr, $max:expr, $($place:ident).+) => {
        field!($name, $unit, $min, $max, |body| Some(body.$($place).+), |body, value| body.$($place).+ = value)
    };
    // A number of the body's size.
    ($name:literal, $unit:literal, $min:expr, $max:expr, size $place:ident) => {
        field!($name, $unit, $min, $max, |body| body.size().map(|size| size.$place), |body, value| {
            let size = body.size().unwrap_or(Size::DEFAULT);
            body.pitch = Pitch::Size(Size { $place: value, ..size });
        })
    };
    // A number that only some models have.
    ($name:literal, $unit:literal, $min:expr, $max:expr, model $model:pat => $place:expr) => {
        field!(
            $name,
            $unit,
            $min,
            $max,
            |body| match &body.model {
                $model => Some(*$place),
                _ => None,
            },
            |body, value| {
                if let $model = &mut body.model {
                    *$place = value;
                }
            }
        )
    };
}

/// All numbers of a body. Not among them: [`Body::model`], [`Body::follows_key`] and the name of the material.
pub const FIELDS: &[Field] = &[
    field!(
        "frequency",
        "Hz",
        FREQUENCY_RANGE.0,
        FREQUENCY_RANGE.1,
        |body| match body.pitch {
            Pitch::Frequency(frequency) => Some(frequency),
            Pitch::Size(_) => None,
        },
        |body, value| body.pitch = Pitch::Frequency(value)
    ),
    field!("length", "m", 0.001, 100.0, size length),
    field!("thickness", "m", 0.000_001, 1.0, size thickness),
    field!("tension", "N", 0.001, 1e6, size tension),
    field!("material_density", "kg/m³", 1.0, 30_000.0, material.density),
    field!("young", "Pa", 1e4, 1e12, material.young),
    field!("poisson", "", 0.0, 0.49, material.poisson),
    field!("loss_b0", "1/s", 0.0, 10_000.0, material.loss.b0),
    field!("loss_b1", "1/s", 0.0, 10_000.0, material.loss.b1),
    field!("loss_power", "", 0.0, 3.0, material.loss.power),
    field!("damping", "", 0.01, 100.0, damping),
    field!("strike", "", 0.0, 1.0, strike.x),
    field!("strike_y", "", 0.0, 1.0, strike.y),
    field!("pickup", "", 0.0, 1.0, pickup.x),
    field!("pickup_y", "", 0.0, 1.0, pickup.y),
    field!("joint", "", 0.0, 1.0, joint.x),
    field!("joint_y", "", 0.0, 1.0, joint.y),
    field!("inharmonicity", "", 0.0, 1.0, inharmonicity),
    field!("split", "ct", 0.0, 200.0, split),
    field!("spread", "ct", 0.0, 200.0, spread),
    field!("tilt", "dB/oct", -24.0, 24.0, tilt),
    field!("pan", "", 0.0, 1.0, pan),
    field!("strike_share", "", 0.0, 1.0, strike_share),
    field!("count", "", 1.0, 512.0, |body| Some(body.modes as f64), |body, value| body.modes = value as usize),
    // Integers up to 2⁵³ have the same value as text, float and integer.
    field!("seed", "", 0.0, 9_007_199_254_740_992.0, |body| Some(body.seed as f64), |body, value| body.seed =
        value as u64),
    field!("aspect", "", 0.1, 10.0, model Model::Plate { aspect, .. } => aspect),
    field!("truncation", "", 0.0, 100.0, model Model::Cone { truncation } => truncation),
    field!("slenderness", "", 0.2, 10.0, model Model::Glass { slenderness } => slenderness),
    field!("head_radius", "m", 0.05, 2.0, model Model::Timpani(Drum { radius, .. }) => radius),
    field!("head_density", "kg/m²", 0.01, 10.0, model Model::Timpani(Drum { density, .. }) => density),
    field!("kettle_volume", "m³", 0.001, 10.0, model Model::Timpani(Drum { volume, .. }) => volume),
    field!("low", "", 0.01, 1000.0, model Model::Bed(Bed { low, .. }) => low),
    field!("high", "", 0.01, 1000.0, model Model::Bed(Bed { high, .. }) => high),
    field!("mode_density", "", -1.0, 3.0, model Model::Bed(Bed { density, .. }) => density),
];

/// The body with every number clamped to its range.
pub(super) fn in_range(body: &Body) -> Body {
    let mut body = body.clone();
    for field in FIELDS {
        if let Some(value) = (field.get)(&body) {
            (field.set)(&mut body, field.clamp(value));
        }
    }
    body
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_read_as_it_was_set() {
        for (id, model) in Model::ALL {
            for field in FIELDS {
                let mut body = Body::new(model.clone());
                let had = (field.get)(&body);
                assert!(had.is_none_or(|value| (field.min..=field.max).contains(&value)), "{id} {}", field.name);
                (field.set)(&mut body, field.max);
                if let Some(value) = (field.get)(&body) {
                    assert_eq!(value, field.max, "{id} {}", field.name);
                }
            }
        }
    }

    #[test]
    fn names_stand_for_one_number_each() {
        let mut names: Vec<&str> = FIELDS.iter().map(|field| field.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), FIELDS.len());
        assert_eq!(crate::patch::MAX_MODES as f64, FIELDS.iter().find(|field| field.name == "count").unwrap().max);
    }

    #[test]
    fn nonsense_becomes_a_body() {
        let mut body = Body::new(Model::Bowl);
        for field in FIELDS {
            (field.set)(&mut body, f64::NAN);
        }
        assert!(FIELDS.iter().filter_map(|field| (field.get)(&in_range(&body))).all(f64::is_finite));
    }
}
