//! The sounds that MIDI program changes select, melodic sounds and drum kits, and the mix of songs that use them.

use super::about::{check_label, label};
use super::complaints::Complaints;
use super::kit::Playable;
use super::value::{check_keys, read_params, table, unexpected};
use crate::error::{Error, Result};
use crate::params::Param;
use crate::sound::kit::GAINS_DB;
use crate::sound::{Kit, Mix};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::RangeInclusive;
use std::sync::{Arc, OnceLock};
use toml::Value;

/// The version of program files that is read.
const VERSION: i64 = 1;

/// Number of programs of each kind.
const PROGRAMS: usize = 128;

/// Each group of this many drum program numbers holds variations of the group's first kit, as in Roland's GS.
const VARIATIONS: usize = 8;

const KEYS: [&str; 6] = ["programs", "name", "sounds", "drums", "gain", "space"];

/// Gains of a mix in dB.
const GAINS: RangeInclusive<f64> = -60.0..=24.0;

/// Names of the sounds that program changes select (factory presets and kits, or files), and the mix.
#[derive(Clone, Debug, PartialEq)]
pub struct Programs {
    /// Name of the list; never empty.
    pub name: String,
    /// How songs with these sounds are mixed.
    pub mix: Mix,
    sounds: Vec<Option<Program>>,
    drums: Vec<Option<Program>>,
}

/// The sound of a program.
#[derive(Clone, Debug, PartialEq)]
struct Program {
    /// Name of a preset or kit; never empty.
    sound: String,
    /// Gain in dB, in addition to the sound's own.
    gain: f32,
}

impl Programs {
    /// The factory's sounds for General MIDI.
    pub fn general_midi() -> &'static Self {
        const TEXT: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/programs/general-midi.toml"));
        static PROGRAMS: OnceLock<Programs> = OnceLock::new();
        PROGRAMS.get_or_init(|| Self::parse(TEXT, "general-midi.toml").expect("the embedded list is checked by a test"))
    }

    /// Reads a list of programs. `origin` names the text in errors. Sounds are not looked up.
    ///
    /// # Errors
    /// [`Error::Format`] naming the place and what would be right.
    pub(crate) fn parse(text: &str, origin: &str) -> Result<Self> {
        let mut complaints = Complaints::default();
        let programs =
            read(&table(text, origin)?, &mut complaints).map_err(|message| Error::format(origin, message))?;
        complaints.into_first(origin).map(|()| programs)
    }

    /// The name of the sound of a melodic program, counted from 0; none if the list has none.
    pub fn sound(&self, number: u8) -> Option<&str> {
        self.program(number).map(|program| &*program.sound)
    }

    fn program(&self, number: u8) -> Option<&Program> {
        self.sounds.get(usize::from(number))?.as_ref()
    }

    /// The name of the kit of a drum program, counted from 0: the kit of this number, else the kit of which this number
    /// is a variation, else the first kit.
    pub fn drums(&self, number: u8) -> Option<&str> {
        self.drum_program(number).map(|program| &*program.sound)
    }

    fn drum_program(&self, number: u8) -> Option<&Program> {
        let number = usize::from(number);
        let places = [number, number / VARIATIONS * VARIATIONS, 0];
        places.into_iter().find_map(|place| self.drums.get(place)?.as_ref())
    }
}

impl Programs {
    /// The name of the sound of a program: first the melodic ones, and from 128 on the drum kits.
    pub(crate) fn name_of(&self, number: u8) -> Option<&str> {
        self.any(number).map(|program| &*program.sound)
    }

    fn any(&self, number: u8) -> Option<&Program> {
        match number.checked_sub(PROGRAMS as u8) {
            None => self.program(number),
            Some(drums) => self.drum_program(drums),
        }
    }

    /// The kits of all programs, numbered as in [`Programs::name_of`], with their gains. `load` makes a kit from its
    /// name, and is called once for each name and gain. Programs that are not `wanted` or have no sound get no kit.
    /// Allocates.
    ///
    /// # Errors
    /// Those of `load`.
    pub(crate) fn kits(
        &self,
        wanted: impl Fn(u8) -> bool,
        mut load: impl FnMut(&str) -> Result<Arc<Kit>>,
    ) -> Result<Vec<Option<Arc<Kit>>>> {
        let mut made: BTreeMap<(&str, u32), Arc<Kit>> = BTreeMap::new();
        let mut kit = |number| {
            let Some(Program { sound, gain }) = self.any(number).filter(|_| wanted(number)) else { return Ok(None) };
            Ok(Some(match made.entry((sound, gain.to_bits())) {
                Entry::Occupied(known) => known.get().clone(),
                Entry::Vacant(place) => {
                    let kit = load(sound)?;
                    place.insert(if *gain == 0.0 { kit } else { Arc::new(kit.with_gain(*gain)) }).clone()
                }
            }))
        };
        (0..=u8::MAX).map(&mut kit).collect()
    }

