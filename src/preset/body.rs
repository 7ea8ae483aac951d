//! The body in a preset file, from which its modes are computed: `[body]` with `model = "marimba"`.

use super::body_table::{read_body, text};
use super::complaints::Complaints;
use super::pair;
use super::value::unexpected;
use crate::params::Param;
use crate::patch::{ModeTable, Patch};
use crate::sound::bodies::Body;
use toml::{Table, Value};

/// The modes of a body. They keep the text of `[body]` as their origin, so that a preset is saved with its body.
/// Allocates.
pub fn modes_of_body(body: &Body) -> ModeTable {
    body.table().with_origin(&text(body))
}

/// The body from which modes were made; none if they were not made from one. Allocates.
pub fn body_of_modes(modes: &ModeTable) -> Option<Body> {
    let mut complaints = Complaints::default();
    let body = read_body(&toml::from_str(modes.origin()?).ok()?, "body", &mut complaints);
    body.filter(|_| complaints.into_lines().is_empty())
}

/// Reads the body of a file, if it has one. Sets the patch's modes and, unless the file has a `decay`, its decay.
pub(super) fn read(file: &Table, patch: &mut Patch, complaints: &mut Complaints) {
    let table = match file.get("body") {
        None if pair::is_in(file) => {
            return complaints.add("second: there is no [body]: expected both, and a [joint] between them");
        }
        None => return,
        Some(_) if file.contains_key("modes") => {
            return complaints.add("body: the file has ‘modes’ too: expected one of the two");
        }
        Some(Value::Table(table)) => table,
        Some(other) => return complaints.add(unexpected("body", "a table [body]", other)),
    };
    let Some(body) = read_body(table, "body", complaints) else { return };
    let t60 = if pair::is_in(file) {
        let Some(pair) = pair::read(file, body, complaints) else { return };
        let Some(modes) = complaints.take("", pair::modes_of_pair(&pair).map_err(|error| error.to_string())) else {
            return;
        };
        patch.modes = modes;
        pair.t60()
    } else {
        if !body.follows_key {
            complaints.add("body.follows_key: expected a [second] body beside it; a single one needs key_track = 0");
        }
        patch.modes = modes_of_body(&body);
        body.t60()
    };
    let decay = Param::Decay.info();
    if file.get("params").and_then(|params| params.get(decay.id)).is_none() {
        patch.set(Param::Decay, (t60 as f32).clamp(decay.min, decay.max));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset::Preset;
    use crate::sound::bodies::{FIELDS, MATERIALS, Model};

    fn parse(body: &str) -> crate::Result<Preset> {
        Preset::parse(&format!("format = 1\nname = \"a\"\n{body}"), "x")
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
    fn a_list_of_modes_is_a_body_too() {
        let modes = "modes = [{ ratio = 1.0 }, { ratio = 2.7, level = -0.5, decay = 0.25 }]";
        let text = format!("[body]\nmodel = \"custom\"\n{modes}\nloss_b0 = 6.9\nloss_b1 = 0");
        let preset = parse(&text).unwrap();
        let body = body_of_modes(&preset.patch.modes).unwrap();
        let [first, second] = [0, 1].map(|m| preset.patch.modes.as_slice()[m]);
        assert!((second.level / first.level + 0.5).abs() < 1e-6 && (second.decay - 0.25).abs() < 1e-6);
        assert!((body.t60() - 1.001).abs() < 0.001 && body.modes == 2);
        assert_eq!(Preset::parse(&preset.to_toml(), "x").unwrap(), preset);
        let second = "[second]\nmodel = \"box\"\n[joint]\nkind = \"apart\"";
        let pair = parse(&format!("{text}\n{second}")).unwrap();
        assert_eq!(pair.patch.modes.as_slice().len(), 2 + 64);
        assert_eq!(Preset::parse(&pair.to_toml(), "x").unwrap(), pair);
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
            ("[body]\nmodel = \"custom\"", "x: body: the model custom has no ‘modes’: expected a list of modes"),
            ("[body]\nmodel = \"mass\"\nmodes = []", "x: body.modes: the model mass has modes of its own"),
            ("[body]\nmodel = \"custom\"\nmodes = []", "x: body.modes: 0 of them is out of range: expected 1 to 512"),
            ("[body]\nmodel = \"custom\"\nmodes = [{ level = 1 }]", "x: body.modes[0]: there is no ‘ratio’"),
            (
                "[body]\nmodel = \"custom\"\nmodes = [{ ratio = 1, decay = 0 }]",
                "x: body.modes[0].decay: 0 is out of range: expected 0.001 to 1000",
            ),
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
