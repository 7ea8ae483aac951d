//! Reads and writes the list of modes of a body in a preset file: `model = "custom"`, `modes = [{ ratio = 1 }, …]`.

use super::complaints::Complaints;
use super::mode_list::table_of;
use super::value::{number_in, unexpected};
use crate::patch::MAX_MODES;
use crate::sound::bodies::{CustomMode, RATIO_RANGE};
use std::fmt::Write;
use std::sync::Arc;
use toml::Value;

/// The numbers of a mode: name, range and default. A number without a default is required.
const FIELDS: [(&str, (f64, f64), Option<f64>); 3] =
    [("ratio", RATIO_RANGE, None), ("level", (-1.0, 1.0), Some(1.0)), ("decay", (0.001, 1000.0), Some(1.0))];

/// Reads the modes of the custom body at `place`, if all of them can be read.
pub(super) fn read(found: Option<&Value>, place: &str, complaints: &mut Complaints) -> Option<Arc<[CustomMode]>> {
    let expected = "a list of modes, [{ ratio = … }, …]";
    let modes = match found {
        Some(Value::Array(modes)) => modes,
        Some(other) => {
            complaints.add(unexpected(&format!("{place}.modes"), expected, other));
            return None;
        }
        None => {
            complaints.add(format!("{place}: the model custom has no ‘modes’: expected {expected}"));
            return None;
        }
    };
    if !(1..=MAX_MODES).contains(&modes.len()) {
        complaints.add(format!("{place}.modes: {} of them is out of range: expected 1 to {MAX_MODES}", modes.len()));
        return None;
    }
    let mut read = |(index, mode): (usize, &Value)| read_mode(&format!("{place}.modes[{index}]"), mode, complaints);
    // Read every mode, so that the errors of all of them are reported.
    let modes: Vec<Option<CustomMode>> = modes.iter().enumerate().map(&mut read).collect();
    modes.into_iter().collect()
}

fn read_mode(place: &str, mode: &Value, complaints: &mut Complaints) -> Option<CustomMode> {
    let mode = table_of(mode, place, &FIELDS.map(|(name, ..)| name), complaints)?;
    let [ratio, level, decay] = FIELDS.map(|(name, (min, max), default)| {
        let missing = || default.ok_or_else(|| format!("{place}: there is no ‘{name}’"));
        let number = number_in(mode, place, (name, min, max), |number| number);
        complaints.take("", number.unwrap_or_else(missing))
    });
    Some(CustomMode { ratio: ratio?, level: level?, decay: decay? })
}

/// The line of a custom body's modes.
pub(super) fn text(modes: &[CustomMode]) -> String {
    let mut out = String::from("modes = [");
    for mode in modes {
        out.push_str(if out.ends_with('[') { "{ " } else { ", { " });
        let numbers = FIELDS.iter().zip([mode.ratio, mode.level, mode.decay]);
        let given = numbers.filter(|((.., default), value)| Some(*value) != *default);
        let given: Vec<_> = given.map(|((name, ..), value)| format!("{name} = {value:?}")).collect();
        let _ = write!(out, "{} }}", given.join(", "));
    }
    out.push_str("]\n");
    out
}
