//! Conversions between units, and parsing of quantities as text.

use libm::{exp2, log2, log10, pow};

/// MIDI key of A4, the note whose frequency sets the tuning.
pub(crate) const A4_KEY: f64 = 69.0;

/// Amplitude ratio of a level in decibels. 0 dB is exactly 1.
pub fn gain_from_db(db: f64) -> f64 {
    if db == 0.0 { 1.0 } else { pow(10.0, db / 20.0) }
}

/// Level in decibels of an amplitude ratio; `-inf` for zero.
pub fn db_from_gain(gain: f64) -> f64 {
    20.0 * log10(gain)
}

/// Frequency ratio of an interval in semitones. 0 is exactly 1.
pub fn ratio_from_semitones(semitones: f64) -> f64 {
    exp2(semitones / 12.0)
}

/// Interval in semitones of a frequency ratio.
pub fn semitones_from_ratio(ratio: f64) -> f64 {
    12.0 * log2(ratio)
}

/// Frequency in Hz of a (fractional) MIDI key in equal temperament.
pub fn frequency_from_key(key: f64, a4_hz: f64) -> f64 {
    a4_hz * ratio_from_semitones(key - A4_KEY)
}

/// (Fractional) MIDI key of a frequency in Hz in equal temperament.
pub fn key_from_frequency(frequency: f64, a4_hz: f64) -> f64 {
    A4_KEY + semitones_from_ratio(frequency / a4_hz)
}

const NOTE_NAMES: [&str; 12] = ["C", "C#", "D", "D#", "E", "F", "F#", "G", "G#", "A", "A#", "B"];

/// Name of a MIDI key, with C4 = 60: `C#4`, `A0`, `C-1`.
pub fn note_name(key: u8) -> String {
    format!("{}{}", NOTE_NAMES[usize::from(key % 12)], i32::from(key / 12) - 1)
}

/// MIDI key of a note name (`C#4`, `Db4`, `a0`, `C-1`); `None` if it is not a note name or outside 0–127.
pub(crate) fn key_from_note_name(name: &str) -> Option<u8> {
    semitones_from_note_name(name).and_then(|key| u8::try_from(key).ok()).filter(|key| *key < 128)
}

/// Semitones of a note name above C-1; `None` if it is no note name.
fn semitones_from_note_name(name: &str) -> Option<i32> {
    let mut characters = name.trim().chars();
    let letter = characters.next()?.to_ascii_uppercase();
    let natural = [9, 11, 0, 2, 4, 5, 7].get((letter as usize).checked_sub('A' as usize)?)?;
    let rest = characters.as_str();
    let (accidental, octave) = match rest.chars().next()? {
        '#' | '♯' => (1, rest.trim_start_matches(['#', '♯'])),
        'b' | '♭' => (-1, rest.trim_start_matches(['b', '♭'])),
        _ => (0, rest),
    };
    let octave: i32 = octave.parse().ok()?;
    octave.checked_add(1)?.checked_mul(12)?.checked_add(natural + accidental)
}

/// Mixes two channels to one: their mean. Real-time safe.
pub fn mono_from_stereo(left: f32, right: f32) -> f32 {
    0.5 * (left + right)
}

/// A fractional MIDI key from text: `C#4`, `60`, `60.5`, `440Hz`. `a4_hz` is used to convert frequencies.
pub fn parse_key(text: &str, a4_hz: f64) -> Result<f64, String> {
    let expected = "expected a note name (C#4), a key from 0 to 127 (60, 60.5) or a frequency (440Hz)";
    let key = if let Some(key) = semitones_from_note_name(text) {
        if !(0..=127).contains(&key) {
            return Err(format!("note ‘{text}’ is out of range: expected C-1 to G9"));
        }
        f64::from(key)
    } else {
        match split_quantity(text) {
            Some((value, "")) => value,
            Some((value, unit)) if unit.eq_ignore_ascii_case("hz") && value > 0.0 => key_from_frequency(value, a4_hz),
            Some((value, unit)) if unit.eq_ignore_ascii_case("khz") && value > 0.0 => {
                key_from_frequency(value * 1000.0, a4_hz)
            }
            _ => return Err(format!("‘{text}’ is not a note: {expected}")),
        }
    };
    // A frequency may be outside the keyboard, from subsonic frequencies up to any Nyquist limit; a key may not.
    let is_frequency = text.to_ascii_lowercase().contains("hz");
    let range = if is_frequency { -60.0..=200.0 } else { 0.0..=127.0 };
    if range.contains(&key) {
        return Ok(key);
    }
    let hint =
        if is_frequency || key < 0.0 { String::new() } else { format!("; for {text} Hz, write {}Hz", text.trim()) };
    Err(format!("note ‘{text}’ is out of range: {expected}{hint}"))
}

