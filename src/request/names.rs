//! The options of a request by name, with values as text.

use super::quantity;
use super::render::Request;
use crate::render::SAMPLE_RATES;

/// The numbers that an option accepts.
#[derive(Clone, Copy)]
pub struct Number {
    /// Parses a number, with or without its unit.
    pub(crate) parse: fn(&str) -> Result<f64, String>,
    /// Smallest value.
    pub(crate) min: f64,
    /// Largest value.
    pub(crate) max: f64,
    /// Whether only whole numbers are accepted.
    pub(crate) is_whole: bool,
}

/// An option of a [`Request`].
pub struct Name {
    /// Its name in batches and in Python. The command writes `-` for `_`.
    pub name: &'static str,
    set: fn(&mut Request, &str) -> Result<(), String>,
    /// The numbers that it accepts; none if it takes no number.
    pub(crate) number: Option<Number>,
}

impl Name {
    /// The option of this name.
    pub(crate) fn find(name: &str) -> Option<&'static Self> {
        NAMES.iter().find(|known| known.name == name)
    }
}

impl Request {
    /// The options.
    pub const NAMES: &[Name] = NAMES;

    /// Sets an option from text. For options that the command can repeat, the value is added.
    ///
    /// # Errors
    /// A message that says what would be right.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), String> {
        match Name::find(name) {
            Some(known) => (known.set)(self, value),
            None => Err(match crate::error::nearest(name, NAMES.iter().map(|known| known.name)) {
                Some(near) => format!("there is no option ‘{name}’; the nearest is {near}"),
                None => format!("there is no option ‘{name}’"),
            }),
        }
    }
}

const fn plain(name: &'static str, set: fn(&mut Request, &str) -> Result<(), String>) -> Name {
    Name { name, set, number: None }
}

const fn number(
    name: &'static str,
    set: fn(&mut Request, &str) -> Result<(), String>,
    parse: fn(&str) -> Result<f64, String>,
    range: (f64, f64),
    is_whole: bool,
) -> Name {
    Name { name, set, number: Some(Number { parse, min: range.0, max: range.1, is_whole }) }
}

const NAMES: &[Name] = &[
    plain("song", |request, value| put(&mut request.song, Ok(Some(value.into())))),
    number(
        "note",
        |request, value| {
            for note in value.split(',') {
                request.note.push(quantity::note(note)?);
            }
            Ok(())
        },
        |text| text.trim().parse().map_err(|_| format!("‘{text}’ is not a key: expected 0 to 127")),
        (0.0, 127.0),
        false,
    ),
    plain("input", |request, value| put(&mut request.input, Ok(Some(value.into())))),
    number(
        "velocity",
        |request, value| put(&mut request.velocity, velocity(value)),
        whole_velocity,
        (1.0, 127.0),
        true,
    ),
    number(
        "length",
        |request, value| put(&mut request.length, quantity::seconds(value)),
        quantity::seconds,
        (0.0, quantity::LONGEST),
        false,
    ),
    plain("lenient", |request, value| put(&mut request.reading.lenient, yes(value))),
    number(
        "tempo",
        |request, value| put(&mut request.reading.tempo, quantity::tempo(value)),
        quantity::tempo,
        quantity::TEMPOS,
        false,
    ),
    number(
        "transpose",
        |request, value| put(&mut request.reading.transpose, quantity::transpose(value)),
        |text| quantity::transpose(text).map(f64::from),
        (-quantity::MOST_SEMITONES, quantity::MOST_SEMITONES),
        true,
    ),
    plain("solo", |request, value| channels(&mut request.reading.solo, value)),
    plain("mute", |request, value| channels(&mut request.reading.mute, value)),
    plain("from", |request, value| put(&mut request.reading.from, quantity::song_time(value).map(Some))),
    plain("to", |request, value| put(&mut request.reading.to, quantity::song_time(value).map(Some))),
    plain("pattern", |request, value| {
        put(&mut request.reading.pattern, quantity::whole(1..=u16::MAX.into())(value).map(Some))
    }),
    plain("preset", |request, value| put(&mut request.sound.preset, Ok(Some(value.into())))),
    plain("channel", |request, value| add(&mut request.sound.channels, quantity::channel(value))),
    plain("programs", |request, value| put(&mut request.sound.programs, Ok(value.into()))),
    plain("set", |request, value| add(&mut request.sound.set, quantity::setting(value))),
    number(
        "mix_gain_db",
        |request, value| put(&mut request.sound.mix_gain_db, quantity::gain_db(value)),
        quantity::gain_db,
        (-120.0, 120.0),
        false,
    ),
    plain("scale", |request, value| put(&mut request.sound.tuning.scale, Ok(Some(value.into())))),
    plain("keymap", |request, value| put(&mut request.sound.tuning.keymap, Ok(Some(value.into())))),
    plain("seed", |request, value| put(&mut request.seed, quantity::whole(0..=u64::MAX)(value))),
    number(
        "rate",
        |request, value| put(&mut request.rate, quantity::rate(value)),
        |text| quantity::rate(text).map(f64::from),
        (*SAMPLE_RATES.start() as f64, *SAMPLE_RATES.end() as f64),
        true,
    ),
    plain("bits", |request, value| put(&mut request.bits, quantity::bits(value))),
    plain("dither", |request, value| put(&mut request.dither, yes(value))),
    plain("mono", |request, value| put(&mut request.mono, yes(value))),
    number(
        "tail",
        |request, value| put(&mut request.tail, quantity::tail(value)),
        quantity::seconds,
        (0.0, quantity::LONGEST),
        false,
    ),
    plain("normalize", |request, value| put(&mut request.normalize, quantity::level(value).map(Some))),
    number(
        "gain_db",
        |request, value| put(&mut request.gain_db, quantity::gain_db(value)),
        quantity::gain_db,
        (-120.0, 120.0),
        false,
    ),
];

