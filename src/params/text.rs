//! Values as people write them: numbers with units, choices by name.

use super::{ParamInfo, Unit};
use crate::units::{key_from_note_name, split_quantity, with_decimal_point};

impl Unit {
    /// The unit's symbol as written after a number; empty for plain numbers and choices.
    pub fn symbol(self) -> &'static str {
        match self {
            Unit::Number | Unit::Count | Unit::Choice => "",
            Unit::Decibels => "dB",
            Unit::DecibelsPerOctave => "dB/oct",
            Unit::Seconds => "s",
            Unit::Hertz => "Hz",
            Unit::Percent => "%",
            Unit::Semitones => "st",
            Unit::Cents => "ct",
        }
    }

    /// How much one of the unit `suffix` is in this unit; `None` if that unit cannot be converted to this one.
    fn scale_of(self, suffix: &str) -> Option<f64> {
        let suffix = suffix.to_lowercase();
        match (self, suffix.as_str()) {
            (_, "") => Some(1.0),
            (Unit::Decibels, "db") | (Unit::DecibelsPerOctave, "db/oct" | "db/octave" | "db") => Some(1.0),
            (Unit::Seconds, "s" | "sec" | "seconds") => Some(1.0),
            (Unit::Seconds, "ms") => Some(1e-3),
            (Unit::Seconds, "us" | "µs") => Some(1e-6),
            (Unit::Hertz, "hz") => Some(1.0),
            (Unit::Hertz, "khz") => Some(1e3),
            (Unit::Percent, "%") => Some(1.0),
            (Unit::Semitones, "st" | "semi" | "semitones" | "semitone") => Some(1.0),
            (Unit::Semitones, "ct" | "cents" | "cent") => Some(0.01),
            (Unit::Semitones, "oct" | "octaves" | "octave") => Some(12.0),
            (Unit::Cents, "ct" | "cents" | "cent") => Some(1.0),
            (Unit::Cents, "st" | "semi" | "semitones" | "semitone") => Some(100.0),
            _ => None,
        }
    }
}

impl ParamInfo {
    /// Reads a value with or without its unit: `"-12 dB"`, `"440 Hz"`, `"250 ms"`, `"50 %"`, `"contact"`.
    /// [`Unit::Hertz`] also takes note names (`"A4"`). The error says what was expected.
    pub fn parse(&self, text: &str) -> Result<f32, String> {
        let text = text.trim();
        if self.unit == Unit::Choice {
            let found = self.choices.iter().position(|choice| choice.eq_ignore_ascii_case(text));
            return match found {
                Some(index) => Ok(index as f32),
                None => Err(format!("‘{text}’ is not one of {}", self.choices.join(", "))),
            };
        }
        if self.unit == Unit::Hertz
            && let Some(key) = key_from_note_name(text)
        {
            return self.check(crate::units::frequency_from_key(f64::from(key), 440.0) as f32);
        }
        match self.quantity(text) {
            Some(value) => self.check(value as f32),
            None => {
                let unit = self.unit.symbol();
                let unit = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
                let expected = match with_decimal_point(text) {
                    Some(written) => format!("{written}, with a decimal point"),
                    None => self.range(),
                };
                Err(format!("‘{text}’ is not a number{unit}: expected {expected}"))
            }
        }
    }

    /// Reads a number with or without its unit. The range is not checked, since the number may be a distance between
    /// two values.
    pub(crate) fn quantity(&self, text: &str) -> Option<f64> {
        split_quantity(text.trim()).and_then(|(value, suffix)| Some(value * self.unit.scale_of(suffix)?))
    }

    /// Writes a value with its unit, so that [`ParamInfo::parse`] reads it back to the precision shown.
    pub fn format(&self, value: f32) -> String {
        let value = self.clamp(value);
        let symbol = self.unit.symbol();
        match self.unit {
            Unit::Choice => self.choices[value as usize].to_owned(),
            Unit::Count => format!("{value:.0}"),
            Unit::Number => trim_zeros(format!("{value:.3}")),
            // From here on, two decimals of a millisecond round to 1000 ms.
            Unit::Seconds if value < 0.999_995 => {
                format!("{} ms", trim_zeros(format!("{:.2}", f64::from(value) * 1e3)))
            }
            Unit::Seconds => format!("{} s", trim_zeros(format!("{value:.3}"))),
            Unit::Decibels | Unit::DecibelsPerOctave | Unit::Percent | Unit::Cents => {
                format!("{} {symbol}", trim_zeros(format!("{value:.2}")))
            }
            Unit::Hertz | Unit::Semitones => format!("{} {symbol}", trim_zeros(format!("{value:.3}"))),
        }
    }
}

/// `"1.500"` → `"1.5"`, `"-0.00"` → `"0"`.
fn trim_zeros(number: String) -> String {
    let short = if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { &number };
    if short == "-0" { "0".to_owned() } else { short.to_owned() }
}

#[cfg(test)]
mod tests {
    use crate::params::Param;

    #[test]
    fn values_are_read_in_the_units_people_write() {
        for (param, text, value) in [
            (Param::Gain, "-12 dB", -12.0),
            (Param::Tuning, "442 Hz", 442.0),
            (Param::Tuning, "A4", 440.0),
            (Param::Decay, "1.5 s", 1.5),
            (Param::Decay, "250ms", 0.25),
            (Param::Width, "50 %", 50.0),
            (Param::Sweep, "2 oct", 24.0),
            (Param::Vibrato, "1 st", 100.0),
            (Param::MalletPulse, "Contact", 1.0),
            (Param::Voices, "8", 8.0),
        ] {
            assert_eq!(param.info().parse(text), Ok(value), "{text}");
        }
    }

    #[test]
    fn times_round_to_what_is_shown() {
        for (seconds, text) in [
            (0.25, "250 ms"),
            (0.9994, "999.4 ms"),
            (0.9995, "999.5 ms"),
            (0.9999, "999.9 ms"),
            (0.999_999, "1 s"),
            (1.0, "1 s"),
        ] {
            assert_eq!(Param::Decay.info().format(seconds), text);
        }
    }

    #[test]
    fn bad_values_say_what_would_be_right() {
        for (param, text, expected) in [
            (Param::Gain, "99 dB", "99 is out of range: expected from -60 dB to 12 dB"),
            (Param::Gain, "loud", "‘loud’ is not a number in dB: expected from -60 dB to 12 dB"),
            (Param::Gain, "NaN", "‘NaN’ is not a number in dB: expected from -60 dB to 12 dB"),
            (Param::Decay, "3 Hz", "‘3 Hz’ is not a number in s: expected from 5 ms to 60 s"),
            (Param::Decay, "0,5 s", "‘0,5 s’ is not a number in s: expected 0.5 s, with a decimal point"),
            (Param::Voices, "1,2,3", "‘1,2,3’ is not a number: expected a whole number from 1 to 64"),
            (Param::Voices, "2.5", "2.5 is out of range: expected a whole number from 1 to 64"),
            (Param::Mode, "solo", "‘solo’ is not one of poly, mono, legato"),
        ] {
            assert_eq!(param.info().parse(text), Err(expected.to_owned()), "{text}");
        }
        assert!(Param::Gain.info().check(f32::NAN).is_err());
    }
}
