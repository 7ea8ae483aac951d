//! Reads TOML values for the parts of a preset file, with errors that say what would be right.

use super::complaints::Complaints;
use crate::error::{Error, nearest};
use crate::params::{PARAMS, Param, ParamInfo, Unit};
use std::fmt::Display;
use toml::{Table, Value};

/// Most names that an error lists. A preset has 17 keys, and over a hundred parameters.
const MOST_LISTED: usize = 24;

/// Checks that a table has no other keys than `known`. `place` is its path: empty, or ending in a dot.
pub(super) fn check_keys(table: &Table, place: &str, known: &[&str], complaints: &mut Complaints) {
    for key in table.keys().filter(|key| !known.contains(&key.as_str())) {
        complaints.add(match nearest(key, known.iter().copied()) {
            Some(near) => format!("unknown key ‘{place}{key}’; the nearest is {near}"),
            None if known.len() <= MOST_LISTED => {
                format!("unknown key ‘{place}{key}’: expected one of {}", known.join(", "))
            }
            None => format!("unknown key ‘{place}{key}’; ‘sprung params’ shows them all"),
        });
    }
}

/// The error for a value of a wrong type: what was expected, and what was found.
pub(super) fn unexpected(key: &str, expected: &str, found: &Value) -> String {
    format!("{key}: expected {expected}, found {} ‘{}’", found.type_str(), found.to_string().trim())
}

/// The number of this name in the table at `place`, if the table has it. It must be in the range. `of` converts it to
/// its type.
pub(super) fn number_in<N: Copy + PartialOrd + Display>(
    table: &Table,
    place: &str,
    (name, min, max): (&str, N, N),
    of: fn(f64) -> N,
) -> Option<Result<N, String>> {
    let number = match table.get(name)? {
        Value::Integer(number) => of(*number as f64),
        Value::Float(number) => of(*number),
        other => return Some(Err(unexpected(&format!("{place}.{name}"), "a number", other))),
    };
    Some(match (min..=max).contains(&number) {
        true => Ok(number),
        false => Err(format!("{place}.{name}: {number} is out of range: expected {min} to {max}")),
    })
}

/// The value of a parameter: a number in its unit, or a text with a unit.
pub(super) fn param_value(info: &ParamInfo, value: &Value) -> Result<f32, String> {
    match (value, info.unit) {
        (Value::String(text), _) => info.parse(text),
        (_, Unit::Choice) => Err(format!("‘{}’ is not one of {}", value.to_string().trim(), info.choices.join(", "))),
        (Value::Integer(number), _) => info.check(*number as f32),
        (Value::Float(number), _) => info.check(*number as f32),
        (other, _) => Err(format!("expected a number or a text with a unit, found {}", other.type_str())),
    }
}

/// Reads the `wanted` parameters in the table `name`, in the order of [`PARAMS`]. Empty if the table is missing.
pub(super) fn read_params(
    name: &str,
    found: Option<&Value>,
    wanted: impl Fn(Param) -> bool,
    complaints: &mut Complaints,
) -> Vec<(Param, f32)> {
    let params = match found {
        None => return Vec::new(),
        Some(Value::Table(params)) => params,
        Some(other) => {
            complaints.add(unexpected(name, &format!("a table [{name}]"), other));
            return Vec::new();
        }
    };
    let wanted = PARAMS.iter().filter(|info| wanted(info.param));
    check_keys(params, &format!("{name}."), &wanted.clone().map(|info| info.id).collect::<Vec<_>>(), complaints);
    let value = |info: &ParamInfo| {
        let value = param_value(info, params.get(info.id)?);
        Some((info.param, complaints.take(&format!("{name}.{}: ", info.id), value)?))
    };
    wanted.filter_map(value).collect()
}

/// Parses TOML. `origin` names the text in errors.
pub(super) fn table(text: &str, origin: &str) -> crate::Result<Table> {
    toml::from_str(text).map_err(|error| syntax_error(text, origin, &error))
}

fn syntax_error(text: &str, origin: &str, error: &toml::de::Error) -> Error {
    let place = error.span().and_then(|span| text.get(..span.start)).map_or(String::new(), |before| {
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        format!(":{line}:{column}")
    });
    // The TOML library puts what it expected on a second line.
    let message: Vec<&str> = error.message().lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    Error::format(format!("{origin}{place}"), format!("not valid TOML: {}", message.join("; ")))
}