fn put<T>(place: &mut T, value: Result<T, String>) -> Result<(), String> {
    value.map(|value| *place = value)
}

fn add<T>(list: &mut Vec<T>, value: Result<T, String>) -> Result<(), String> {
    value.map(|value| list.push(value))
}

/// Adds channels that are separated by commas.
fn channels(list: &mut Vec<u8>, text: &str) -> Result<(), String> {
    text.split(',').try_for_each(|channel| add(list, quantity::whole(1..=16)(channel)))
}

fn velocity(text: &str) -> Result<u8, String> {
    quantity::whole(1..=127)(text)
}

fn whole_velocity(text: &str) -> Result<f64, String> {
    velocity(text).map(f64::from)
}

fn yes(text: &str) -> Result<bool, String> {
    text.trim().parse().map_err(|_| format!("‘{text}’ is neither true nor false"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::params::Param;

    #[test]
    fn options_are_set_by_name() {
        let mut request = Request::default();
        for (name, value) in [
            ("note", "C4,60.5"),
            ("note", "440Hz"),
            ("velocity", "64"),
            ("length", "250 ms"),
            ("set", "decay=2 s"),
            ("channel", "10=drums.toml"),
            ("mono", "true"),
        ] {
            request.set(name, value).unwrap();
        }
        assert_eq!(request.note, ["C4", "60.5", "440Hz"]);
        assert_eq!((request.velocity, request.length, request.mono), (64, 0.25, true));
        assert_eq!(request.sound.set, [(Param::Decay, 2.0)]);
        assert_eq!(request.sound.channels, [(9, "drums.toml".to_owned())]);
    }

    #[test]
    fn wrong_names_and_values_say_what_would_be_right() {
        for (name, value, expected) in [
            ("velocty", "1", "there is no option ‘velocty’; the nearest is ‘velocity’"),
            ("velocity", "0", "0 is out of range: expected 1 to 127"),
            ("mono", "yes", "‘yes’ is neither true nor false"),
            ("set", "deacy=1", "there is no parameter ‘deacy’; the nearest is ‘decay’"),
        ] {
            assert_eq!(Request::default().set(name, value).unwrap_err(), expected);
        }
    }
}
