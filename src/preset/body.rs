//! The body in a preset file, from which its modes are computed: `[body]` with `model = "marimba"`.

use super::complaints::Complaints;
use super::value::unexpected;
use crate::error::nearest;
use crate::params::Param;
use crate::patch::{ModeTable, Patch};
use crate::sound::bodies::{Body, FIELDS, Field, MATERIALS, Material, Model};
use crate::units::split_quantity;
use std::fmt::Write;
use toml::{Table, Value};

/// The modes of a body. They keep the text of `[body]` as their origin, so that a preset is saved with its body.
/// Allocates.
pub fn modes_of_body(body: &Body) -> ModeTable {
    body.table().with_origin(&text(body))
}

/// The body from which modes were made; none if they were not made from one. Allocates.
pub fn body_of_modes(modes: &ModeTable) -> Option<Body> {
    let mut complaints = Complaints::default();
    let body = read_body(&toml::from_str(modes.origin()?).ok()?, &mut complaints);
    body.filter(|_| complaints.into_lines().is_empty())
}

/// Reads the body of a file, if it has one. Sets the patch's modes and, unless the file has a `decay`, its decay.
pub(super) fn read(file: &Table, patch: &mut Patch, complaints: &mut Complaints) {
    let table = match file.get("body") {
        None => return,
        Some(_) if file.contains_key("modes") => {
            return complaints.add("body: the file has ‘modes’ too: expected one of the two");
        }
        Some(Value::Table(table)) => table,
        Some(other) => return complaints.add(unexpected("body", "a table [body]", other)),
    };
    let Some(body) = read_body(table, complaints) else { return };
    patch.modes = modes_of_body(&body);
    let decay = Param::Decay.info();
    if file.get("params").and_then(|params| params.get(decay.id)).is_none() {
        patch.set(Param::Decay, (body.t60() as f32).clamp(decay.min, decay.max));
    }
}

/// Whether a parameter must be written even at its default, since the reader would otherwise take it from the body.
pub(super) fn writes(patch: &Patch, param: Param) -> bool {
    param == Param::Decay && patch.modes.origin().is_some()
}

/// The table `[body]` as TOML; empty if the modes were not made from a body.
pub(super) fn to_toml(patch: &Patch) -> String {
    patch.modes.origin().map_or(String::new(), |origin| format!("\n[body]\n{origin}"))
}

/// Reads a body, if its model is known and it has a frequency. Numbers that cannot be read keep the model's values.
fn read_body(table: &Table, complaints: &mut Complaints) -> Option<Body> {
    let names = || ["model", "material"].into_iter().chain(FIELDS.iter().map(|field| field.name));
    for unknown in table.keys().filter(|key| !names().any(|name| name == *key)) {
        complaints.add(match nearest(unknown, names()) {
            Some(near) => format!("unknown key ‘body.{unknown}’; the nearest is {near}"),
            None => format!("unknown key ‘body.{unknown}’: expected one of {}", names().collect::<Vec<_>>().join(", ")),
        });
    }
    let models = || Model::ALL.iter().map(|(id, _)| *id);
    let model = named(table, "model", Model::find, models).and_then(|model| {
        let expected = || models().collect::<Vec<_>>().join(", ");
        model.ok_or_else(|| format!("body: there is no ‘model’: expected one of {}", expected()))
    });
    let mut body = Body::new(complaints.take("", model)?.clone());
    let material = named(table, "material", Material::find, || MATERIALS.iter().map(|material| material.id));
    if let Some(material) = complaints.take("", material).flatten() {
        body.material = *material;
    }
    let given = |name: &str| table.contains_key(name);
    let is_twice = given("frequency") && (given("length") || given("thickness") || given("tension"));
    if is_twice {
        complaints.add("body.frequency: it follows from length, thickness and tension: expected it or them");
    }
    for field in FIELDS.iter().filter(|field| !(is_twice && field.name == "frequency")) {
        let Some(value) = table.get(field.name) else { continue };
        let Some(value) = complaints.take(&format!("body.{}: ", field.name), number(field, value)) else { continue };
        (field.set)(&mut body, value);
        if (field.get)(&body).is_none() {
            complaints.add(format!("body.{}: the model {} has no such number", field.name, body.model.id()));
        }
    }
    if body.size().is_some_and(|size| body.model.frequency(&size, &body.material).is_none()) {
        complaints.add(format!("body: the model {} has no size: expected a ‘frequency’", body.model.id()));
        return None;
    }
    Some(body)
}

/// Finds what the text at a key names; none if the key is missing.
fn named<T: 'static, N: Iterator<Item = &'static str>>(
    table: &Table,
    key: &str,
    find: impl Fn(&str) -> Option<&'static T>,
    all: impl Fn() -> N,
) -> Result<Option<&'static T>, String> {
    match table.get(key) {
        None => Ok(None),
        Some(Value::String(id)) => find(id).map(Some).ok_or_else(|| match nearest(id, all()) {
            Some(near) => format!("body.{key}: there is no ‘{id}’; the nearest is {near}"),
            None => format!("body.{key}: ‘{id}’ is not one of {}", all().collect::<Vec<_>>().join(", ")),
        }),
        Some(other) => Err(unexpected(&format!("body.{key}"), "a text", other)),
    }
}

