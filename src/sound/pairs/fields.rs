//! One table of all numbers of a pair except those of its bodies.

use super::link::Link;
use super::pair::Pair;
use crate::error::{Error, Result};
use crate::patch::MAX_MODES;

/// One number of a pair, other than those of its bodies.
#[derive(Clone, Copy, Debug)]
pub struct LinkField {
    /// Its name in files.
    pub name: &'static str,
    /// Its unit, or an empty string.
    pub unit: &'static str,
    /// Smallest and largest value.
    pub min: f64,
    /// See `min`.
    pub max: f64,
    /// Its value; `None` if the pair's link has no such number.
    pub get: fn(&Pair) -> Option<f64>,
    /// Sets the value. Does nothing if the link has no such number.
    pub set: fn(&mut Pair, f64),
}

macro_rules! field {
    ($name:literal, $unit:literal, $min:expr, $max:expr, $get:expr, $set:expr) => {
        LinkField { name: $name, unit: $unit, min: $min, max: $max, get: $get, set: $set }
    };
}

/// All numbers of a pair except those of its bodies.
pub const LINK_FIELDS: &[LinkField] = &[
    field!(
        "stiffness",
        "Hz",
        1.0,
        1e5,
        |pair| match pair.link {
            Link::Spring { stiffness, .. } => Some(stiffness),
            _ => None,
        },
        |pair, value| if let Link::Spring { stiffness, .. } = &mut pair.link {
            *stiffness = value;
        }
    ),
    field!(
        "damping",
        "",
        0.0,
        10.0,
        |pair| match pair.link {
            Link::Spring { damping, .. } => Some(damping),
            _ => None,
        },
        |pair, value| if let Link::Spring { damping, .. } = &mut pair.link {
            *damping = value;
        }
    ),
    field!("mass", "", 0.001, 1e6, |pair| pair.link.joint(1.0).map(|_| pair.mass), |pair, value| if pair
        .link
        .joint(1.0)
        .is_some()
    {
        pair.mass = value;
    }),
    field!("polarisation", "", 0.0, 1.0, |pair| pair.link.joint(1.0).map(|_| pair.polarisation), |pair, value| {
        if pair.link.joint(1.0).is_some() {
            pair.polarisation = value;
        }
    }),
    field!(
        "struck",
        "",
        0.0,
        1.0,
        |pair| (pair.link != Link::Series).then_some(pair.struck),
        |pair, value| if pair.link != Link::Series {
            pair.struck = value;
        }
    ),
    field!("heard", "", 0.0, 1.0, |pair| Some(pair.heard), |pair, value| pair.heard = value),
    field!("lowest", "", 0.0, 127.0, |pair| Some(pair.keys[0].into()), |pair, value| pair.keys[0] = value as u8),
    field!("highest", "", 0.0, 127.0, |pair| Some(pair.keys[1].into()), |pair, value| pair.keys[1] = value as u8),
];

impl Pair {
    /// Whether all numbers are in range.
    ///
    /// # Errors
    /// [`Error::Value`] that names the first number that is out of range.
    pub(crate) fn check(&self) -> Result<()> {
        for field in LINK_FIELDS {
            let value = (field.get)(self).unwrap_or(field.min);
            if !(field.min..=field.max).contains(&value) {
                return Err(Error::value(field.name, format!("{value} is not from {} to {}", field.min, field.max)));
            }
        }
        let count = self.count();
        if count > MAX_MODES {
            let why = format!("both bodies have {count} modes together: expected at most {MAX_MODES}");
            return Err(Error::value("count", why));
        }
        Ok(())
    }
}
