//! Values in a line of jobs: the distributions that each name allows, and conversion to text.

use super::draw::Draw;
use crate::params::{Param, Unit};
use crate::request::quantity::decimal;
use crate::request::{Name, Number};
use serde_json::{Map, Value};

/// The numbers that an option or parameter accepts.
pub(super) enum Scale {
    /// The numbers of a parameter.
    Parameter(Param),
    /// The numbers of an option.
    Option(Number),
    /// No numbers: values can only be chosen from a list.
    Words,
}

impl Scale {
    /// The scale of the value with these keys in a line.
    pub(super) fn of(path: &[String]) -> Self {
        let param = match path {
            [set, name] if set == "set" => Param::from_id(name),
            [name] if Name::find(name).is_none() => Param::from_id(name),
            _ => None,
        };
        match (param, path) {
            (Some(param), _) if param.info().unit != Unit::Choice => Self::Parameter(param),
            (None, [name]) => Name::find(name).and_then(|option| option.number).map_or(Self::Words, Self::Option),
            _ => Self::Words,
        }
    }

    /// Reads a distribution: an object with one key.
    pub(super) fn read(&self, object: Map<String, Value>) -> Result<Draw, String> {
        let mut keys = object.into_iter();
        let expected = "expected a value, or one of uniform, log_uniform, integer, normal, choice";
        let (Some((kind, value)), None) = (keys.next(), keys.next()) else { return Err(expected.to_owned()) };
        let is_whole = match self {
            Self::Parameter(param) => param.info().unit == Unit::Count,
            Self::Option(number) => number.is_whole,
            Self::Words => false,
        };
        match kind.as_str() {
            "uniform" if is_whole => self.bounds(&value).map(|[low, high]| Draw::Integer(low, high)),
            "uniform" => self.bounds(&value).map(|[low, high]| Draw::Uniform(low, high)),
            "log_uniform" | "normal" if is_whole => {
                Err(format!("‘{kind}’ draws no whole numbers: expected uniform or choice"))
            }
            "log_uniform" => match self.bounds(&value)? {
                [low, high] if low > 0.0 => Ok(Draw::LogUniform(low, high)),
                [low, _] => Err(format!("log_uniform from {low}: expected bounds above 0")),
            },
            "integer" => match self.bounds(&value)? {
                [low, high] if low.fract() == 0.0 && high.fract() == 0.0 => Ok(Draw::Integer(low, high)),
                _ => Err("integer: expected whole numbers".to_owned()),
            },
            "normal" => {
                let [mean, deviation] = Self::pair(&value, "[mean, deviation]")?;
                let [mean, deviation] = [self.number(mean)?, self.deviation(deviation)?];
                if deviation < 0.0 {
                    return Err(format!("normal: the deviation {deviation} is below 0"));
                }
                Ok(Draw::Normal(mean, deviation, self.range()))
            }
            "choice" => match value {
                Value::Array(values) if !values.is_empty() => Ok(Draw::Choice(values)),
                _ => Err("choice: expected a list of values".to_owned()),
            },
            _ => Err(format!("‘{kind}’ is no way to draw: {expected}")),
        }
    }

    fn bounds(&self, value: &Value) -> Result<[f64; 2], String> {
        let [low, high] = Self::pair(value, "[lowest, highest]")?;
        let [low, high] = [self.number(low)?, self.number(high)?];
        if low > high { Err(format!("{low} is above {high}: expected the lower bound first")) } else { Ok([low, high]) }
    }

    fn pair<'a>(value: &'a Value, expected: &str) -> Result<[&'a Value; 2], String> {
        match value.as_array().map(Vec::as_slice) {
            Some([first, second]) => Ok([first, second]),
            _ => Err(format!("expected {expected}")),
        }
    }

    /// The standard deviation of a normal distribution, which may be outside the parameter's range.
    fn deviation(&self, value: &Value) -> Result<f64, String> {
        match (self, value) {
            (Self::Parameter(param), Value::String(text)) => {
                let expected =
                    || format!("‘{text}’ is no deviation: expected a number, or one with a unit as values have");
                param.info().quantity(text).ok_or_else(expected)
            }
            _ => self.number(value),
        }
    }

    /// A number, or a text with its unit.
    fn number(&self, value: &Value) -> Result<f64, String> {
        let number = match (self, value) {
            (Self::Words, _) => return Err("it is no number: expected choice".to_owned()),
            (_, Value::Number(number)) => number.as_f64(),
            (Self::Parameter(param), Value::String(text)) => Some(decimal(param.info().parse(text)?)),
            (Self::Option(number), Value::String(text)) => Some((number.parse)(text)?),
            _ => None,
        };
        number.filter(|number| number.is_finite()).ok_or_else(|| format!("‘{value}’ is not a number"))
    }

    fn range(&self) -> [f64; 2] {
        match self {
            // The decimal numbers of the table, so that a clamped value is written as the table writes it.
            Self::Parameter(param) => [param.info().min, param.info().max].map(decimal),
            Self::Option(number) => [number.min, number.max],
            Self::Words => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }
}

/// A value as the command line would take it.
pub(super) fn text_of(value: &Value) -> Result<String, String> {
    match value {
        Value::String(text) => Ok(text.clone()),
        Value::Bool(yes) => Ok(yes.to_string()),
        Value::Number(number) => Ok(match (number.as_u64(), number.as_f64()) {
            (None, Some(number)) => number.to_string(),
            _ => number.to_string(),
        }),
        Value::Array(values) if values.iter().all(|value| !value.is_array()) => {
            values.iter().map(text_of).collect::<Result<Vec<_>, _>>().map(|texts| texts.join(","))
        }
        _ => Err(format!("‘{value}’ is not a value: expected a number, a text, true, false or a list")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deviation_may_be_out_of_range() {
        let scale = Scale::of(&["decay".to_owned()]);
        let [least, most] = scale.range();
        let read = |mean: &str, deviation: &str| {
            let object = serde_json::json!({ "normal": [mean, deviation] });
            scale.read(object.as_object().unwrap().clone())
        };
        assert_eq!(read("1 s", "0.001 ms"), Ok(Draw::Normal(1.0, 1e-6, [least, most])));
        assert!(least > 1e-6 && read("0.001 ms", "1 s").unwrap_err().contains("out of range"));
        assert!(read("1 s", "2 m").unwrap_err().starts_with("‘2 m’ is no deviation"));
    }
}