/// Reads a number in the field's unit, or a text with a unit.
fn number(field: &Field, value: &Value) -> Result<f64, String> {
    let value = match value {
        Value::Integer(number) => *number as f64,
        Value::Float(number) => *number,
        Value::String(text) => quantity(field, text).ok_or_else(|| {
            let unit = if field.unit.is_empty() { String::new() } else { format!(" in {}", field.unit) };
            format!("‘{text}’ is no number{unit}")
        })?,
        other => return Err(format!("expected a number or a text with a unit, found {}", other.type_str())),
    };
    let unit = if field.unit.is_empty() { String::new() } else { format!(" {}", field.unit) };
    if (field.min..=field.max).contains(&value) {
        return Ok(value);
    }
    Err(format!("{value} is out of range: expected from {} to {}{unit}", field.min, field.max))
}

fn quantity(field: &Field, text: &str) -> Option<f64> {
    let (value, unit) = split_quantity(text)?;
    // Divide: 1/100 and 1/1000 are not exact in binary, but 62 / 100 gives the number 0.62.
    match (field.unit, unit) {
        (own, unit) if own == unit || unit.is_empty() => Some(value),
        ("m", "cm") | ("", "%") => Some(value / 100.0),
        ("m", "mm") => Some(value / 1000.0),
        ("Hz", "kHz") => Some(value * 1000.0),
        _ => None,
    }
}

/// The lines of `[body]`: the model, and the values that differ from the model's own.
fn text(body: &Body) -> String {
    let mut out = format!("model = \"{}\"\n", body.model.id());
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset::Preset;

    fn parse(body: &str) -> crate::Result<Preset> {
        Preset::parse(&format!("format = 2\nname = \"a\"\n{body}"), "x")
    }

    #[test]
    fn every_model_is_saved_and_read_as_it_was() {
        for (index, (id, model)) in Model::ALL.iter().enumerate() {
            let mut body = Body::new(model.clone());
            for field in FIELDS.iter().filter(|field| (field.get)(&Body::new(model.clone())).is_some()) {
                let value = field.min + (field.max - field.min) * (index + 1) as f64 / 40.0;
                (field.set)(&mut body, if ["count", "seed"].contains(&field.name) { value.floor() } else { value });
            }
            body.material = MATERIALS[index % MATERIALS.len()];
            let patch = Patch { modes: modes_of_body(&body), ..Patch::default() };
            assert_eq!(body_of_modes(&patch.modes).as_ref(), Some(&body), "{id}");
            let preset = Preset { patch, ..parse("").unwrap() };
            let text = preset.to_toml();
            let read = Preset::parse(&text, "x").unwrap_or_else(|error| panic!("{id}: {error}\n{text}"));
            assert_eq!(read, preset, "{text}");
        }
    }

    #[test]
    fn numbers_are_read_in_their_unit() {
        let text =
            "[body]\nmodel = \"string\"\nlength = \"62 cm\"\nthickness = \"1 mm\"\ntension = 670\nstrike = \"12 %\"";
        let preset = parse(text).unwrap();
        let body = body_of_modes(&preset.patch.modes).unwrap();
        assert_eq!((body.frequency() * 10.0) as i32, 2658);
        assert_eq!(body.strike.x, 0.12);
        assert_eq!(f64::from(preset.patch.get(Param::Decay)), f64::from(body.t60() as f32));
        let slower = parse(&format!("{text}\n[params]\ndecay = 9")).unwrap();
        assert_eq!((slower.patch.get(Param::Decay), &slower.patch.modes), (9.0, &preset.patch.modes));
        assert_eq!(body_of_modes(&parse("").unwrap().patch.modes), None);
    }

    #[test]
    fn errors_say_what_would_be_right() {
        for (body, why) in [
            ("body = 1", "x: body: expected a table [body], found integer ‘1’"),
            ("modes = [{ ratio = 1 }]\n[body]\nmodel = \"mass\"", "x: body: the file has ‘modes’ too"),
            ("[body]", "x: body: there is no ‘model’: expected one of mass, string, free_bar"),
            ("[body]\nmodel = 1", "x: body.model: expected a text, found integer ‘1’"),
            ("[body]\nmodel = \"marimbo\"", "x: body.model: there is no ‘marimbo’; the nearest is"),
            ("[body]\nmodel = \"qqq\"", "x: body.model: ‘qqq’ is not one of mass, string"),
            ("[body]\nmodel = \"mass\"\nmaterial = \"cheese\"", "x: body.material: "),
            ("[body]\nmodel = \"mass\"\nstryke = 1", "x: unknown key ‘body.stryke’; the nearest is"),
            ("[body]\nmodel = \"mass\"\nstrike = 2", "x: body.strike: 2 is out of range: expected from 0 to 1"),
            ("[body]\nmodel = \"mass\"\nstrike = nan", "x: body.strike: NaN is out of range"),
            ("[body]\nmodel = \"mass\"\nstrike = true", "x: body.strike: expected a number or a text with a unit"),
            ("[body]\nmodel = \"mass\"\nsplit = \"1 Hz\"", "x: body.split: ‘1 Hz’ is no number in ct"),
            ("[body]\nmodel = \"mass\"\naspect = 1", "x: body.aspect: the model mass has no such number"),
            ("[body]\nmodel = \"mass\"\nlength = 1", "x: body: the model mass has no size: expected a ‘frequency’"),
            ("[body]\nmodel = \"string\"\nfrequency = 9\nlength = 1", "x: body.frequency: it follows from length"),
        ] {
            let error = parse(body).unwrap_err().to_string();
            assert!(error.starts_with(why), "{body}: {error}");
        }
    }
}
