//! Reads and writes the table of one body in a preset file.

use super::complaints::Complaints;
use super::custom_modes;
use super::value::unexpected;
use crate::error::nearest;
use crate::sound::bodies::{Body, FIELDS, MATERIALS, Material, Model};
use crate::units::number_in_unit;
use std::fmt::Write;
use toml::{Table, Value};

/// Reads the body in the table of this name, if its model is known and it has a frequency. Numbers that cannot be read keep
/// the model's values.
pub(super) fn read_body(table: &Table, place: &str, complaints: &mut Complaints) -> Option<Body> {
    let names =
        || ["model", "modes", "material", "follows_key"].into_iter().chain(FIELDS.iter().map(|field| field.name));
    for unknown in table.keys().filter(|key| !names().any(|name| name == *key)) {
        complaints.add(match nearest(unknown, names()) {
            Some(near) => format!("unknown key ‘{place}.{unknown}’; the nearest is {near}"),
            None => {
                format!("unknown key ‘{place}.{unknown}’: expected one of {}", names().collect::<Vec<_>>().join(", "))
            }
        });
    }
    let mut body = Body::new(read_model(table, place, complaints)?);
    let material = named(table, place, "material", Material::find, || MATERIALS.iter().map(|material| material.id));
    if let Some(material) = complaints.take("", material).flatten() {
        body.material = *material;
    }
    match table.get("follows_key") {
        None => {}
        Some(Value::Boolean(follows)) => body.follows_key = *follows,
        Some(other) => complaints.add(unexpected(&format!("{place}.follows_key"), "true or false", other)),
    }
    let given = |name: &str| table.contains_key(name);
    let is_twice = given("frequency") && (given("length") || given("thickness") || given("tension"));
    if is_twice {
        complaints
            .add(format!("{place}.frequency: it follows from length, thickness and tension: expected it or them"));
    }
    for field in FIELDS.iter().filter(|field| !(is_twice && field.name == "frequency")) {
        let Some(value) = table.get(field.name) else { continue };
        let Some(value) =
            complaints.take(&format!("{place}.{}: ", field.name), number(field.unit, [field.min, field.max], value))
        else {
            continue;
        };
        (field.set)(&mut body, value);
        if (field.get)(&body).is_none() {
            complaints.add(format!("{place}.{}: the model {} has no such number", field.name, body.model.id()));
        }
    }
    if body.size().is_some_and(|size| body.model.frequency(&size, &body.material).is_none()) {
        complaints.add(format!("{place}: the model {} has no size: expected a ‘frequency’", body.model.id()));
        return None;
    }
    Some(body)
}

fn read_model(table: &Table, place: &str, complaints: &mut Complaints) -> Option<Model> {
    if table.get("model").and_then(Value::as_str) == Some(Model::CUSTOM) {
        return custom_modes::read(table.get("modes"), place, complaints).map(Model::Custom);
    }
    let models = || Model::ALL.iter().map(|(id, _)| *id).chain([Model::CUSTOM]);
    let model = named(table, place, "model", Model::find, models).and_then(|model| {
        let expected = || models().collect::<Vec<_>>().join(", ");
        model.ok_or_else(|| format!("{place}: there is no ‘model’: expected one of {}", expected()))
    });
    let model = complaints.take("", model)?;
    if table.contains_key("modes") {
        complaints
            .add(format!("{place}.modes: the model {} has modes of its own: expected model = \"custom\"", model.id()));
    }
    Some(model.clone())
}

/// Looks up the text at `key` with `find`; none if the key is missing.
pub(super) fn named<T: 'static, N: Iterator<Item = &'static str>>(
    table: &Table,
    place: &str,
    key: &str,
    find: impl Fn(&str) -> Option<&'static T>,
    all: impl Fn() -> N,
) -> Result<Option<&'static T>, String> {
    match table.get(key) {
        None => Ok(None),
        Some(Value::String(id)) => find(id).map(Some).ok_or_else(|| match nearest(id, all()) {
            Some(near) => format!("{place}.{key}: there is no ‘{id}’; the nearest is {near}"),
            None => format!("{place}.{key}: ‘{id}’ is not one of {}", all().collect::<Vec<_>>().join(", ")),
        }),
        Some(other) => Err(unexpected(&format!("{place}.{key}"), "a text", other)),
    }
}

/// Reads a number in a unit and a range, or a text with a unit.
pub(super) fn number(unit: &str, [min, max]: [f64; 2], value: &Value) -> Result<f64, String> {
    let after = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    let value = match value {
        Value::Integer(number) => *number as f64,
        Value::Float(number) => *number,
        Value::String(text) => number_in_unit(unit, text).ok_or_else(|| {
            let within = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
            format!("‘{text}’ is no number{within}")
        })?,
        other => return Err(format!("expected a number or a text with a unit, found {}", other.type_str())),
    };
    if (min..=max).contains(&value) {
        return Ok(value);
    }
    Err(format!("{value} is out of range: expected from {min} to {max}{after}"))
}

/// The lines of `[body]`: the model, and the values that differ from the model's own.
pub(super) fn text(body: &Body) -> String {
    let mut out = format!("model = \"{}\"\n", body.model.id());
    if let Model::Custom(modes) = &body.model {
        out.push_str(&custom_modes::text(modes));
    }
    if !body.follows_key {
        out.push_str("follows_key = false\n");
    }
    // Start from the listed model with the same identifier, since the reader starts from its values too.
    let mut first = Body::new(Model::find(body.model.id()).unwrap_or(&body.model).clone());
    if body.material.id != first.material.id {
        let _ = writeln!(out, "material = \"{}\"", body.material.id);
        first.material = Material::find(body.material.id).copied().unwrap_or(body.material);
    }
    for field in FIELDS {
        if let Some(value) = (field.get)(body).filter(|value| (field.get)(&first) != Some(*value)) {
            let _ = writeln!(out, "{} = {value:?}", field.name);
        }
    }
    out
}
