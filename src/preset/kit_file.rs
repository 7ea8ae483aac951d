//! Reads and writes the TOML of a kit file, key by key, so that every error names its place and what would be right.

use super::about::{About, about_to_toml, label, toml_string};
use super::complaints::Complaints;
use super::file::{self, write_value};
use super::kit::{KIT_VERSION, KitPreset, Playable};
use super::value::{check_keys, param_value, read_params, table, unexpected};
use super::{MAX_FILE_SIZE, Preset};
use crate::error::Error;
use crate::params::Param;
use crate::sound::Pad;
use crate::sound::kit::{OUTPUTS, PITCHES};
use crate::units::{key_from_note_name, note_name, parse_key};
use std::collections::BTreeMap;
use std::fmt::Write;
use toml::{Table, Value};

const KEYS: [&str; 10] = ["kit", "name", "author", "tags", "comment", "details", "voices", "params", "keys", "sounds"];
const PAD_KEYS: [&str; 8] = ["key", "name", "sound", "pitch", "gain", "pan", "choke", "output"];

/// Finds the preset with the name that a kit uses.
type Find<'a> = &'a mut dyn FnMut(&str) -> crate::Result<Preset>;

/// Reads as much of a preset or kit as possible. Returns an error only if the text is neither.
pub(super) fn parse(text: &str, origin: &str, find: Find, complaints: &mut Complaints) -> crate::Result<Playable> {
    if text.len() as u64 > MAX_FILE_SIZE {
        return Err(Error::format(origin, "too large for a kit: expected at most 16 MiB of TOML"));
    }
    let table = table(text, origin)?;
    let read = match table.get("kit") {
        None if table.contains_key("keys") => Err(format!("there is no ‘kit’: expected kit = {KIT_VERSION}")),
        None => file::read(&table, complaints).map(Playable::Preset),
        Some(version) => read(&table, version, find, complaints).map(Playable::Kit),
    };
    read.map_err(|message| Error::format(origin, message))
}

fn read(table: &Table, version: &Value, find: Find, complaints: &mut Complaints) -> Result<KitPreset, String> {
    match version {
        Value::Integer(KIT_VERSION) => {}
        Value::Integer(newer) if *newer > KIT_VERSION => {
            complaints.add(format!("kit {newer} is of a newer version: this one reads kit = {KIT_VERSION}"));
        }
        other => return Err(format!("kit {other} is unknown: this version reads kit = {KIT_VERSION}")),
    }
    check_keys(table, "", &KEYS, complaints);
    let About { name, author, tags, comment, details } = About::read(table, complaints);
    let voices = number(table, "voices", Param::Voices, "", complaints).unwrap_or(Param::Voices.info().max);
    let mut kit = KitPreset {
        name,
        author,
        tags,
        comment,
        details,
        voices: voices as u8,
        params: read_params("params", table.get("params"), Param::is_behind_voices, complaints),
        sounds: vec![],
        pads: vec![],
    };
    let pads = match table.get("keys") {
        Some(Value::Array(pads)) if !pads.is_empty() => &pads[..],
        Some(Value::Array(_)) | None => {
            complaints.add("there are no ‘keys’: expected [[keys]] with key and sound");
            &[]
        }
        Some(other) => {
            complaints.add(unexpected("keys", "a list of tables, [[keys]]", other));
            &[]
        }
    };
    let own = read_sounds(table.get("sounds"), complaints);
    let mut find = |name: &str| own.get(name).cloned().map_or_else(|| find(name), Ok);
    for (index, pad) in pads.iter().enumerate() {
        let place = format!("keys[{index}]");
        match pad {
            Value::Table(pad) => read_pad(&place, pad, &mut kit, &mut find, complaints),
            other => complaints.add(unexpected(&place, "a table, [[keys]]", other)),
        }
    }
    for name in own.keys().filter(|name| !kit.sounds.iter().any(|(used, _)| used == *name)) {
        complaints.add(format!("sounds.{name}: no key plays it: expected a key with sound = {}", toml_string(name)));
    }
    Ok(kit)
}

