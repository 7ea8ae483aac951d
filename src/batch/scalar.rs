//! Values of a line: what can be drawn for which name, and values as text.

use super::draw::Draw;
use crate::params::{Param, Unit};
use crate::request::{Number, Request};
use serde_json::{Map, Value};

/// What numbers a name takes.
pub(super) enum Scale {
    /// A parameter's.
    Parameter(Param),
    /// An option's.
    Option(Number),
    /// None: it can only be chosen.
    Words,
}

impl Scale {
    /// That of what has these keys in a line.
    pub(super) fn of(path: &[String]) -> Self {
        let option = |name: &str| Request::NAMES.iter().find(|option| option.name == name);
        let param = match path {
            [set, name] if set == "set" => Param::from_id(name),
            [name] if option(name).is_none() => Param::from_id(name),
            _ => None,
        };
        match (param, path) {
            (Some(param), _) if param.info().unit != Unit::Choice => Self::Parameter(param),
            (None, [name]) => option(name).and_then(|option| option.number).map_or(Self::Words, Self::Option),
            _ => Self::Words,
        }
    }

    /// Reads how a value is drawn: an object with one key.
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
                let [mean, deviation] = self.pair(&value, "[mean, deviation]")?;
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
        let [low, high] = self.pair(value, "[lowest, highest]")?;
        if low > high { Err(format!("{low} is above {high}: expected the lower bound first")) } else { Ok([low, high]) }
    }

    fn pair(&self, value: &Value, expected: &str) -> Result<[f64; 2], String> {
        let Some([first, second]) = value.as_array().map(Vec::as_slice) else {
            return Err(format!("expected {expected}"));
        };
        Ok([self.number(first)?, self.number(second)?])
    }

    /// A number, or a text with its unit.
    fn number(&self, value: &Value) -> Result<f64, String> {
        let number = match (self, value) {
            (Self::Words, _) => return Err("it is no number: expected choice".to_owned()),
            (_, Value::Number(number)) => number.as_f64(),
            // The deviation of a bell curve and the like need not be in the range of the parameter.
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

/// The number as written: 0.3, not 0.30000001192092896, which is the `f32` converted directly.
fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(value.into())
}

/// A value as people write it.
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
