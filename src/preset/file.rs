//! The TOML of a preset file, read key by key so that every error names its place and what would be right.

use super::about::{About, about_to_toml};
use super::migration::{self, Replaced};
use super::value::{check_keys, param_value, table, unexpected};
use super::{FORMAT_VERSION, Preset};
use super::{body, routes};
use crate::error::Error;
use crate::params::retired::Retired;
use crate::params::{PARAMS, Param, Unit};
use crate::patch::{MAX_MODES, Mode, ModeTable, Patch};
use std::fmt::Write;
use toml::{Table, Value};

const KEYS: [&str; 9] = ["format", "name", "author", "tags", "comment", "modes", "body", "routes", "params"];

pub(super) fn parse(text: &str, origin: &str, replaced: &mut dyn FnMut(Replaced)) -> crate::Result<Preset> {
    read(&table(text, origin)?, replaced).map_err(|message| Error::format(origin, message))
}

pub(super) fn read(table: &Table, replaced: &mut dyn FnMut(Replaced)) -> Result<Preset, String> {
    if table.contains_key("kit") {
        return Err(format!("this is a kit: expected a preset, which begins with format = {FORMAT_VERSION}"));
    }
    // The version first: in another version's file, its other keys mean nothing to this one.
    let format = match table.get("format") {
        Some(Value::Integer(format @ 1..=FORMAT_VERSION)) => *format,
        Some(Value::Integer(newer)) if *newer > FORMAT_VERSION => {
            return Err(format!(
                "format {newer} is of a newer version: this one reads up to format = {FORMAT_VERSION}"
            ));
        }
        Some(other) => {
            return Err(format!("format {other} is unknown: this version reads format = 1 to {FORMAT_VERSION}"));
        }
        None => return Err(format!("there is no ‘format’: expected format = {FORMAT_VERSION}")),
    };
    check_keys(table, "", &KEYS)?;
    let About { name, author, tags, comment } = About::read(table)?;
    let mut params = match table.get("params") {
        Some(Value::Table(params)) => params.clone(),
        Some(other) => return Err(unexpected("params", "a table [params]", other)),
        None => Table::new(),
    };
    let is_old = format < migration::FIRST_WITHOUT_RETIRED;
    let mut patch = Patch::default();
    let retired = if is_old { Some(migration::take(&mut params, &mut patch)?) } else { None };
    read_params(&params, &mut patch)?;
    patch.modes = ModeTable::new(&read_modes(table.get("modes"))?);
    body::read(table, &mut patch)?;
    routes::read(table, &mut patch)?;
    if let Some(retired) = retired {
        migration::migrate(&retired, &params, &mut patch, replaced);
    }
    Ok(Preset { name, author, tags, comment, patch })
}

fn read_params(params: &Table, patch: &mut Patch) -> Result<(), String> {
    if let Some(retired) = params.keys().find_map(|id| Retired::from_id(id)) {
        return Err(format!("params.{}: {}", retired.id(), retired.message()));
    }
    check_keys(params, "params.", &PARAMS.iter().map(|info| info.id).collect::<Vec<_>>())?;
    for (id, value) in params {
        if let Some(param) = Param::from_id(id) {
            let value = param_value(param.info(), value).map_err(|message| format!("params.{id}: {message}"))?;
            patch.set(param, value);
        }
    }
    Ok(())
}

fn read_modes(modes: Option<&Value>) -> Result<Vec<Mode>, String> {
    let modes = match modes {
        None => return Ok(vec![Mode::UNIT]),
        Some(Value::Array(modes)) => modes,
        Some(other) => return Err(unexpected("modes", "a list of modes, [{ ratio = … }, …]", other)),
    };
    if !(1..=MAX_MODES).contains(&modes.len()) {
        return Err(format!("modes: {} of them is out of range: expected 1 to {MAX_MODES}", modes.len()));
    }
    let mode = |(index, mode): (usize, &Value)| read_mode(&format!("modes[{index}]"), mode);
    modes.iter().enumerate().map(mode).collect()
}

fn read_mode(place: &str, mode: &Value) -> Result<Mode, String> {
    let Value::Table(mode) = mode else {
        return Err(unexpected(place, "a mode, { ratio = … }", mode));
    };
    check_keys(mode, &format!("{place}."), &Mode::FIELDS.map(|(name, ..)| name))?;
    if !mode.contains_key("ratio") {
        return Err(format!("{place}: there is no ‘ratio’"));
    }
    let mut fields = Mode::UNIT.fields();
    for ((name, min, max), field) in Mode::FIELDS.into_iter().zip(&mut fields) {
        *field = match mode.get(name) {
            None => continue,
            Some(Value::Integer(number)) => *number as f32,
            Some(Value::Float(number)) => *number as f32,
            Some(other) => return Err(unexpected(&format!("{place}.{name}"), "a number", other)),
        };
        if !(min..=max).contains(field) {
            return Err(format!("{place}.{name}: {field} is out of range: expected {min} to {max}"));
        }
    }
    Ok(Mode::from_fields(fields))
}

