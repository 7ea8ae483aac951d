//! Parses option values: ranges, units and pairs.
//!
//! Every error is a message that says what would be right.

#[cfg(feature = "batch")]
use crate::io::FileFormat;
use crate::io::{SampleFormat, SongTime};
use crate::params::learned::check_controller;
use crate::params::{PARAMS, Param};
use crate::render::{Level, SAMPLE_RATES, Tail};
use crate::units::{split_quantity, with_decimal_point};
use std::ops::RangeInclusive;

/// Maximum length of notes and tails, in seconds.
pub(crate) const LONGEST: f64 = 86_400.0;

fn in_range(value: f64, range: RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    if range.contains(&value) {
        Ok(value)
    } else {
        Err(format!("{value} is out of range: expected {} to {}{unit}", range.start(), range.end()))
    }
}

/// Parses a number with one of the units. The unit may be missing if `""` is one of them.
fn quantity(text: &str, units: &[(&str, f64)], expected: &str) -> Result<f64, String> {
    let quantity = split_quantity(text).and_then(|(value, suffix)| {
        let scale = units.iter().find(|(name, _)| name.eq_ignore_ascii_case(suffix));
        scale.map(|(_, scale)| value * scale)
    });
    quantity.ok_or_else(|| match with_decimal_point(text) {
        Some(written) => format!("‘{text}’ is not a number: expected {written}, with a decimal point"),
        None => format!("‘{text}’ is not a number: expected {expected}"),
    })
}

/// Parses a quantity and checks its range.
fn number(text: &str, units: &[(&str, f64)], range: RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    let value = quantity(text, units, &format!("{} to {}{unit}", range.start(), range.end()))?;
    in_range(value, range, unit)
}

const HERTZ: [(&str, f64); 4] = [("", 1.0), ("Hz", 1.0), ("k", 1e3), ("kHz", 1e3)];

/// Parses a frequency or rate in Hz, of any size: `440`, `44.1k`, `48 kHz`.
///
/// # Errors
/// A message that says what would be right.
pub fn hertz(text: &str) -> Result<f64, String> {
    quantity(text, &HERTZ, "Hz, as in 440 or 44.1k")
}

/// Returns a parser of whole numbers in a range.
pub fn whole<T: TryFrom<u64>>(range: RangeInclusive<u64>) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |text| {
        let expected = format!("expected {} to {}", range.start(), range.end());
        let value = text.trim().parse::<i128>().map_err(|_| format!("‘{text}’ is not a whole number: {expected}"))?;
        let value = u64::try_from(value).ok().filter(|value| range.contains(value));
        value.and_then(|value| T::try_from(value).ok()).ok_or_else(|| format!("{text} is out of range: {expected}"))
    }
}

/// Parses a sample rate in Hz: `48000`, `44100Hz`, `44.1k`, `48 kHz`.
///
/// # Errors
/// A message that says what would be right.
pub fn rate(text: &str) -> Result<u32, String> {
    let (low, high) = SAMPLE_RATES.into_inner();
    let rate = number(text, &HERTZ, f64::from(low)..=f64::from(high), " Hz")?;
    let whole = rate.round();
    // 1e-6 Hz allow for the rounding of decimal fractions of a kHz in binary.
    if (rate - whole).abs() < 1e-6 {
        Ok(whole as u32)
    } else {
        Err(format!("‘{text}’ is not a whole number of Hz"))
    }
}

/// Parses a time in seconds, 0 to 86,400: `2`, `250 ms`.
///
/// # Errors
/// A message that says what would be right.
pub fn seconds(text: &str) -> Result<f64, String> {
    number(text, &[("", 1.0), ("s", 1.0), ("ms", 1e-3)], 0.0..=LONGEST, " s")
}

/// Smallest and largest factor of a song’s tempo: beyond, notes are clicks or do not end.
pub(super) const TEMPOS: (f64, f64) = (0.1, 10.0);

/// Parses a factor of a song’s tempo, 0.1 to 10.
///
/// # Errors
/// A message that says what would be right.
pub fn tempo(text: &str) -> Result<f64, String> {
    number(text, &[("", 1.0), ("x", 1.0)], TEMPOS.0..=TEMPOS.1, "")
}