/// Reads the presets that are in the kit's file itself, by name.
fn read_sounds(value: Option<&Value>, complaints: &mut Complaints) -> BTreeMap<String, Preset> {
    let mut sounds = BTreeMap::new();
    let tables = match value {
        Some(Value::Table(tables)) => tables,
        Some(other) => {
            complaints.add(unexpected("sounds", "presets by name, [sounds.NAME]", other));
            return sounds;
        }
        None => return sounds,
    };
    for (name, value) in tables {
        let mut own = Complaints::default();
        let read = match value {
            Value::Table(table) => file::read(table, &mut own),
            other => Err(format!("expected a preset, found {}", other.type_str())),
        };
        let place = format!("sounds.{name}: ");
        own.into_lines().into_iter().for_each(|line| complaints.add(format!("{place}{line}")));
        if let Some(preset) = complaints.take(&place, read) {
            sounds.insert(name.clone(), preset);
        }
    }
    sounds
}

/// Reads a pad and adds it to the kit, if it has a key and a sound.
fn read_pad(place: &str, table: &Table, kit: &mut KitPreset, find: Find, complaints: &mut Complaints) {
    let dotted = format!("{place}.");
    check_keys(table, &dotted, &PAD_KEYS, complaints);
    let key = complaints.take(&format!("{dotted}key: "), read_key(table.get("key")));
    let key = key.filter(|key| {
        let is_taken = kit.pads.iter().any(|(taken, _)| taken == key);
        if is_taken {
            let name = note_name(*key);
            complaints.add(format!("{dotted}key: {name} ({key}) has a pad already: expected another key"));
        }
        !is_taken
    });
    let sound = complaints.take("", read_sound(place, table, kit, find));
    let a4_hz = sound.map_or(440.0, |sound| f64::from(kit.sounds[sound].1.patch.get(Param::Tuning)));
    let pitch = table.get("pitch").map(|value| read_pitch(value, a4_hz)).transpose();
    let pad = Pad {
        name: label(table, "name", &dotted, complaints),
        sound: sound.unwrap_or(0),
        pitch: complaints.take(&format!("{dotted}pitch: "), pitch).flatten(),
        gain_db: number(table, "gain", Param::Gain, &dotted, complaints).unwrap_or(0.0),
        pan: complaints.take(&format!("{dotted}pan: "), read_pan(table.get("pan"))).unwrap_or(0.0),
        choke: number(table, "choke", Param::Choke, &dotted, complaints).map(|choke| choke as u8),
        output: complaints.take(&format!("{dotted}output: "), read_output(table.get("output"))).unwrap_or(0),
    };
    if let (Some(key), Some(_)) = (key, sound) {
        kit.pads.push((key, pad));
    }
}

/// Reads the output of a pad, 0 for the main one.
fn read_output(value: Option<&Value>) -> Result<u8, String> {
    match value {
        None => Ok(0),
        Some(Value::String(name)) if name == "main" => Ok(0),
        Some(Value::Integer(number)) if (1..=OUTPUTS as i64).contains(number) => Ok(*number as u8),
        Some(other) => Err(format!("{other} is none: expected \"main\" or a whole number from 1 to {OUTPUTS}")),
    }
}

/// Reads a number within the range of a parameter, if the key exists.
fn number(table: &Table, key: &str, param: Param, place: &str, complaints: &mut Complaints) -> Option<f32> {
    let value = table.get(key).map(|value| param_value(param.info(), value)).transpose();
    complaints.take(&format!("{place}{key}: "), value).flatten()
}

/// Reads a pad's sound and returns its index in the kit. A preset that is not in the kit yet is found and added.
fn read_sound(place: &str, table: &Table, kit: &mut KitPreset, find: Find) -> Result<usize, String> {
    let name = match table.get("sound") {
        Some(Value::String(name)) => name,
        Some(other) => return Err(unexpected(&format!("{place}.sound"), "a factory preset or a preset file", other)),
        None => return Err(format!("{place}: there is no ‘sound’: expected a factory preset or a preset file")),
    };
    if let Some(known) = kit.sounds.iter().position(|(known, _)| known == name) {
        return Ok(known);
    }
    let preset = find(name).map_err(|error| format!("{place}.sound: {error}"))?;
    kit.sounds.push((name.clone(), preset));
    Ok(kit.sounds.len() - 1)
}