    /// The factory's kits for all programs of General MIDI. Reads most of the factory's sounds, and allocates.
    pub fn factory_kits() -> Vec<Arc<Kit>> {
        let load = |name: &str| Playable::find(name).map(|playable| playable.kit());
        let kits = Self::general_midi().kits(|_| true, load).expect("a test finds all of them");
        kits.into_iter().flatten().collect()
    }
}

fn read(table: &toml::Table, complaints: &mut Complaints) -> std::result::Result<Programs, String> {
    match table.get("programs") {
        Some(Value::Integer(VERSION)) => {}
        Some(other) => return Err(format!("programs {other} is unknown: this version reads programs = {VERSION}")),
        None => {
            return Err(format!(
                "there is no ‘programs’: expected a list of programs, which begins with programs = {VERSION}"
            ));
        }
    }
    check_keys(table, "", &KEYS, complaints);
    let name = label(table, "name", "", complaints);
    let name = if name.is_empty() { "Unnamed".to_owned() } else { name };
    let is_wanted = |param: Param| param.is_of_space() && param != Param::SpaceMix;
    let space = read_params("space", table.get("space"), is_wanted, complaints);
    if table.contains_key("space") && !space.iter().any(|(param, value)| *param == Param::Space && *value > 0.0) {
        complaints.add("space.space: expected the body that all channels share, such as \"plate\"".to_owned());
    }
    let gain = match table.get("gain") {
        None => 0.0,
        Some(value) => complaints.take("", read_gain("gain", value, GAINS)).unwrap_or(0.0),
    };
    let mut programs = Programs { name, mix: Mix { gain, space }, sounds: Vec::new(), drums: vec![None; PROGRAMS] };
    match table.get("sounds") {
        None => {}
        Some(Value::Array(names)) if names.len() <= PROGRAMS => {
            let mut sound =
                |(index, value): (usize, &Value)| read_program(&format!("sounds[{index}]"), value, complaints);
            programs.sounds = names.iter().enumerate().map(&mut sound).collect();
        }
        Some(other) => complaints.add(unexpected("sounds", "a list of at most 128 names, from program 1 on", other)),
    }
    match table.get("drums") {
        None => {}
        Some(Value::Table(kits)) => {
            for (number, value) in kits {
                let place = format!("drums.{number}");
                match number.parse::<usize>() {
                    Ok(number @ 1..=PROGRAMS) => programs.drums[number - 1] = read_program(&place, value, complaints),
                    _ => complaints.add(format!("{place}: expected a program number from 1 to {PROGRAMS}")),
                }
            }
        }
        Some(other) => complaints.add(unexpected("drums", "a table [drums] of kits by program number", other)),
    }
    Ok(programs)
}

/// Reads the sound of a program: a name, or a name and a gain. None for an empty name, or if it cannot be read.
fn read_program(place: &str, value: &Value, complaints: &mut Complaints) -> Option<Program> {
    let name = |place: &str, value: &Value| match value {
        Value::String(name) => check_label(place, name.clone()),
        other => Err(unexpected(place, "the name of a preset or kit", other)),
    };
    let (sound, gain) = match value {
        Value::Table(both) => {
            let inner = format!("{place}.");
            check_keys(both, &inner, &["sound", "gain"], complaints);
            let missing = || Err(format!("{place}: there is no ‘sound’: expected the name of a preset or kit"));
            let sound = both.get("sound").map_or_else(missing, |value| name(&format!("{inner}sound"), value));
            let range = f64::from(*GAINS_DB.start())..=f64::from(*GAINS_DB.end());
            let gain = both.get("gain").map_or(Ok(0.0), |value| read_gain(&format!("{inner}gain"), value, range));
            (sound, complaints.take("", gain).unwrap_or(0.0))
        }
        single => (name(place, single), 0.0),
    };
    let sound = complaints.take("", sound).filter(|name| !name.is_empty())?;
    Some(Program { sound, gain })
}

