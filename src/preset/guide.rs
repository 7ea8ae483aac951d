//! Facts about a preset that do not change its sound: family, range of keys, names of the macros, and a phrase to try it.

use super::about::{check_label, toml_string};
use super::complaints::Complaints;
use super::phrase::Phrase;
use super::value::{check_keys, unexpected};
use crate::error::nearest;
use crate::patch::routes::MAX_MACROS;
use crate::units::{key_from_note_name, note_name};
use std::fmt::{self, Write};
use toml::{Table, Value};

macro_rules! families {
    ($($family:ident $name:literal),* $(,)?) => {
        /// The family of an instrument that a preset belongs to.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Family {
            $(#[doc = concat!("`", $name, "`")] $family,)*
        }

        impl Family {
            /// All families, in the order in which lists show them.
            pub const ALL: &[Self] = &[$(Self::$family),*];

            /// The name in files and lists.
            pub fn name(self) -> &'static str {
                match self { $(Self::$family => $name),* }
            }
        }
    };
}

families! {
    Kick "kick", Snare "snare", Tom "tom", Hat "hat", Cymbal "cymbal", HandDrum "hand_drum", Percussion "percussion",
    Mallet "mallet", Bell "bell", Plucked "plucked", StruckString "struck_string", Bowed "bowed", Wind "wind", Bass "bass",
    Lead "lead", Keys "keys", Pad "pad", Drone "drone", Effect "effect",
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Facts about a preset for the person who plays it. They do not change the sound.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// The family; none if the file names none.
    pub family: Option<Family>,
    /// Lowest MIDI key for which the sound is meant.
    pub lowest: u8,
    /// Highest MIDI key for which the sound is meant.
    pub highest: u8,
    /// The key that is most typical of the sound.
    pub home: u8,
    /// Names of the macros, from the first on; at most eight. The name of an unused macro is empty.
    pub macros: Vec<String>,
    /// Notes to try the sound with; if there are none, the home key is played.
    pub phrase: Option<Phrase>,
}

impl Default for Guide {
    fn default() -> Self {
        Self { family: None, lowest: 0, highest: 127, home: 60, macros: Vec::new(), phrase: None }
    }
}

impl Guide {
    /// The name of a macro, given the id of its parameter or source (`macro1` …); none if the id is not a macro's or
    /// the macro has no name.
    pub fn macro_name(&self, id: &str) -> Option<&str> {
        let number: usize = id.strip_prefix("macro")?.parse().ok()?;
        self.macros.get(number.checked_sub(1)?).map(String::as_str).filter(|name| !name.is_empty())
    }

    pub(super) const KEYS: [&str; 4] = ["family", "range", "macros", "phrase"];

    pub(super) fn read(table: &Table, complaints: &mut Complaints) -> Self {
        let mut guide = Self::default();
        if let Some(value) = table.get("family") {
            guide.family = complaints.take("family: ", family(value));
        }
        match table.get("range") {
            None => {}
            Some(Value::Table(keys)) => guide.read_range(keys, complaints),
            Some(other) => {
                complaints.add(unexpected("range", "{ lowest = \"C2\", highest = \"C7\", home = \"C4\" }", other));
            }
        }
        match table.get("macros") {
            None => {}
            Some(Value::Array(names)) if names.len() <= MAX_MACROS => {
                let name = |(index, name): (usize, &Value)| match name {
                    Value::String(name) => check_label(&format!("macros[{index}]"), name.clone()),
                    other => Err(unexpected(&format!("macros[{index}]"), "a name", other)),
                };
                guide.macros =
                    names.iter().enumerate().map(|each| complaints.take("", name(each)).unwrap_or_default()).collect();
            }
            Some(other) => complaints.add(unexpected("macros", "a list of at most eight names", other)),
        }
        match table.get("phrase") {
            None => {}
            Some(Value::String(text)) => guide.phrase = complaints.take("phrase: ", text.parse()),
            Some(other) => complaints.add(unexpected("phrase", "notes such as \"C4 E4 C4+E4+G4@110*4\"", other)),
        }
        guide
    }