/// Most semitones by which a song is moved: five octaves.
pub(super) const MOST_SEMITONES: f64 = 60.0;

/// Parses the semitones by which a song is moved, −60 to 60.
///
/// # Errors
/// A message that says what would be right.
pub fn transpose(text: &str) -> Result<i32, String> {
    let semitones = number(text, &[("", 1.0)], -MOST_SEMITONES..=MOST_SEMITONES, " semitones")?;
    let is_whole = semitones == semitones.round();
    if is_whole { Ok(semitones as i32) } else { Err(format!("‘{text}’: expected whole semitones, -60 to 60")) }
}

/// Parses a tail: `auto`, `none` or seconds.
///
/// # Errors
/// A message that says what would be right.
pub fn tail(text: &str) -> Result<Tail, String> {
    match text {
        "auto" => Ok(Tail::Auto),
        "none" => Ok(Tail::None),
        _ if with_decimal_point(text).is_some() => seconds(text).map(Tail::Seconds),
        _ => seconds(text).map(Tail::Seconds).map_err(|error| format!("{error}, auto or none")),
    }
}

/// Parses a gain in dB, −120 to 120: `-3`, `-3 dB`.
///
/// # Errors
/// A message that says what would be right.
pub fn gain_db(text: &str) -> Result<f64, String> {
    number(text, &[("", 1.0), ("dB", 1.0)], -120.0..=120.0, " dB")
}

/// Parses a tolerance in dBFS, −300 to 0.
///
/// # Errors
/// A message that says what would be right.
pub fn tolerance_db(text: &str) -> Result<f64, String> {
    number(text, &[("", 1.0), ("dB", 1.0), ("dBFS", 1.0)], -300.0..=0.0, " dBFS")
}

/// Parses a level to normalise to: `peak=DBFS` or `lufs=LUFS`.
///
/// # Errors
/// A message that says what would be right.
pub fn level(text: &str) -> Result<Level, String> {
    match text.split_once('=') {
        Some(("peak", value)) => {
            number(value, &[("", 1.0), ("dB", 1.0), ("dBFS", 1.0)], -120.0..=0.0, " dBFS").map(Level::Peak)
        }
        Some(("lufs", value)) => number(value, &[("", 1.0), ("LUFS", 1.0)], -70.0..=0.0, " LUFS").map(Level::Loudness),
        _ => {
            let expected = "expected peak=DBFS or lufs=LUFS";
            Err(match split_quantity(text) {
                Some((value, unit)) if unit.eq_ignore_ascii_case("lufs") => format!("{expected}, as in lufs={value}"),
                Some((value, _)) => format!("{expected}, as in peak={value}"),
                None => expected.to_owned(),
            })
        }
    }
}

/// Parses a sample format: `16`, `24` or `32f`.
///
/// # Errors
/// A message that says what would be right.
pub fn bits(text: &str) -> Result<SampleFormat, String> {
    match text {
        "16" => Ok(SampleFormat::Int16),
        "24" => Ok(SampleFormat::Int24),
        "32f" => Ok(SampleFormat::Float32),
        _ => Err("expected 16, 24 or 32f".to_owned()),
    }
}

/// Parses a format of sound files: `wav` or `flac`.
///
/// # Errors
/// A message that says what would be right.
#[cfg(feature = "batch")]
pub fn file_format(text: &str) -> Result<FileFormat, String> {
    match text {
        "wav" => Ok(FileFormat::Wav),
        "flac" => Ok(FileFormat::Flac),
        _ => Err("expected wav or flac".to_owned()),
    }
}

/// Parses a time in a song: seconds, or a bar with or without a beat, as in `bar 9` and `bar9.3`.
///
/// # Errors
/// A message that says what would be right.
pub fn song_time(text: &str) -> Result<SongTime, String> {
    let trimmed = text.trim();
    let Some((_, place)) = trimmed.split_at_checked(3).filter(|(word, _)| word.eq_ignore_ascii_case("bar")) else {
        return seconds(text).map(SongTime::Seconds).map_err(|message| format!("{message}, or a bar (bar 9)"));
    };
    let wrong = || format!("‘{text}’ is no bar: expected bar 9, or bar 9.3 for its third beat");
    let (bar, beat) = place.trim().split_once('.').unwrap_or((place.trim(), "1"));
    let bar = bar.parse().ok().filter(|bar| *bar > 0).ok_or_else(wrong)?;
    let beat = beat.parse().ok().filter(|beat: &u16| *beat > 0).ok_or_else(wrong)?;
    Ok(SongTime::Bar { bar, beat: beat.into() })
}