/// Reads a key: a note name or a number, as in the command line.
fn read_key(value: Option<&Value>) -> Result<u8, String> {
    let expected = "expected a note name (\"C2\") or a key from 0 to 127 (36)";
    let key = match value {
        Some(Value::String(text)) => key_from_note_name(text).or_else(|| text.trim().parse().ok()),
        Some(Value::Integer(key)) => u8::try_from(*key).ok(),
        Some(_) => None,
        None => return Err(format!("there is none: {expected}")),
    };
    let found = || value.map_or(String::new(), |value| value.to_string().trim().to_owned());
    key.filter(|key| *key < 128).ok_or_else(|| format!("‘{}’ is no key: {expected}", found()))
}

/// Reads a pitch: a key, a pitch between two keys, or a frequency, as in the command line.
fn read_pitch(value: &Value, a4_hz: f64) -> Result<f64, String> {
    match value {
        Value::String(text) => parse_key(text, a4_hz),
        // Such are written of frequencies that no key has.
        Value::Float(pitch) if PITCHES.contains(pitch) => Ok(*pitch),
        Value::Integer(_) | Value::Float(_) => parse_key(&value.to_string(), a4_hz),
        other => Err(format!("expected a note name, a key or a frequency, found {}", other.type_str())),
    }
}

fn read_pan(value: Option<&Value>) -> Result<f32, String> {
    let pan = match value {
        None => return Ok(0.0),
        Some(Value::Integer(number)) => *number as f32,
        Some(Value::Float(number)) => *number as f32,
        Some(other) => return Err(format!("expected a number from -1 to 1, found {}", other.type_str())),
    };
    if (-1.0..=1.0).contains(&pan) { Ok(pan) } else { Err(format!("{pan} is out of range: expected -1 to 1")) }
}

