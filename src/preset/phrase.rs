//! A short phrase to try a sound with, as a line of text.

use crate::units::{key_from_note_name, note_name};
use std::fmt;
use std::str::FromStr;

/// Velocity of notes without `@`, 1–127.
const VELOCITY: u8 = 100;

/// Maximum number of steps of a phrase, and of each of its notes.
const MOST_STEPS: f64 = 64.0;

/// Notes in steps of a third of a second: `C4@40 - E4+G4@110*2` is a soft note, a rest, and a loud chord of two steps. `+`
/// joins notes that begin together, `@` sets their velocity (1–127, otherwise 100) and `*` their length in steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Phrase {
    chords: Vec<Chord>,
}

/// Notes that begin together, or a rest if there are none.
#[derive(Clone, Debug, PartialEq)]
struct Chord {
    keys: Vec<u8>,
    velocity: u8,
    steps: f64,
}

/// A note of a phrase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhraseNote {
    /// Seconds from the start of the phrase.
    pub start: f64,
    /// Length in seconds.
    pub seconds: f64,
    /// MIDI key.
    pub key: u8,
    /// 1–127.
    pub velocity: u8,
}

impl Phrase {
    /// Length of a step in seconds.
    pub(crate) const STEP: f64 = 1.0 / 3.0;

    /// The notes, in order of their starts.
    pub fn notes(&self) -> Vec<PhraseNote> {
        let (mut notes, mut step) = (Vec::new(), 0.0);
        for Chord { keys, velocity, steps } in &self.chords {
            let (start, seconds) = (step * Self::STEP, steps * Self::STEP);
            notes.extend(keys.iter().map(|key| PhraseNote { start, seconds, key: *key, velocity: *velocity }));
            step += steps;
        }
        notes
    }
}

impl FromStr for Phrase {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let chords: Vec<Chord> = text.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
        let steps: f64 = chords.iter().map(|chord| chord.steps).sum();
        if chords.iter().all(|chord| chord.keys.is_empty()) {
            return Err("there are no notes: expected some, such as C4 E4 C4+E4+G4@110*4".to_owned());
        }
        if steps > MOST_STEPS {
            return Err(format!("{steps} steps are too many: expected at most {MOST_STEPS}"));
        }
        Ok(Self { chords })
    }
}

impl FromStr for Chord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = |what: &str| format!("‘{text}’: expected {what}");
        let (rest, steps) = text.split_once('*').unwrap_or((text, "1"));
        let (names, velocity) = rest.split_once('@').map_or((rest, None), |(names, velocity)| (names, Some(velocity)));
        let steps: f64 = steps.parse().map_err(|_| wrong("a number of steps after *"))?;
        if !(steps > 0.0 && steps <= MOST_STEPS) {
            return Err(wrong("a length above 0 and up to 64 steps"));
        }
        let velocity = velocity.map_or(Ok(VELOCITY), str::parse);
        let velocity = velocity.ok().filter(|velocity| (1..=127).contains(velocity));
        let velocity = velocity.ok_or_else(|| wrong("a velocity from 1 to 127 after @"))?;
        if names == "-" {
            return Ok(Self { keys: Vec::new(), velocity, steps });
        }
        let key = |name| key_from_note_name(name).ok_or_else(|| wrong("notes such as C4 or F#3, or - for a rest"));
        Ok(Self { keys: names.split('+').map(key).collect::<Result<_, _>>()?, velocity, steps })
    }
}

impl fmt::Display for Phrase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let chords: Vec<String> = self.chords.iter().map(Chord::to_string).collect();
        f.write_str(&chords.join(" "))
    }
}

impl fmt::Display for Chord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<String> = self.keys.iter().map(|key| note_name(*key)).collect();
        f.write_str(if names.is_empty() { "-" } else { "" })?;
        f.write_str(&names.join("+"))?;
        if self.velocity != VELOCITY {
            write!(f, "@{}", self.velocity)?;
        }
        if self.steps == 1.0 { Ok(()) } else { write!(f, "*{}", self.steps) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_follow_each_other_by_steps() {
        let phrase: Phrase = "C4@40 -  E4+G4@110*2.5 C5".parse().unwrap();
        let notes = phrase.notes().into_iter().map(|note| (note.start / Phrase::STEP, note.key, note.velocity));
        assert_eq!(notes.collect::<Vec<_>>(), [(0.0, 60, 40), (2.0, 64, 110), (2.0, 67, 110), (4.5, 72, 100)]);
        assert_eq!(phrase.to_string(), "C4@40 - E4+G4@110*2.5 C5");
        assert_eq!(phrase.to_string().parse::<Phrase>().unwrap(), phrase);
    }

    #[test]
    fn what_is_no_phrase_is_refused() {
        for text in ["", "- -", "H4", "C4@0", "C4@128", "C4*0", "C4*nan", "C4*65", "C4+", "C4 C4*64"] {
            assert!(text.parse::<Phrase>().is_err(), "{text}");
        }
    }
}