fn read_gain(place: &str, value: &Value, range: RangeInclusive<f64>) -> std::result::Result<f32, String> {
    let number = value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64));
    number
        .filter(|gain| range.contains(gain))
        .map(|gain| gain as f32)
        .ok_or_else(|| unexpected(place, &format!("dB from {} to {}", range.start(), range.end()), value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn general_midi_has_a_sound_for_every_program() {
        let programs = Programs::general_midi();
        for number in 0..128 {
            for name in [programs.sound(number), programs.drums(number)] {
                let name = name.unwrap_or_else(|| panic!("program {}", number + 1));
                assert!(Playable::find(name).is_ok(), "program {}: {name}", number + 1);
            }
        }
    }

    #[test]
    fn the_manual_has_a_table_of_the_programs() {
        let page = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/manual/midi.md"));
        for first in (0..128).step_by(8) {
            let names: Vec<_> =
                (first..first + 8).map(|number| Programs::general_midi().sound(number).unwrap()).collect();
            let (from, to, names) = (first + 1, first + 8, names.join(", "));
            let row =
                |line: &str| line.starts_with(&format!("| {from}–{to} |")) && line.ends_with(&format!("| {names} |"));
            assert!(page.lines().any(row), "programs {from} to {to}: {names}");
        }
    }

    #[test]
    fn kits_of_unknown_numbers_are_those_that_they_vary() {
        let text = "programs = 1\nname = \"a\"\nsounds = [\"Kick\", \"\"]\n[drums]\n1 = \"A\"\n25 = \"B\"\n26 = \"C\"";
        let programs = Programs::parse(text, "x").unwrap();
        assert_eq!([0, 1, 2].map(|number| programs.sound(number)), [Some("Kick"), None, None]);
        let drums = [0, 9, 24, 25, 27, 127].map(|number| programs.drums(number).unwrap());
        assert_eq!(drums, ["A", "A", "B", "C", "B", "A"]);
        assert_eq!(Programs::parse("programs = 1\nname = \"a\"", "x").unwrap().drums(3), None);
    }

    #[test]
    fn a_list_says_how_songs_are_mixed() {
        let mix = |text: &str| Programs::parse(&format!("programs = 1\n{text}"), "x").unwrap().mix;
        assert_eq!(mix(""), Mix::default());
        let room = mix("gain = -6\n[space]\nspace = \"room\"\nspace_size = 50");
        assert_eq!((room.gain, &room.space[..]), (-6.0, &[(Param::Space, 3.0), (Param::SpaceSize, 50.0)][..]));
        assert_eq!(mix("gain = 1.5").gain, 1.5);
        let general = &Programs::general_midi().mix;
        assert_eq!((general.gain, general.space[0]), (-6.0, (Param::Space, 1.0)));
    }

    #[test]
    fn a_program_may_be_softer_than_its_sound() {
        let text = "programs = 1\nsounds = [\"Marimba\", { sound = \"Marimba\", gain = -4 }, { sound = \"Acoustic Kit\", gain = 2.5 }]";
        let kits = Programs::parse(text, "x").unwrap();
        let load = |name: &str| Playable::find(name).map(|playable| playable.kit());
        let kits = kits.kits(|number| number < 3, load).unwrap();
        let gain = |kit: usize| kits[kit].as_ref().unwrap().pad(38).unwrap().gain_db;
        let snare = Playable::find("Acoustic Kit").unwrap().kit().pad(38).unwrap().gain_db;
        assert_eq!([0, 1, 2].map(gain), [0.0, -4.0, snare + 2.5]);
    }

    #[test]
    fn mistakes_are_named() {
        for (text, expected) in [
            ("name = \"a\"", "begins with programs = 1"),
            ("programs = 2", "reads programs = 1"),
            ("programs = 1\nsounds = [3]", "sounds[0]: expected the name"),
            ("programs = 1\nsounds = [{ gain = 3 }]", "sounds[0]: there is no ‘sound’"),
            ("programs = 1\nsounds = [{ sound = 3 }]", "sounds[0].sound: expected the name"),
            ("programs = 1\nsounds = [{ sound = \"A\", gain = 13 }]", "sounds[0].gain: expected dB from -60 to 12"),
            ("programs = 1\nsounds = [{ sound = \"A\", pan = 1 }]", "unknown key ‘sounds[0].pan’"),
            ("programs = 1\ndrums = { 0 = \"A\" }", "drums.0: expected a program number from 1 to 128"),
            ("programs = 1\ngain = \"loud\"", "gain: expected dB from -60 to 24, found string"),
            ("programs = 1\ngain = 30", "gain: expected dB from -60 to 24, found integer"),
            ("programs = 1\nspace = \"plate\"", "space: expected a table [space]"),
            ("programs = 1\n[space]\nspace = \"cave\"", "space.space: ‘cave’ is not one of"),
            ("programs = 1\n[space]\nspace_size = 90", "space.space: expected the body that all channels share"),
            ("programs = 1\n[space]\nspace = \"plate\"\nspace_mix = 20", "unknown key ‘space.space_mix’"),
            ("programs = 1\nkits = 1", "unknown key ‘kits’"),
        ] {
            let error = Programs::parse(text, "x").unwrap_err().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
