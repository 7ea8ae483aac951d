//! What the knobs of a kit of several sounds do to each pad's own values, as text.

use sprung::params::{Curve, ParamInfo, Unit};
use sprung::units::number_in_unit;

/// Said of a choice that stays as each pad has it.
const OWN: &str = "own";

/// What a knob does: `+3 dB` where its steps are equal, `× 1.5` where its ratios are. A choice goes on by some places in its list.
pub(crate) fn written(info: &ParamInfo, value: f32) -> String {
    let by = value - info.default;
    match (info.unit, info.curve) {
        (Unit::Choice, _) if by == 0.0 => OWN.to_owned(),
        (_, Curve::Logarithmic) => format!("× {}", number(value / info.default)),
        (unit, Curve::Linear) => {
            let sign = if by == 0.0 {
                "±"
            } else if by > 0.0 {
                "+"
            } else {
                ""
            };
            format!("{sign}{} {}", number(by), unit.symbol()).trim_end().to_owned()
        }
    }
}

/// Reads what [`written`] writes, with or without sign and unit. The error says what was expected.
pub(crate) fn read(info: &ParamInfo, text: &str) -> Result<f32, String> {
    let bare = text.trim().trim_start_matches(['×', '*', 'x', '±', '+', ' ']).replace('−', "-");
    let value = match info.curve {
        Curve::Logarithmic => number_in_unit("", &bare).map(|by| by as f32 * info.default),
        Curve::Linear => number_in_unit(info.unit.symbol(), &bare).map(|by| by as f32 + info.default),
    };
    // The ends as they are written may be a little beyond.
    let fits = |value: &f32| (info.clamp(*value) - value).abs() <= 0.01 * value.abs();
    value.filter(fits).map(|value| info.clamp(value)).ok_or_else(|| {
        let [least, most] = [info.min, info.max].map(|end| written(info, end));
        format!("‘{}’ cannot be added to the pads’ own values: expected from {least} to {most}", text.trim())
    })
}

/// A number to some three digits, without zeros at its end.
fn number(value: f32) -> String {
    let places = if value.abs() < 0.1 { 5 } else { 3 };
    let text = format!("{value:.places$}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::params::{PARAMS, Param};

    #[test]
    fn offsets_are_read_as_they_are_written() {
        for (param, value, text) in [
            (Param::MalletLevel, 3.0, "+3 dB"),
            (Param::Gain, Param::Gain.info().default, "±0 dB"),
            (Param::Tilt, -1.5, "-1.5 dB/oct"),
            (Param::Decay, 1.5 * Param::Decay.info().default, "× 1.5"),
        ] {
            let info = param.info();
            assert_eq!(written(info, value), text);
            assert_eq!(read(info, text), Ok(value), "{text}");
        }
        assert_eq!(written(Param::MalletPulse.info(), 0.0), "own");
        assert_eq!(written(Param::MalletPulse.info(), 1.0), "+1");
        for info in PARAMS.iter().filter(|info| info.unit != Unit::Choice) {
            for value in [info.min, info.default, info.max] {
                assert!(read(info, &written(info, value)).is_ok(), "{}: {}", info.id, written(info, value));
            }
        }
        let complaint = read(Param::MalletLevel.info(), "99").unwrap_err();
        assert!(complaint.ends_with("expected from -60 dB to +24 dB"), "{complaint}");
    }
}