pub(super) fn to_toml(preset: &Preset) -> String {
    let mut out = format!("format = {FORMAT_VERSION}\n");
    let Preset { name, author, tags, comment, .. } = preset;
    out.push_str(&about_to_toml([name, author, comment], tags));
    let modes = preset.patch.modes.as_slice();
    if modes != [Mode::UNIT] && preset.patch.modes.origin().is_none() {
        out.push_str("modes = [\n");
        for mode in modes {
            let _ = writeln!(out, "    {{ {} }},", mode_fields(mode));
        }
        out.push_str("]\n");
    }
    out.push_str(&routes::to_toml(&preset.patch));
    out.push_str(&body::to_toml(&preset.patch));
    out.push_str("\n[params]\n");
    for info in PARAMS {
        let value = preset.patch.get(info.param);
        let is_news = value != info.default || body::writes(&preset.patch, info.param);
        if is_news && !routes::writes(&preset.patch, info.param) {
            let _ = match info.unit {
                Unit::Choice => writeln!(out, "{} = \"{}\"", info.id, info.choices[value as usize]),
                Unit::Count => writeln!(out, "{} = {value}", info.id),
                _ => writeln!(out, "{} = {value:?}", info.id),
            };
        }
    }
    out
}

/// The fields that differ from [`Mode::UNIT`]'s, and the ratio. `{:?}` of an `f32` is the shortest text that reads
/// back as the same number, and valid TOML.
fn mode_fields(mode: &Mode) -> String {
    let fields = Mode::FIELDS.iter().zip(mode.fields()).zip(Mode::UNIT.fields());
    let written: Vec<String> = fields
        .filter(|(((name, ..), value), unit)| *name == "ratio" || value != unit)
        .map(|(((name, ..), value), _)| format!("{name} = {value:?}"))
        .collect();
    written.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::PARAM_COUNT;
    use crate::patch::routes::{MAX_ROUTES, Response, Route, Source};
    use crate::text::printable_lines;
    use proptest::option;
    use proptest::prelude::*;
    use proptest::sample::select;

    fn read_text(text: &str) -> crate::Result<Preset> {
        parse(text, "x", &mut |_| {})
    }

    fn error(body: &str) -> String {
        read_text(&format!("format = 1\nname = \"a\"\n{body}")).unwrap_err().to_string()
    }

    #[test]
    fn numbers_and_texts_are_read_in_the_unit_of_the_table() {
        let text = "format = 1\nname = \"a\"\ntags = [\"b\"]\nmodes = [{ ratio = 2, level = -0.5 }]\n\
                    [params]\ndecay = \"250 ms\"\ngain = -3\nexciter = \"pluck\"\nfine = 1.5";
        let preset = read_text(text).unwrap();
        let mut expected = Patch::default()
            .with(Param::Decay, 0.25)
            .with(Param::Gain, -3.0)
            .with(Param::Exciter, 2.0)
            .with(Param::Fine, 1.5);
        expected.modes = ModeTable::new(&[Mode { ratio: 2.0, level: -0.5, ..Mode::UNIT }]);
        assert_eq!(preset.patch, expected);
        assert_eq!((preset.tags, preset.author, preset.comment), (vec!["b".to_owned()], String::new(), String::new()));
    }

    #[test]
    fn every_error_says_what_would_be_right() {
        for (body, expected) in [
            ("colour = 1", "x: unknown key ‘colour’: expected one of format, name, "),
            ("comments = 1", "x: unknown key ‘comments’; the nearest is ‘comment’"),
            ("[params]\ndeacy = 1", "x: unknown key ‘params.deacy’; the nearest is ‘decay’"),
            ("[params]\nxylophone = 1", "x: unknown key ‘params.xylophone’; ‘sprung params’ shows them all"),
            ("[params]\ngain = 99", "x: params.gain: 99 is out of range: expected from -60 dB to 12 dB"),
            ("[params]\ngain = nan", "x: params.gain: NaN is out of range: expected from -60 dB to 12 dB"),
            ("[params]\ngain = -inf", "x: params.gain: -inf is out of range"),
            ("[params]\ngain = true", "x: params.gain: expected a number or a text with a unit, found boolean"),
            ("[params]\nmode = 1", "x: params.mode: ‘1’ is not one of poly, mono, legato"),
            ("[params]\nmode = \"solo\"", "x: params.mode: ‘solo’ is not one of poly, mono, legato"),
            ("[params]\nvoices = 2.5", "x: params.voices: 2.5 is out of range: expected a whole number from 1 to 64"),
            ("params = 3", "x: params: expected a table [params], found integer ‘3’"),
            ("modes = []", "x: modes: 0 of them is out of range: expected 1 to 512"),
            ("modes = [{ level = 1 }]", "x: modes[0]: there is no ‘ratio’"),
            ("modes = [{ ratio = 1 }, { ratio = 0 }]", "x: modes[1].ratio: 0 is out of range: expected 0.01 to 1000"),
            ("modes = [{ ratio = nan }]", "x: modes[0].ratio: NaN is out of range: expected 0.01 to 1000"),
            ("modes = [{ ratio = 1, pam = 0 }]", "x: unknown key ‘modes[0].pam’; the nearest is ‘pan’"),
            ("modes = [{ ratio = \"1\" }]", "x: modes[0].ratio: expected a number, found string"),
            ("modes = [1]", "x: modes[0]: expected a mode, { ratio = … }, found integer ‘1’"),
            ("tags = [1]", "x: tags[0]: expected a text, found integer ‘1’"),
            ("author = \"a\\nb\"", "x: author: expected one line of at most 100 characters"),
            ("name = 2", "x:3:1: not valid TOML: duplicate key"),
            ("a = ", "x:3:"),
        ] {
            let error = error(body);
            assert!(error.starts_with(expected), "{body}: {error}");
            assert_eq!(error.lines().count(), 1, "{error}");
        }
        let many = format!("modes = [{}]", "{ ratio = 1 },".repeat(513));
        assert_eq!(error(&many), "x: modes: 513 of them is out of range: expected 1 to 512");
    }

    #[test]
    fn the_version_comes_before_all_else() {
        for (text, expected) in [
            ("format = 4\nwarp = 1", "x: format 4 is of a newer version: this one reads up to format = 3"),
            ("format = 0", "x: format 0 is unknown: this version reads format = 1 to 3"),
            ("format = \"1\"", "x: format \"1\" is unknown: this version reads format = 1 to 3"),
            ("name = \"a\"", "x: there is no ‘format’: expected format = 3"),
            ("format = 1", "x: there is no ‘name’: expected name = \"…\""),
        ] {
            assert_eq!(read_text(text).unwrap_err().to_string(), expected);
        }
    }

    #[test]
    fn nothing_in_a_written_file_steers_a_terminal() {
        for text in
            ["\u{1b}[2J", "\u{202e}\"gnp\"\\", "a\tb\n\u{9b}1m", "'\u{2066}'\n\"\"\"", "plain \"quotes\"\nand 'lines'"]
        {
            let mut preset = read_text("format = 1\nname = \"a\"").unwrap();
            preset.comment = text.to_owned();
            preset.tags = vec!["\u{200f}b".to_owned()];
            let written = preset.to_toml();
            assert_eq!(printable_lines(&written), written);
            assert_eq!(read_text(&written).unwrap(), preset, "{written}");
        }
    }

    #[test]
    fn a_new_preset_names_no_parameter() {
        let preset = read_text("format = 1\nname = \"a\"").unwrap();
        assert_eq!(preset.patch, Patch::default());
        assert!(preset.to_toml().ends_with("\n[params]\n"), "{}", preset.to_toml());
    }

    fn any_mode() -> impl Strategy<Value = Mode> {
        let field = |index: usize| Mode::FIELDS[index].1..=Mode::FIELDS[index].2;
        (field(0), field(1), field(2), field(3), field(4))
            .prop_map(|(a, b, c, d, e)| Mode::from_fields([a, b, c, d, e]))
    }

    fn any_route() -> impl Strategy<Value = Option<Route>> {
        let source = || select(Source::ALL.to_vec());
        let movable: Vec<Param> = PARAMS.iter().filter(|info| info.is_modulatable()).map(|info| info.param).collect();
        let parts = (source(), select(movable), select(Response::ALL.to_vec()), option::of(source()));
        let route = |(source, destination, response, scale)| Route { source, destination, response, scale };
        option::of(parts.prop_map(route))
    }

    proptest! {
        #[test]
        fn presets_survive_their_file_exactly(
            texts in proptest::collection::vec("[^\\p{C}\\s]{1,20}", 3),
            comment in ".*\n?.*",
            positions in proptest::collection::vec(0.0..=1.0f64, PARAM_COUNT),
            modes in proptest::collection::vec(any_mode(), 1..=MAX_MODES),
            routes in proptest::collection::vec(any_route(), MAX_ROUTES),
        ) {
            let mut patch = Patch { modes: ModeTable::new(&modes), ..Patch::default() };
            for (info, position) in PARAMS.iter().zip(positions) {
                patch.set(info.param, info.denormalise(position));
            }
            routes.into_iter().enumerate().for_each(|(place, route)| patch.routes.set(place, route));
            let [name, author, tag] = <[String; 3]>::try_from(texts).unwrap();
            let preset = Preset { name, author, tags: vec![tag], comment, patch };
            let text = preset.to_toml();
            prop_assert_eq!(read_text(&text).map_err(|e| TestCaseError::fail(format!("{e}\n{text}")))?, preset);
        }

        #[test]
        fn random_text_never_panics(text in "\\PC*", keyed in "(modes|params|tags|name) ?= ?[\\[\\{\\}\\]0-9a-z\",=. ]*") {
            let _ = read_text(&text);
            let _ = read_text(&format!("format = 1\nname = \"a\"\n{keyed}"));
        }
    }
}