/// Checks the form of a note for `--note`. Which key a frequency is depends on the patch, so the note stays a text
/// here.
///
/// # Errors
/// A message that says what would be right.
pub fn note(text: &str) -> Result<String, String> {
    crate::units::parse_key(text, f64::from(Param::Tuning.info().default)).map(|_| text.to_owned())
}

/// Parses `channel=name`: a channel from 1 to 16, returned from 0, and the name of a preset or kit.
///
/// # Errors
/// A message that says what would be right.
pub fn channel(text: &str) -> Result<(u8, String), String> {
    let expected = "expected CHANNEL=NAME, as in 10=drums.toml";
    let (channel, name) = text.split_once('=').filter(|(_, name)| !name.trim().is_empty()).ok_or(expected)?;
    let number: u8 = whole(1..=16)(channel).map_err(|message| format!("channel {message}"))?;
    Ok((number - 1, name.to_owned()))
}

/// Parses `id=value`, with the value in the form that the parameter table defines.
///
/// # Errors
/// A message that says what would be right.
pub fn setting(text: &str) -> Result<(Param, f32), String> {
    let (id, value) = text.split_once('=').ok_or("expected ID=VALUE, as in decay=0.5")?;
    let (id, param) = (id.trim(), parameter(id)?);
    if let Some((first, rest)) = value.split_once(',')
        && rest.contains('=')
    {
        return Err(format!("expected one parameter, as in --set {id}={first} --set {rest}"));
    }
    let value = param.info().parse(value).map_err(|message| format!("{id}: {message}"))?;
    Ok((param, value))
}

/// Parses a parameter's id.
///
/// # Errors
/// A message that says what would be right.
pub fn parameter(text: &str) -> Result<Param, String> {
    let id = text.trim();
    Param::from_id(id).ok_or_else(|| no_parameter(id))
}

/// Parses `id=controller`: a parameter and the MIDI controller that is to move it.
///
/// # Errors
/// A message that says what would be right.
pub fn learning(text: &str) -> Result<(Param, u8), String> {
    let (id, controller) = text.split_once('=').ok_or("expected ID=CONTROLLER, as in decay=21")?;
    let param = parameter(id)?;
    let controller = whole(0..=127)(controller).map_err(|message| format!("controller {message}"))?;
    check_controller(controller)?;
    Ok((param, controller))
}

fn no_parameter(id: &str) -> String {
    // The user may have typed the parameter's displayed name.
    let named = PARAMS.iter().find(|info| info.name.eq_ignore_ascii_case(id)).map(|info| format!("‘{}’", info.id));
    match named.or_else(|| crate::error::nearest(id, PARAMS.iter().map(|info| info.id))) {
        Some(near) => format!("there is no parameter ‘{id}’; the nearest is {near}"),
        None => format!("there is no parameter ‘{id}’; ‘sprung params’ shows them all"),
    }
}

