//! Reads and writes the TOML of a preset file, key by key, so that every error names its place and what would be right.

use super::about::{About, about_to_toml};
use super::complaints::Complaints;
use super::guide::Guide;
use super::value::{check_keys, param_value, table, unexpected};
use super::{FORMAT_VERSION, Preset};
use super::{body, mode_list, routes, tuning};
use crate::error::Error;
use crate::params::{PARAMS, Param, ParamInfo, Unit};
use crate::patch::Patch;
use std::fmt::Write;
use toml::{Table, Value};

const KEYS: [&str; 13] = [
    "format", "name", "author", "tags", "comment", "details", "modes", "body", "second", "joint", "routes", "params",
    "tuning",
];

/// All keys.
fn known_keys() -> Vec<&'static str> {
    KEYS.into_iter().chain(Guide::KEYS).collect()
}

/// Reads as much of a preset as possible. Returns an error only if the text is no preset at all.
pub(super) fn parse(text: &str, origin: &str, complaints: &mut Complaints) -> crate::Result<Preset> {
    read(&table(text, origin)?, complaints).map_err(|message| Error::format(origin, message))
}

pub(super) fn read(table: &Table, complaints: &mut Complaints) -> Result<Preset, String> {
    if table.contains_key("kit") {
        return Err(format!("this is a kit: expected a preset, which begins with format = {FORMAT_VERSION}"));
    }
    // The version comes first, since keys may have another meaning in a file of a newer version.
    match table.get("format") {
        Some(Value::Integer(FORMAT_VERSION)) => {}
        Some(Value::Integer(newer)) if *newer > FORMAT_VERSION => {
            complaints.add(format!("format {newer} is of a newer version: this one reads format = {FORMAT_VERSION}"));
        }
        Some(other) => return Err(format!("format {other} is unknown: this version reads format = {FORMAT_VERSION}")),
        None => return Err(format!("there is no ‘format’: expected format = {FORMAT_VERSION}")),
    }
    check_keys(table, "", &known_keys(), complaints);
    let About { name, author, tags, comment, details } = About::read(table, complaints);
    let mut patch = Patch::default();
    match table.get("params") {
        Some(Value::Table(params)) => read_params(params, &mut patch, complaints),
        None => {}
        Some(other) => complaints.add(unexpected("params", "a table [params]", other)),
    }
    patch.modes = mode_list::read(table.get("modes"), complaints);
    body::read(table, &mut patch, complaints);
    routes::read(table, &mut patch, complaints);
    let tuning = tuning::read(table, complaints);
    let guide = Guide::read(table, complaints);
    Ok(Preset { name, author, tags, comment, details, guide, patch, tuning })
}

fn read_params(params: &Table, patch: &mut Patch, complaints: &mut Complaints) {
    check_keys(params, "params.", &PARAMS.iter().map(|info| info.id).collect::<Vec<_>>(), complaints);
    for (id, value) in params {
        if let Some(param) = Param::from_id(id)
            && let Some(value) = complaints.take(&format!("params.{id}: "), param_value(param.info(), value))
        {
            patch.set(param, value);
        }
    }
}

pub(super) fn to_toml(preset: &Preset) -> String {
    let mut out = format!("format = {FORMAT_VERSION}\n");
    let Preset { name, author, tags, comment, details, .. } = preset;
    out.push_str(&about_to_toml([name, author, comment, details], tags));
    out.push_str(&preset.guide.to_toml());
    out.push_str(&mode_list::to_toml(&preset.patch.modes));
    out.push_str(&routes::to_toml(&preset.patch));
    out.push_str(&body::to_toml(&preset.patch));
    out.push_str("\n[params]\n");
    for info in PARAMS {
        let value = preset.patch.get(info.param);
        let is_news = value != info.default || body::writes(&preset.patch, info.param);
        if is_news && !routes::writes(&preset.patch, info.param) {
            write_value(&mut out, info, value);
        }
    }
    out.push_str(&tuning::to_toml(preset.tuning.as_ref()));
    out
}

/// Writes a line with a parameter and its value.
pub(super) fn write_value(out: &mut String, info: &ParamInfo, value: f32) {
    let _ = match info.unit {
        Unit::Choice => writeln!(out, "{} = \"{}\"", info.id, info.choices[value as usize]),
        Unit::Count => writeln!(out, "{} = {value}", info.id),
        _ => writeln!(out, "{} = {value:?}", info.id),
    };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::PARAM_COUNT;
    use crate::patch::routes::{MAX_ROUTES, Response, Route, Source};
    use crate::patch::{MAX_MODES, Mode, ModeTable};
    use crate::text::printable_lines;
    use proptest::option;
    use proptest::prelude::*;
    use proptest::sample::select;
    use std::f32::consts::PI;

    fn read_text(text: &str) -> crate::Result<Preset> {
        Preset::parse(text, "x")
    }

    fn error(body: &str) -> String {
        read_text(&format!("format = 1\nname = \"a\"\n{body}")).unwrap_err().to_string()
    }

    #[test]
    fn numbers_and_texts_are_read_in_the_unit_of_the_table() {
        let text = "format = 1\nname = \"a\"\ntags = [\"b\"]\nmodes = [{ ratio = 2, level = -0.5 }]\n\
                    [params]\ndecay = \"250 ms\"\ngain = -3\nmode = \"mono\"\nfine = 1.5";
        let preset = read_text(text).unwrap();
        let mut expected = Patch::default()
            .with(Param::Decay, 0.25)
            .with(Param::Gain, -3.0)
            .with(Param::Mode, 1.0)
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
            ("format = 2\nwarp = 1", "x: format 2 is of a newer version: this one reads format = 1"),
            ("format = 0", "x: format 0 is unknown: this version reads format = 1"),
            ("format = \"1\"", "x: format \"1\" is unknown: this version reads format = 1"),
            ("name = \"a\"", "x: there is no ‘format’: expected format = 1"),
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
            (preset.comment, preset.details) = (text.to_owned(), text.to_owned());
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
            [comment, details] in [".*\n?.*", ".*\n?.*"],
            positions in proptest::collection::vec(0.0..=1.0f64, PARAM_COUNT),
            modes in proptest::collection::vec(any_mode(), 1..=MAX_MODES),
            phases in option::of(proptest::collection::vec(-PI..=PI, MAX_MODES)),
            routes in proptest::collection::vec(any_route(), MAX_ROUTES),
        ) {
            let table = ModeTable::new(&modes);
            let table = match phases {
                Some(phases) => table.with_phases(&phases[..modes.len()]),
                None => table,
            };
            let mut patch = Patch { modes: table, ..Patch::default() };
            for (info, position) in PARAMS.iter().zip(positions) {
                patch.set(info.param, info.denormalise(position));
            }
            routes.into_iter().enumerate().for_each(|(place, route)| patch.routes.set(place, route));
            let [name, author, tag] = <[String; 3]>::try_from(texts).unwrap();
            let guide = Guide::default();
            let preset = Preset { name, author, tags: vec![tag], comment, details, guide, patch, tuning: None };
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
