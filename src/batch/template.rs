//! A line of a file of jobs: the options of a request, some of them with random values.

use super::Batch;
use super::draw::{Chance, Draw};
use super::scalar::{Scale, text_of};
use super::twice::key_twice;
use crate::params::{PARAMS, Param};
use crate::request::{Name, Request};
use serde_json::{Map, Value};
use std::collections::BTreeSet;

/// The key for the number of jobs that a line makes.
const REPEAT: &str = "repeat";

/// The options that contain other keys.
const SET: &str = "set";
const CHANNEL: &str = "channel";

/// The options that name a sound, or a list of sounds.
const PRESET: &str = "preset";
const PROGRAMS: &str = "programs";

/// Groups of options that can contradict each other or the format of the files; the other options do not matter for
/// this.
const TOGETHER: [&[&str]; 4] =
    [&["song", "note", "scale", "keymap"], &["bits", "dither"], &["normalize", "gain_db"], &["rate"]];

/// How many of their combinations are checked before the first job starts. Other contradictions are found when they are
/// drawn.
const MOST_COMBINATIONS: usize = 1 << 16;

/// How many names of sounds are remembered as checked: the limit keeps memory use independent of the number of lines.
const MOST_NAMES: usize = 1 << 12;

/// An error in a line: a key and a message.
pub(super) type Fault = (String, String);

/// A value of a line.
#[derive(Clone, Debug)]
enum Part {
    Fixed(Value),
    Drawn(Draw),
}

/// One of the options of a line.
#[derive(Clone, Debug)]
struct Entry {
    /// Its keys in the line: an option, or an option and a key inside it.
    path: Vec<String>,
    part: Part,
}

/// A parsed line.
#[derive(Clone, Debug)]
pub(super) struct Template {
    entries: Vec<Entry>,
    /// Number of jobs that the line makes.
    pub(super) repeat: u64,
}

/// A job with its drawn values.
#[derive(Clone, Debug)]
pub(super) struct Drawn {
    pub(super) request: Request,
    /// The line, with drawn values in place of the distributions.
    pub(super) line: Map<String, Value>,
}

impl Template {
    /// Reads a line, and checks the possible values.
    pub(super) fn parse(line: &str, batch: &Batch) -> Result<Self, Fault> {
        let whole = |message: String| ("line".to_owned(), message);
        let value: Value = serde_json::from_str(line).map_err(|error| whole(format!("no JSON: {error}")))?;
        let Value::Object(object) = value else {
            return Err(whole("expected an object, as in {\"preset\": \"Kick\", \"note\": \"C4\"}".to_owned()));
        };
        if let Some(twice) = key_twice(line) {
            return Err((twice, "one object has it twice: expected it once".to_owned()));
        }
        let names: Vec<String> = object.keys().cloned().collect();
        let (mut entries, mut repeat) = (Vec::new(), 1);
        for (key, value) in object {
            match (key.as_str(), value) {
                (REPEAT, value) => {
                    let count = value.as_u64().filter(|count| *count > 0);
                    repeat = count.ok_or_else(|| (key, "expected a whole number from 1".to_owned()))?;
                }
                (SET | CHANNEL, Value::Object(inner)) => {
                    for (name, value) in inner {
                        entries.push(Entry::new(vec![key.clone(), name], value)?);
                    }
                }
                (_, value) => entries.push(Entry::new(vec![key], value)?),
            }
        }
        let is_twice = |entry: &&Entry| matches!(&entry.path[..], [set, name] if set == SET && names.contains(name));
        if let Some(twice) = entries.iter().find(is_twice) {
            let name = &twice.path[1];
            return Err((twice.path.join("."), format!("‘{name}’ is in the line as well: expected it once")));
        }
        // Sorted by name: the same job is written in the same way, whatever the order in the file.
        entries.sort_by(|a, b| a.path.cmp(&b.path));
        let template = Self { entries, repeat };
        template.check(batch)?;
        Ok(template)
    }

    /// Checks both ends of each distribution, every choice, and their combinations. Reads no files.
    fn check(&self, batch: &Batch) -> Result<(), Fault> {
        for entry in &self.entries {
            for candidate in entry.candidates() {
                let mut one = Request::default();
                entry.set(&mut one, &candidate)?;
                if entry.is_file()
                    && let Some(own) = one.files().find_map(|file| batch.own(file))
                {
                    return Err((entry.path.join("."), own));
                }
            }
        }
        TOGETHER.iter().try_for_each(|options| self.check_together(options, batch))
    }

    /// Reads the kits and lists of programs that are not in `read` yet. Returns an error if one of them names a file
    /// that the batch writes.
    pub(super) fn check_sounds(&self, batch: &Batch, read: &mut BTreeSet<(bool, String)>) -> Result<(), Fault> {
        for entry in self.entries.iter().filter(|entry| entry.is_sound()) {
            for candidate in entry.candidates() {
                if read.len() == MOST_NAMES {
                    read.clear();
                }
                let is_programs = entry.name() == PROGRAMS;
                if !read.insert((is_programs, candidate.to_string())) {
                    continue;
                }
                let mut one = Request::default();
                entry.set(&mut one, &candidate)?;
                if let Some(own) = one.sound.files().paths().find_map(|file| batch.own(file)) {
                    return Err((entry.path.join("."), own));
                }
            }
        }
        Ok(())
    }