/// The number with its shortest decimal digits: 0.3, not 0.30000001192092896, which is the `f32` converted directly.
/// Allocates.
pub fn decimal(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(value.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_are_read_with_and_without_units() {
        for (text, expected) in [
            ("44.1k", 44_100),
            ("48kHz", 48_000),
            ("44100Hz", 44_100),
            ("22.05 khz", 22_050),
            ("88200", 88_200),
            ("11.025K", 11_025),
            ("768k", 768_000),
        ] {
            assert_eq!(rate(text), Ok(expected), "{text}");
        }
        assert_eq!(whole::<u8>(1..=127)("127"), Ok(127));
        assert_eq!(whole::<u64>(0..=u64::MAX)("18446744073709551615"), Ok(u64::MAX));
        assert_eq!(seconds("2"), Ok(2.0));
        assert_eq!(seconds("250 ms"), Ok(0.25));
        assert_eq!(tail("auto"), Ok(Tail::Auto));
        assert_eq!(tail("1.5s"), Ok(Tail::Seconds(1.5)));
        assert_eq!(gain_db("-3 dB"), Ok(-3.0));
        assert_eq!(level("peak=-1"), Ok(Level::Peak(-1.0)));
        assert_eq!(level("lufs=-14 LUFS"), Ok(Level::Loudness(-14.0)));
        assert_eq!(setting("mallet_pulse=contact"), Ok((Param::MalletPulse, 1.0)));
        assert_eq!(setting("decay = 250 ms"), Ok((Param::Decay, 0.25)));
        for (text, bar, beat) in [("bar 9", 9, 1.0), ("bar9.3", 9, 3.0), ("Bar 12.10", 12, 10.0)] {
            assert_eq!(song_time(text), Ok(SongTime::Bar { bar, beat }));
        }
        assert_eq!(song_time("90 s"), Ok(SongTime::Seconds(90.0)));
        assert_eq!(channel("10=a=b.toml"), Ok((9, "a=b.toml".to_owned())));
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
            (rate("44,1k").err(), "‘44,1k’ is not a number: expected 44.1k, with a decimal point"),
            (rate("44.1234567k").err(), "‘44.1234567k’ is not a whole number of Hz"),
            (rate("999").err(), "999 is out of range: expected 1000 to 768000 Hz"),
            (rate("769k").err(), "769000 is out of range: expected 1000 to 768000 Hz"),
            (rate("CD").err(), "‘CD’ is not a number: expected 1000 to 768000 Hz"),
            (rate("-1").err(), "-1 is out of range: expected 1000 to 768000 Hz"),
            (hertz("A4").err(), "‘A4’ is not a number: expected Hz, as in 440 or 44.1k"),
            (whole::<u64>(0..=9)("abc").err(), "‘abc’ is not a whole number: expected 0 to 9"),
            (whole::<u64>(0..=9)("0.5").err(), "‘0.5’ is not a whole number: expected 0 to 9"),
            (whole::<u64>(0..=9)("-1").err(), "-1 is out of range: expected 0 to 9"),
            (whole::<u64>(0..=9)("10").err(), "10 is out of range: expected 0 to 9"),
            (seconds("0,5").err(), "‘0,5’ is not a number: expected 0.5, with a decimal point"),
            (tail("2,5 s").err(), "‘2,5 s’ is not a number: expected 2.5 s, with a decimal point"),
            (level("-1").err(), "expected peak=DBFS or lufs=LUFS, as in peak=-1"),
            (level("-14 LUFS").err(), "expected peak=DBFS or lufs=LUFS, as in lufs=-14"),
            (level("peak").err(), "expected peak=DBFS or lufs=LUFS"),
            (setting("decay=0,5").err(), "decay: ‘0,5’ is not a number in s: expected 0.5, with a decimal point"),
            (setting("decay=2s,gain=-3").err(), "expected one parameter, as in --set decay=2s --set gain=-3"),
            (setting("brightness=3").err(), "there is no parameter ‘brightness’; the nearest is ‘tilt’"),
            (setting("gain").err(), "expected ID=VALUE, as in decay=0.5"),
            (channel("drums.toml").err(), "expected CHANNEL=NAME, as in 10=drums.toml"),
            (channel("10=").err(), "expected CHANNEL=NAME, as in 10=drums.toml"),
            (channel("0=Kick").err(), "channel 0 is out of range: expected 1 to 16"),
            (channel("17=Kick").err(), "channel 17 is out of range: expected 1 to 16"),
            (channel("x=Kick").err(), "channel ‘x’ is not a whole number: expected 1 to 16"),
            (song_time("bar 0").err(), "‘bar 0’ is no bar: expected bar 9, or bar 9.3 for its third beat"),
            (song_time("bar").err(), "‘bar’ is no bar: expected bar 9, or bar 9.3 for its third beat"),
            (song_time("9b").err(), "‘9b’ is not a number: expected 0 to 86400 s, or a bar (bar 9)"),
            (setting("deacy=1").err(), "there is no parameter ‘deacy’; the nearest is ‘decay’"),
            (setting("gain=99").err(), "gain: 99 is out of range: expected from -60 dB to 12 dB"),
        ]
        .map(|(error, expected)| (error.unwrap_or_default(), expected))
        {
            assert_eq!(result, expected);
        }
    }
}
