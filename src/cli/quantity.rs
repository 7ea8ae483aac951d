//! Values as options give them: ranges, units and pairs, with errors that say what would be right.

use sprung::io::SampleFormat;
use sprung::params::{PARAMS, Param};
use sprung::render::{Level, Tail};
use sprung::units::split_quantity;
use std::ops::RangeInclusive;

/// Longest held note and longest tail, in seconds.
const LONGEST: f64 = 86_400.0;

fn in_range(value: f64, range: RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    if range.contains(&value) {
        Ok(value)
    } else {
        Err(format!("{value} is out of range: expected {} to {}{unit}", range.start(), range.end()))
    }
}

/// A plain number, or one with its unit.
fn number(text: &str, units: &[(&str, f64)], range: RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    let quantity = split_quantity(text).and_then(|(value, suffix)| {
        let scale = units.iter().find(|(name, _)| name.eq_ignore_ascii_case(suffix));
        scale.map(|(_, scale)| value * scale)
    });
    let value = quantity
        .ok_or_else(|| format!("‘{text}’ is not a number: expected {} to {}{unit}", range.start(), range.end()))?;
    in_range(value, range, unit)
}

pub(super) fn seconds(text: &str) -> Result<f64, String> {
    number(text, &[("", 1.0), ("s", 1.0), ("ms", 1e-3)], 0.0..=LONGEST, " s")
}

pub(super) fn tail(text: &str) -> Result<Tail, String> {
    match text {
        "auto" => Ok(Tail::Auto),
        "none" => Ok(Tail::None),
        _ => seconds(text).map(Tail::Seconds).map_err(|error| format!("{error}, auto or none")),
    }
}

pub(super) fn gain_db(text: &str) -> Result<f64, String> {
    number(text, &[("", 1.0), ("dB", 1.0)], -120.0..=120.0, " dB")
}

pub(super) fn level(text: &str) -> Result<Level, String> {
    match text.split_once('=') {
        Some(("peak", value)) => {
            number(value, &[("", 1.0), ("dB", 1.0), ("dBFS", 1.0)], -120.0..=0.0, " dBFS").map(Level::Peak)
        }
        Some(("lufs", value)) => number(value, &[("", 1.0), ("LUFS", 1.0)], -70.0..=0.0, " LUFS").map(Level::Loudness),
        _ => Err("expected peak=DBFS or lufs=LUFS".to_owned()),
    }
}

pub(super) fn bits(text: &str) -> Result<SampleFormat, String> {
    match text {
        "16" => Ok(SampleFormat::Int16),
        "24" => Ok(SampleFormat::Int24),
        "32f" => Ok(SampleFormat::Float32),
        _ => Err("expected 16, 24 or 32f".to_owned()),
    }
}

/// A note as `--note` takes it. Where frequencies lie depends on the patch, so only the form is checked here.
pub(super) fn note(text: &str) -> Result<String, String> {
    sprung::units::parse_key(text, f64::from(Param::Tuning.info().default)).map(|_| text.to_owned())
}

/// `id=value`, the value as the parameter table reads it.
pub(super) fn setting(text: &str) -> Result<(Param, f32), String> {
    let (id, value) = text.split_once('=').ok_or("expected ID=VALUE, as in decay=0.5")?;
    let id = id.trim();
    let param =
        Param::from_id(id).ok_or_else(|| match sprung::error::nearest(id, PARAMS.iter().map(|info| info.id)) {
            Some(near) => format!("there is no parameter ‘{id}’; the nearest is ‘{near}’"),
            None => format!("there is no parameter ‘{id}’; ‘sprung params’ shows them all"),
        })?;
    let value = param.info().parse(value).map_err(|message| format!("{id}: {message}"))?;
    Ok((param, value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_read_with_and_without_units() {
        assert_eq!(seconds("2"), Ok(2.0));
        assert_eq!(seconds("250 ms"), Ok(0.25));
        assert_eq!(tail("auto"), Ok(Tail::Auto));
        assert_eq!(tail("1.5s"), Ok(Tail::Seconds(1.5)));
        assert_eq!(gain_db("-3 dB"), Ok(-3.0));
        assert_eq!(level("peak=-1"), Ok(Level::Peak(-1.0)));
        assert_eq!(level("lufs=-14 LUFS"), Ok(Level::Loudness(-14.0)));
        assert_eq!(setting("exciter=pluck"), Ok((Param::Exciter, 2.0)));
        assert_eq!(setting("decay = 250 ms"), Ok((Param::Decay, 0.25)));
    }

    #[test]
    fn wrong_quantities_say_what_would_be_right() {
        for (result, expected) in [
            (seconds("-1").err(), "-1 is out of range: expected 0 to 86400 s"),
            (seconds("nan").err(), "‘nan’ is not a number: expected 0 to 86400 s"),
            (seconds("1 dB").err(), "‘1 dB’ is not a number: expected 0 to 86400 s"),
            (tail("long").err(), "‘long’ is not a number: expected 0 to 86400 s, auto or none"),
            (gain_db("inf").err(), "‘inf’ is not a number: expected -120 to 120 dB"),
            (level("peak=3").err(), "3 is out of range: expected -120 to 0 dBFS"),
            (level("rms=-3").err(), "expected peak=DBFS or lufs=LUFS"),
            (bits("8").err(), "expected 16, 24 or 32f"),
            (setting("gain").err(), "expected ID=VALUE, as in decay=0.5"),
            (setting("deacy=1").err(), "there is no parameter ‘deacy’; the nearest is ‘decay’"),
            (setting("gain=99").err(), "gain: 99 is out of range: expected from -60 dB to 12 dB"),
        ]
        .map(|(error, expected)| (error.unwrap_or_default(), expected))
        {
            assert_eq!(result, expected);
        }
    }
}