/// If `text` is a quantity with a decimal comma, the same with a decimal point: `"0,5 s"` gives `"0.5 s"`.
pub(crate) fn with_decimal_point(text: &str) -> Option<String> {
    let (whole, rest) = text.split_once(',')?;
    let between_digits =
        whole.ends_with(|c: char| c.is_ascii_digit()) && rest.starts_with(|c: char| c.is_ascii_digit());
    let written = format!("{whole}.{rest}");
    let (_, unit) = split_quantity(&written)?;
    (between_digits && !unit.contains([',', '='])).then_some(written)
}

/// Splits `"-12 dB"` into `(-12.0, "dB")`; `None` if the text does not begin with a finite number.
pub(crate) fn split_quantity(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let end = text
        .char_indices()
        .find(|(index, c)| {
            let exponent_sign = matches!(c, '+' | '-') && text[..*index].ends_with(['e', 'E']);
            let exponent = matches!(c, 'e' | 'E')
                && text[index + 1..].starts_with(|next: char| next.is_ascii_digit() || matches!(next, '+' | '-'));
            !(c.is_ascii_digit() || *c == '.' || exponent || exponent_sign || (*index == 0 && matches!(c, '+' | '-')))
        })
        .map_or(text.len(), |(index, _)| index);
    let value: f64 = text[..end].parse().ok()?;
    value.is_finite().then(|| (value, text[end..].trim()))
}

/// The number of a text such as `"62 cm"`, converted to the unit `own`: `"m"`, `"Hz"`, or an empty one, which also
/// accepts per cent. A number without a unit is taken to be in `own`. `None` if the unit is another one or the text
/// does not begin with a finite number.
pub fn number_in_unit(own: &str, text: &str) -> Option<f64> {
    let (value, unit) = split_quantity(text)?;
    // Divide: 1/100 and 1/1000 are not exact in binary, but 62 / 100 gives the number 0.62.
    match (own, unit) {
        (own, unit) if own == unit || unit.is_empty() => Some(value),
        ("m", "cm") | ("", "%") => Some(value / 100.0),
        ("m", "mm") => Some(value / 1000.0),
        ("Hz", "kHz") => Some(value * 1000.0),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn note_names_go_both_ways() {
        for key in 0..128 {
            assert_eq!(key_from_note_name(&note_name(key)), Some(key));
        }
        for (name, key) in [("C4", Some(60)), ("db4", Some(61)), ("B#3", Some(60)), ("C-1", Some(0)), ("G9", Some(127))]
        {
            assert_eq!(key_from_note_name(name), key, "{name}");
        }
        for name in ["", "C", "H4", "G#9", "Cb-1", "C99999999999", "4C", "C4x"] {
            assert_eq!(key_from_note_name(name), None, "{name}");
        }
    }

    #[test]
    fn keys_are_read_in_every_notation() {
        for (text, key) in [("C#4", 61.0), ("60", 60.0), ("60.5", 60.5), ("440Hz", 69.0), ("0.88 kHz", 81.0)] {
            assert!((parse_key(text, 440.0).unwrap() - key).abs() < 1e-12, "{text}");
        }
        for text in ["200", "-1", "nan", "inf", "", "0Hz", "-5Hz", "C", "1e400", "60 s"] {
            assert!(parse_key(text, 440.0).is_err(), "{text}");
        }
    }

    #[test]
    fn a_number_that_is_no_key_may_have_been_meant_as_a_frequency() {
        assert!(parse_key("440", 440.0).unwrap_err().ends_with("; for 440 Hz, write 440Hz"));
        assert!(parse_key("-1", 440.0).unwrap_err().ends_with("(440Hz)"));
        assert!(parse_key("1e9 Hz", 440.0).unwrap_err().ends_with("(440Hz)"));
        for name in ["C11", "G#9", "B-2"] {
            let message = format!("note ‘{name}’ is out of range: expected C-1 to G9");
            assert_eq!((parse_key(name, 440.0), key_from_note_name(name)), (Err(message), None));
        }
    }

    #[test]
    fn a_decimal_comma_is_told_from_a_list() {
        assert_eq!(with_decimal_point("0,5").as_deref(), Some("0.5"));
        assert_eq!(with_decimal_point("-1,25 dB").as_deref(), Some("-1.25 dB"));
        for text in ["0.5", "1,2,3", "2s,gain=-3", "2,gain=3", "1, 2", ",5", "a,5", "5,", "1.2,3"] {
            assert_eq!(with_decimal_point(text), None, "{text}");
        }
    }

    #[test]
    fn quantities_split_from_their_units() {
        assert_eq!(split_quantity("-12 dB"), Some((-12.0, "dB")));
        assert_eq!(split_quantity("1.5e-3s"), Some((1.5e-3, "s")));
        assert_eq!(split_quantity("+3"), Some((3.0, "")));
        assert_eq!(split_quantity("2e"), Some((2.0, "e")));
        assert_eq!(split_quantity("dB"), None);
        assert_eq!(split_quantity("é"), None);
    }

    #[test]
    fn unity_is_exact() {
        assert_eq!(gain_from_db(0.0), 1.0);
        assert_eq!(ratio_from_semitones(0.0), 1.0);
        assert_eq!(frequency_from_key(69.0, 440.0), 440.0);
    }
}