    /// Checks all combinations of some options, each with one value of the other options.
    fn check_together(&self, options: &[&str], batch: &Batch) -> Result<(), Fault> {
        let (mut others, mut varied) = (Request::default(), Vec::new());
        for entry in &self.entries {
            let is_one_of = |options: &[&str]| matches!(&entry.path[..], [name] if options.contains(&name.as_str()));
            if is_one_of(options) {
                varied.push((entry, entry.candidates()));
            } else if TOGETHER.iter().any(|options| is_one_of(options))
                && let Some(first) = entry.candidates().first()
            {
                entry.set(&mut others, first)?;
            }
        }
        let all = varied.iter().fold(1_usize, |all, (_, candidates)| all.saturating_mul(candidates.len()));
        for combination in 0..all.min(MOST_COMBINATIONS) {
            let (mut request, mut rest) = (others.clone(), combination);
            for (entry, candidates) in &varied {
                entry.set(&mut request, &candidates[rest % candidates.len()])?;
                rest /= candidates.len();
            }
            request.check().map_err(|error| match error {
                crate::Error::Value { name, message } => (key_of(&name), message),
                error => ("line".to_owned(), error.to_string()),
            })?;
            batch.check_format(&request)?;
        }
        Ok(())
    }

    /// Draws the values of a job.
    pub(super) fn draw(&self, chance: Chance) -> Result<Drawn, Fault> {
        let mut request = Request { seed: chance.seed(), ..Request::default() };
        let mut line = Map::new();
        for entry in &self.entries {
            let value = match &entry.part {
                Part::Fixed(value) => value.clone(),
                Part::Drawn(draw) => draw.draw(entry.name(), chance),
            };
            entry.set(&mut request, &value)?;
            match &entry.path[..] {
                [key, name] => {
                    let inner = line.entry(key.clone()).or_insert_with(|| Value::Object(Map::new()));
                    if let Value::Object(inner) = inner {
                        inner.insert(name.clone(), value);
                    }
                }
                path => drop(line.insert(path.join("."), value)),
            }
        }
        Ok(Drawn { request, line })
    }
}

impl Entry {
    fn new(path: Vec<String>, value: Value) -> Result<Self, Fault> {
        let key = path.join(".");
        let fault = |message: String| (key.clone(), message);
        if let [option] = &path[..]
            && [SET, CHANNEL].contains(&option.as_str())
        {
            let expected = if option == SET { "{\"decay\": \"2 s\"}" } else { "{\"10\": \"drums.toml\"}" };
            return Err(fault(format!("expected an object, as in {expected}")));
        }
        let part = match value {
            Value::Object(object) => Part::Drawn(Scale::of(&path).read(object).map_err(fault)?),
            value => Part::Fixed(value),
        };
        Ok(Self { path, part })
    }

    /// The name of the parameter or option.
    fn name(&self) -> &str {
        self.path.last().map_or("", String::as_str)
    }

    /// Values to check: all choices, both ends of a range, or two values of a normal distribution.
    fn candidates(&self) -> Vec<Value> {
        match &self.part {
            Part::Fixed(value) => vec![value.clone()],
            Part::Drawn(Draw::Choice(values)) => values.clone(),
            Part::Drawn(Draw::Uniform(low, high) | Draw::LogUniform(low, high) | Draw::Integer(low, high)) => {
                vec![(*low).into(), (*high).into()]
            }
            Part::Drawn(Draw::Normal(mean, deviation, [least, most])) => {
                vec![(*mean).into(), (mean + deviation).clamp(*least, *most).into()]
            }
        }
    }

    /// Whether it may name a file.
    fn is_file(&self) -> bool {
        const FILES: [&str; 7] = ["song", "input", PRESET, CHANNEL, PROGRAMS, "scale", "keymap"];
        self.path.first().is_some_and(|option| FILES.contains(&option.as_str()))
    }

    /// Whether it names a sound or a list of sounds, whose files may name more files.
    fn is_sound(&self) -> bool {
        self.path.first().is_some_and(|option| [PRESET, CHANNEL, PROGRAMS].contains(&option.as_str()))
    }

    /// Sets the option of a request to a value.
    fn set(&self, request: &mut Request, value: &Value) -> Result<(), Fault> {
        let fault = |message: String| (self.path.join("."), message);
        let text = text_of(value).map_err(fault)?;
        if ["song", "input"].contains(&self.name()) && self.path.len() == 1 && text == "-" {
            return Err(fault("expected a file: many jobs cannot read standard input".to_owned()));
        }
        let set = match &self.path[..] {
            [option, name] => request.set(option, &format!("{name}={text}")),
            [name] if is_parameter(name) => request.set(SET, &format!("{name}={text}")),
            [name] if Name::find(name).is_none() => Err(unknown(name)),
            path => request.set(&path.join("."), &text),
        };
        // The message of a parameter begins with its name, which the key already shows.
        set.map_err(|message| fault(message.trim_start_matches(&format!("{}: ", self.name())).to_owned()))
    }
}

/// Whether a key is a parameter; parameters may appear beside the options.
fn is_parameter(name: &str) -> bool {
    Param::from_id(name).is_some() && Name::find(name).is_none()
}

fn unknown(name: &str) -> String {
    let known = Request::NAMES.iter().map(|option| option.name).chain(PARAMS.iter().map(|info| info.id));
    let near = crate::error::nearest(name, known).map_or(String::new(), |near| format!("; the nearest is {near}"));
    format!("there is no option or parameter ‘{name}’{near}")
}

/// The key of an option from its name on the command line.
pub(super) fn key_of(option: &str) -> String {
    option.trim_start_matches("--").replace('-', "_")
}
