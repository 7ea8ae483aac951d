//! Reads and writes the list of modes in a preset file: `modes = [{ ratio = 1.0 }, …]`.

use super::complaints::Complaints;
use super::value::{check_keys, number_in, unexpected};
use crate::patch::{MAX_MODES, Mode, ModeTable};
use std::f32::consts::PI;
use std::fmt::Write;
use toml::{Table, Value};

/// A mode's phase in radians, with its range. It is written only for tables that have phases.
const PHASE: (&str, f32, f32) = ("phase", -PI, PI);

/// Reads the modes of a preset; a single one if the file has none.
pub(super) fn read(modes: Option<&Value>, complaints: &mut Complaints) -> ModeTable {
    let modes = match modes {
        None => return ModeTable::new(&[]),
        Some(Value::Array(modes)) => modes,
        Some(other) => {
            complaints.add(unexpected("modes", "a list of modes, [{ ratio = … }, …]", other));
            return ModeTable::new(&[]);
        }
    };
    if !(1..=MAX_MODES).contains(&modes.len()) {
        complaints.add(format!("modes: {} of them is out of range: expected 1 to {MAX_MODES}", modes.len()));
    }
    let mode = |(index, mode): (usize, &Value)| read_mode(&format!("modes[{index}]"), mode, complaints);
    let (modes, phases): (Vec<Mode>, Vec<Option<f32>>) =
        modes.iter().take(MAX_MODES).enumerate().filter_map(mode).unzip();
    let table = ModeTable::new(&modes);
    if phases.iter().all(Option::is_none) {
        return table;
    }
    table.with_phases(&phases.into_iter().map(Option::unwrap_or_default).collect::<Vec<f32>>())
}

/// Reads a mode, if it has a ratio, and its phase, if it has one.
fn read_mode(place: &str, mode: &Value, complaints: &mut Complaints) -> Option<(Mode, Option<f32>)> {
    let keys: Vec<&str> = Mode::FIELDS.iter().chain([&PHASE]).map(|(name, ..)| *name).collect();
    let mode = table_of(mode, place, &keys, complaints)?;
    let number = |field| number_in(mode, place, field, |number| number as f32);
    if !mode.contains_key("ratio") {
        complaints.add(format!("{place}: there is no ‘ratio’"));
        return None;
    }
    let (mut fields, mut has_ratio) = (Mode::UNIT.fields(), true);
    for (field, value) in Mode::FIELDS.into_iter().zip(&mut fields) {
        match number(field).map(|number| complaints.take("", number)) {
            None => {}
            Some(Some(number)) => *value = number,
            Some(None) => has_ratio &= field.0 != "ratio",
        }
    }
    let phase = number(PHASE).and_then(|number| complaints.take("", number));
    has_ratio.then(|| (Mode::from_fields(fields), phase))
}

/// The table of a mode at `place`, which can have these keys.
pub(super) fn table_of<'a>(
    mode: &'a Value,
    place: &str,
    keys: &[&str],
    complaints: &mut Complaints,
) -> Option<&'a Table> {
    let Value::Table(mode) = mode else {
        complaints.add(unexpected(place, "a mode, { ratio = … }", mode));
        return None;
    };
    check_keys(mode, &format!("{place}."), keys, complaints);
    Some(mode)
}

/// The list of modes as TOML; empty if there is only the single mode of a new preset, or if the file has `[body]` instead.
pub(super) fn to_toml(table: &ModeTable) -> String {
    let modes = table.as_slice();
    if table.origin().is_some() || (modes == [Mode::UNIT] && !table.has_phases()) {
        return String::new();
    }
    let mut out = String::from("modes = [\n");
    for (index, mode) in modes.iter().enumerate() {
        let phase = table.has_phases().then(|| format!(", {} = {:?}", PHASE.0, table.phase(index)));
        let _ = writeln!(out, "    {{ {}{} }},", mode_fields(mode), phase.unwrap_or_default());
    }
    out.push_str("]\n");
    out
}

/// The ratio, and the fields that differ from [`Mode::UNIT`]. `{:?}` writes an `f32` as the shortest text that reads
/// back as the same number, and that is valid TOML.
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
    use crate::preset::Preset;
    use std::f32::consts::PI;

    fn parse(modes: &str) -> crate::Result<Preset> {
        Preset::parse(&format!("format = 1\nname = \"a\"\n{modes}"), "x")
    }

    #[test]
    fn phases_are_saved_and_read_as_they_were() {
        let preset = parse("modes = [{ ratio = 1 }, { ratio = 2, phase = -1.5 }]").unwrap();
        assert_eq!([0, 1].map(|mode| preset.patch.modes.phase(mode)), [0.0, -1.5]);
        for phases in [[0.0, -1.5], [PI, -PI], [0.0, 0.0]] {
            let mut preset = preset.clone();
            preset.patch.modes = preset.patch.modes.with_phases(&phases);
            let text = preset.to_toml();
            assert_eq!(text.matches("phase = ").count(), 2, "{text}");
            assert_eq!(Preset::parse(&text, "x").unwrap(), preset, "{text}");
        }
        let without = parse("modes = [{ ratio = 1 }, { ratio = 2 }]").unwrap();
        assert!(!without.patch.modes.has_phases() && !without.to_toml().contains("phase"));
        let single = parse("modes = [{ ratio = 1, phase = 1 }]").unwrap();
        assert_eq!(Preset::parse(&single.to_toml(), "x").unwrap(), single);
    }

    #[test]
    fn a_phase_that_is_out_of_range_or_no_number_is_an_error() {
        for (phase, why) in [
            ("3.2", "x: modes[0].phase: 3.2 is out of range: expected -3.1415927 to 3.1415927"),
            ("-4", "x: modes[0].phase: -4 is out of range: expected -3.1415927 to 3.1415927"),
            ("nan", "x: modes[0].phase: NaN is out of range"),
            ("true", "x: modes[0].phase: expected a number, found boolean"),
        ] {
            let error = parse(&format!("modes = [{{ ratio = 1, phase = {phase} }}]")).unwrap_err().to_string();
            assert!(error.starts_with(why), "{error}");
        }
    }
}