/// Writes a kit, with the presets in it that `has` says. `{:?}` writes a float as the shortest text that reads back as the same
/// number, and that is valid TOML.
pub(super) fn to_toml(kit: &KitPreset, has: &dyn Fn(&str, &Preset) -> bool) -> String {
    let KitPreset { name, author, tags, comment, details, voices, params, sounds, pads } = kit;
    let mut out = format!("kit = {KIT_VERSION}\n{}", about_to_toml([name, author, comment, details], tags));
    if f32::from(*voices) != Param::Voices.info().max {
        let _ = writeln!(out, "voices = {voices}");
    }
    if !params.is_empty() {
        out.push_str("\n[params]\n");
        params.iter().for_each(|(param, value)| write_value(&mut out, param.info(), *value));
    }
    for (key, pad) in pads {
        let Some((sound, _)) = sounds.get(pad.sound) else { continue };
        let _ = writeln!(out, "\n[[keys]]\nkey = \"{}\"", note_name(*key));
        if !pad.name.is_empty() {
            let _ = writeln!(out, "name = {}", toml_string(&pad.name));
        }
        let _ = writeln!(out, "sound = {}", toml_string(sound));
        let named = |pitch: f64| (0..128).find(|key| f64::from(*key) == pitch).map(note_name);
        match pad.pitch.map(|pitch| (pitch, named(pitch))) {
            Some((_, Some(name))) => drop(writeln!(out, "pitch = \"{name}\"")),
            Some((pitch, None)) => drop(writeln!(out, "pitch = {pitch:?}")),
            None => {}
        }
        for (name, value) in [("gain", pad.gain_db), ("pan", pad.pan)] {
            if value != 0.0 {
                let _ = writeln!(out, "{name} = {value:?}");
            }
        }
        if let Some(choke) = pad.choke {
            let _ = writeln!(out, "choke = {choke}");
        }
        if pad.output != 0 {
            let _ = writeln!(out, "output = {}", pad.output);
        }
    }
    for (name, preset) in sounds.iter().filter(|(name, preset)| has(name, preset)) {
        // A table of two levels, so that every line of it has its whole path.
        let preset = preset.to_toml().parse().map(Value::Table);
        let preset = preset.expect("what a preset writes can be read");
        let sounds = Table::from_iter([(name.clone(), preset)]);
        let whole = Table::from_iter([("sounds".to_owned(), Value::Table(sounds))]);
        let _ = write!(out, "\n{whole}");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> crate::Result<Playable> {
        Playable::parse(text, "x", &mut |name| Preset::find(name).cloned())
    }

    #[test]
    fn a_kit_is_read_in_every_notation_and_written_back() {
        let text = "kit = 1\nname = \"k\"\nauthor = \"a\"\ntags = [\"t\"]\ncomment = \"c\\n\"\ndetails = \"d\"\nvoices = 7\n\
                    keys = [{ key = \"C2\", sound = \"Kick\" }, { key = 38, output = \"main\", sound = \"snare\", pitch = \"60.5\", gain = \"-3 dB\" },\
                    { key = \"39\", sound = \"Kick\", pitch = \"F#3\", pan = -0.3, choke = 0, name = \"K\" },\
                    { key = \"G9\", sound = \"Clap\", pitch = 41, gain = 2, choke = 16, output = 16 },\
                    { key = 0, sound = \"Kick\", pitch = -0.6 }]";
        let Ok(Playable::Kit(kit)) = parse(text) else { panic!("{:?}", parse(text)) };
        let pad = |sound| Pad::of(sound);
        assert_eq!(
            kit.pads,
            [
                (36, pad(0)),
                (38, Pad { pitch: Some(60.5), gain_db: -3.0, ..pad(1) }),
                (39, Pad { name: "K".to_owned(), pitch: Some(54.0), pan: -0.3, choke: Some(0), ..pad(0) }),
                (127, Pad { pitch: Some(41.0), gain_db: 2.0, choke: Some(16), output: 16, ..pad(2) }),
                (0, Pad { pitch: Some(-0.6), ..pad(0) }),
            ]
        );
        assert_eq!((kit.voices, kit.sounds.len()), (7, 3));
        assert_eq!(parse(&kit.to_toml()).unwrap(), Playable::Kit(kit.clone()));
        let playing = kit.kit();
        assert_eq!((playing.name(), playing.sounds().len(), playing.pad(37)), ("k", 3, None));
        assert_eq!(playing.pad(127), Some(&kit.pads[3].1));
    }

    #[test]
    fn presets_in_a_kit_come_before_others_and_are_written_back() {
        let kick = Preset::find("Kick").unwrap();
        let mut own = kick.clone();
        own.patch.set(Param::Decay, 0.123_456_79);
        let sounds =
            vec![("Kick".to_owned(), own.clone()), ("Snare".to_owned(), Preset::find("Snare").unwrap().clone())];
        let pads = vec![(36, Pad::of(0)), (38, Pad::of(1))];
        let Ok(Playable::Kit(empty)) = parse("kit = 1\nname = \"k\"\nkeys = [{ key = 1, sound = \"Kick\" }]") else {
            panic!("a kit")
        };
        let kit = KitPreset { sounds, pads, ..empty };
        let (text, whole) = (kit.to_toml(), kit.to_whole_toml());
        assert!(text.contains("[sounds.Kick.params]") && !text.contains("[sounds.Snare"), "{text}");
        assert!(whole.contains("[sounds.Snare"), "{whole}");
        for text in [&text, &whole] {
            assert_eq!(parse(text).unwrap(), Playable::Kit(kit.clone()), "{text}");
        }
        let nowhere = |name: &str| Err(Error::value(name, "nowhere"));
        assert_eq!(Playable::parse(&whole, "x", &mut { nowhere }).unwrap(), Playable::Kit(kit));
        for (body, expected) in [
            ("sounds = 3", "x: sounds: expected presets by name, [sounds.NAME], found integer ‘3’"),
            ("sounds = { Kick = 3 }", "x: sounds.Kick: expected a preset, found integer"),
            ("sounds = { Kick = { kit = 1 } }", "x: sounds.Kick: this is a kit: expected a preset"),
            ("sounds = { Kick = { format = 1, name = \"a\", x = 1 } }", "x: sounds.Kick: unknown key ‘x’"),
            (
                "sounds = { Odd = { format = 1, name = \"a\" } }",
                "x: sounds.Odd: no key plays it: expected a key with sound = \"Odd\"",
            ),
        ] {
            let text = format!("kit = 1\nname = \"k\"\n{body}\nkeys = [{{ key = 1, sound = \"Kick\" }}]");
            let error = parse(&text).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}\nexpected: {expected}");
        }
    }

    #[test]
    fn every_error_says_what_would_be_right() {
        let key = |fields: &str| format!("name = \"k\"\n[[keys]]\n{fields}");
        let pad = |fields: &str| key(&format!("key = 36\nsound = \"Kick\"\n{fields}"));
        for (body, expected) in [
            ("".to_owned(), "x: there is no ‘name’"),
            ("name = \"k\"".to_owned(), "x: there are no ‘keys’: expected [[keys]] with key and sound"),
            ("name = \"k\"\nkeys = []".to_owned(), "x: there are no ‘keys’"),
            ("name = \"k\"\nkeys = 3".to_owned(), "x: keys: expected a list of tables, [[keys]], found integer ‘3’"),
            ("name = \"k\"\nkeys = [3]".to_owned(), "x: keys[0]: expected a table, [[keys]], found integer ‘3’"),
            ("format = 2".to_owned(), "x: unknown key ‘format’"),
            (
                "voices = 65\nname = \"k\"".to_owned(),
                "x: voices: 65 is out of range: expected a whole number from 1 to 64",
            ),
            (
                key("sound = \"Kick\""),
                "x: keys[0].key: there is none: expected a note name (\"C2\") or a key from 0 to 127",
            ),
            (key("key = 128\nsound = \"Kick\""), "x: keys[0].key: ‘128’ is no key: expected a note name"),
            (key("key = \"60.5\"\nsound = \"Kick\""), "x: keys[0].key: ‘\"60.5\"’ is no key"),
            (key("key = 36"), "x: keys[0]: there is no ‘sound’: expected a factory preset or a preset file"),
            (key("key = 36\nsound = 3"), "x: keys[0].sound: expected a factory preset or a preset file, found integer"),
            (
                key("key = 36\nsound = \"Kcik\""),
                "x: keys[0].sound: preset: there is no factory preset ‘Kcik’; the nearest is",
            ),
            (pad("pitch = \"H2\""), "x: keys[0].pitch: ‘H2’ is not a note: expected a note name (C#4)"),
            (pad("pitch = 128"), "x: keys[0].pitch: note ‘128’ is out of range"),
            (pad("pitch = nan"), "x: keys[0].pitch: ‘nan’ is not a note"),
            (pad("pitch = true"), "x: keys[0].pitch: expected a note name, a key or a frequency, found boolean"),
            (pad("gain = 99"), "x: keys[0].gain: 99 is out of range: expected from -60 dB to 12 dB"),
            (pad("pan = 2"), "x: keys[0].pan: 2 is out of range: expected -1 to 1"),
            (pad("pan = nan"), "x: keys[0].pan: NaN is out of range"),
            (pad("pan = \"left\""), "x: keys[0].pan: expected a number from -1 to 1, found string"),
            (pad("output = 17"), "x: keys[0].output: 17 is none: expected \"main\" or a whole number from 1 to 16"),
            (pad("output = 0"), "x: keys[0].output: 0 is none: expected \"main\""),
            (pad("choke = 17"), "x: keys[0].choke: 17 is out of range: expected a whole number from 0 to 16"),
            (pad("name = 1"), "x: keys[0].name: expected a text, found integer ‘1’"),
            (pad("name = \" a\""), "x: keys[0].name: expected one line of at most 100 characters"),
            (pad("velocity = 1"), "x: unknown key ‘keys[0].velocity’: expected one of key, name, sound, "),
            (
                pad("[[keys]]\nkey = \"C2\"\nsound = \"Kick\""),
                "x: keys[1].key: C2 (36) has a pad already: expected another key",
            ),
        ] {
            let error = parse(&format!("kit = 1\n{body}")).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}\nexpected: {expected}");
        }
        for (text, expected) in [
            ("kit = 2", "x: kit 2 is of a newer version: this one reads kit = 1"),
            ("kit = \"a\"", "x: kit \"a\" is unknown: this version reads kit = 1"),
            ("kit = 1\nname = ", "x:2:8: not valid TOML: "),
            ("name = \"a\"", "x: there is no ‘format’: expected format = 1"),
            ("name = \"a\"\n[[keys]]", "x: there is no ‘kit’: expected kit = 1"),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