    fn read_range(&mut self, keys: &Table, complaints: &mut Complaints) {
        const FIELDS: [&str; 3] = ["lowest", "highest", "home"];
        check_keys(keys, "range.", &FIELDS, complaints);
        let [lowest, highest, home] = FIELDS.map(|field| {
            let value = keys.get(field)?;
            complaints.take(&format!("range.{field}: "), key(value))
        });
        let (lowest, highest) = (lowest.unwrap_or(self.lowest), highest.unwrap_or(self.highest));
        let home = home.unwrap_or(self.home.clamp(lowest.min(highest), highest.max(lowest)));
        if lowest <= home && home <= highest {
            (self.lowest, self.highest, self.home) = (lowest, highest, home);
        } else {
            let names = [lowest, home, highest].map(note_name).join(", ");
            complaints.add(format!("range: expected lowest, home and highest in this order, found {names}"));
        }
    }

    /// TOML lines for the fields that differ from those of a new preset.
    pub(super) fn to_toml(&self) -> String {
        let (mut out, new) = (String::new(), Self::default());
        if let Some(family) = self.family {
            let _ = writeln!(out, "family = \"{family}\"");
        }
        if (self.lowest, self.highest, self.home) != (new.lowest, new.highest, new.home) {
            let [lowest, highest, home] = [self.lowest, self.highest, self.home].map(note_name);
            let _ = writeln!(out, "range = {{ lowest = \"{lowest}\", highest = \"{highest}\", home = \"{home}\" }}");
        }
        if !self.macros.is_empty() {
            let names: Vec<String> = self.macros.iter().map(|name| toml_string(name)).collect();
            let _ = writeln!(out, "macros = [{}]", names.join(", "));
        }
        if let Some(phrase) = &self.phrase {
            let _ = writeln!(out, "phrase = {}", toml_string(&phrase.to_string()));
        }
        out
    }
}

fn family(value: &Value) -> Result<Family, String> {
    let names = Family::ALL.iter().map(|family| family.name());
    let Value::String(text) = value else {
        return Err(format!("expected one of {}", names.collect::<Vec<_>>().join(", ")));
    };
    Family::ALL.iter().copied().find(|family| family.name() == text).ok_or_else(|| match nearest(text, names.clone()) {
        Some(near) => format!("‘{text}’ is no family; the nearest is {near}"),
        None => format!("‘{text}’ is no family: expected one of {}", names.collect::<Vec<_>>().join(", ")),
    })
}

fn key(value: &Value) -> Result<u8, String> {
    let key = match value {
        Value::String(name) => key_from_note_name(name),
        Value::Integer(key) => u8::try_from(*key).ok().filter(|key| *key < 128),
        _ => None,
    };
    key.ok_or_else(|| format!("expected a key such as \"C4\" or 60, found {value}"))
}

#[cfg(test)]
mod tests {
    use super::super::Preset;
    use super::*;

    fn guide(lines: &str) -> crate::Result<Guide> {
        Preset::parse(&format!("format = 1\nname = \"a\"\n{lines}"), "x").map(|preset| preset.guide)
    }

    #[test]
    fn what_is_written_reads_back() {
        let text = "family = \"hand_drum\"\nrange = { lowest = \"C2\", highest = \"C7\", home = \"F#3\" }\n\
                    macros = [\"Glass\", \"Big “room”\"]\nphrase = \"C4 - E4+G4@110*2.5\"\n";
        let read = guide(text).unwrap();
        assert_eq!((read.family, read.lowest, read.highest, read.home), (Some(Family::HandDrum), 36, 96, 54));
        assert_eq!(read.macros, ["Glass", "Big “room”"]);
        assert_eq!(guide(&read.to_toml()).unwrap(), read);
        assert_eq!(guide("").unwrap(), Guide::default());
        assert_eq!(Guide::default().to_toml(), "");
    }

    #[test]
    fn mistakes_are_named() {
        for (lines, expected) in [
            ("family = \"malet\"", "the nearest is ‘mallet’"),
            ("range = { lowest = \"C5\", highest = \"C2\" }", "in this order"),
            ("range = { lowest = \"H9\" }", "expected a key"),
            ("range = 3", "expected { lowest"),
            ("macros = [\"1\", \"2\", \"3\", \"4\", \"5\", \"6\", \"7\", \"8\", \"9\"]", "at most eight"),
            ("phrase = \"C4 X\"", "phrase: "),
        ] {
            let error = guide(lines).unwrap_err().to_string();
            assert!(error.contains(expected), "{lines}: {error}");
        }
    }
}
