//! The sounds that MIDI program changes select, and warnings if they differ from the requested ones.

use super::playable::playable;
use crate::engine::EventKind;
use crate::engine::banks::MELODIC;
use crate::error::{Error, Result};
use crate::io::{Inputs, Song};
use crate::preset::{Playable, Programs, is_file_name};
use crate::sound::Kit;
use crate::text::counted;
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

/// Largest list of programs that is read, in bytes.
const MAX_FILE_SIZE: u64 = 1 << 20;

/// The list of programs with a name: `gm`, `none` or a file. None if program changes select nothing.
pub(super) fn list(name: &OsStr, inputs: &mut Inputs) -> Result<Option<Programs>> {
    let path = Path::new(name);
    match name.to_str() {
        Some("gm") => Ok(Some(Programs::general_midi().clone())),
        Some("none") => Ok(None),
        _ if is_file_name(path) => {
            let (origin, mut text) = (path.display().to_string(), String::new());
            let read = inputs.open(path)?.take(MAX_FILE_SIZE + 1).read_to_string(&mut text);
            read.map_err(|source| Error::io(&origin, source))?;
            if text.len() as u64 > MAX_FILE_SIZE {
                return Err(Error::format(origin, "too large for a list of programs: expected at most 1 MiB of TOML"));
            }
            Programs::parse(&text, &origin).map(Some)
        }
        _ => {
            let message = format!("expected gm, none or a file ending in .toml, found ‘{}’", path.display());
            Err(Error::value("--programs", message))
        }
    }
}

/// The programs that a song selects.
pub(super) fn used(song: &Song) -> BTreeSet<u8> {
    let programs = song.events.iter().filter_map(|event| match event.kind {
        EventKind::Program(number) => Some(number),
        _ => None,
    });
    programs.collect()
}

/// The kits of all `wanted` programs of a list that have a sound. `kit` makes a kit from a loaded sound.
pub(super) fn kits(
    programs: &Programs,
    wanted: impl Fn(u8) -> bool,
    kit: impl Fn(Playable) -> Arc<Kit>,
    inputs: &mut Inputs,
) -> Result<Vec<Option<Arc<Kit>>>> {
    let load = |name: &str| {
        let loaded = playable(OsStr::new(name), inputs);
        loaded.map(&kit).map_err(|error| Error::value(&programs.name, error.to_string()))
    };
    programs.kits(wanted, load)
}

/// The number of a program as shown to the user: counted from 1.
fn program(number: u8) -> String {
    match number.checked_sub(MELODIC) {
        None => format!("{}", number + 1),
        Some(drums) => format!("{} of the drums", drums + 1),
    }
}

/// Warns of program changes of a song for which a list has no sound.
pub(super) fn warn_of_missing(song: &Song, programs: &Programs, instead: &str, warn: &mut dyn FnMut(&str)) {
    for number in used(song).into_iter().filter(|number| programs.name_of(*number).is_none()) {
        let list = &programs.name;
        warn(&format!("program {}: ‘{list}’ has no sound for it; it plays {instead}", program(number)));
    }
}

/// Warns of notes that program changes take away from the kit that the user `asked` for.
pub(super) fn warn_of_changes(
    song: &Song,
    asked: [Option<&Arc<Kit>>; 16],
    programs: &[Arc<Kit>],
    warn: &mut dyn FnMut(&str),
) {
    let Elsewhere { channels, notes, all } = Elsewhere::count(song, asked, programs);
    if notes > 0 {
        let (all, them) = (counted(all, "note"), counted(channels.len(), "channel"));
        let verb = if notes == 1 { "does" } else { "do" };
        let all_alike = asked.iter().all(|kit| *kit == asked[0]);
        let given = if all_alike { "--preset" } else { "--preset or --channel" };
        warn(&format!(
            "{notes} of {all}, on {them}, {verb} not play on {given} because of program changes; \
             --programs none plays them on it"
        ));
    }
}

/// Notes that do not play with the kit that the user asked for.
#[derive(Debug, Default, PartialEq)]
struct Elsewhere {
    channels: BTreeSet<u8>,
    notes: usize,
    /// Number of notes in the song.
    all: usize,
}

impl Elsewhere {
    fn count(song: &Song, asked: [Option<&Arc<Kit>>; 16], programs: &[Arc<Kit>]) -> Self {
        let mut count = Self::default();
        let mut changed = BTreeSet::new();
        for event in &song.events {
            let asked = asked.get(usize::from(event.channel)).copied().flatten();
            match event.kind {
                EventKind::Program(number) => match programs.get(usize::from(number)) {
                    Some(kit) if asked.is_some_and(|asked| asked != kit) => drop(changed.insert(event.channel)),
                    Some(_) => drop(changed.remove(&event.channel)),
                    None => {}
                },
                EventKind::NoteOn { .. } => {
                    count.all += 1;
                    if changed.contains(&event.channel) {
                        count.notes += 1;
                        count.channels.insert(event.channel);
                    }
                }
                _ => {}
            }
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::SongEvent;
    use crate::params::Param;
    use crate::patch::Patch;

    #[test]
    fn notes_are_counted_from_the_program_change_on_that_leaves_the_preset() {
        let [preset, other] = [0.0, -3.0].map(|gain| Kit::of_patch(&Patch::default().with(Param::Gain, gain)));
        let note = EventKind::NoteOn { key: 60, detune: 0.0, velocity: 1.0, id: None };
        let program = EventKind::Program;
        let events = [
            (0, note),
            (1, program(1)),
            (1, note),
            (0, note),
            (1, note),
            (1, program(9)),
            (1, note),
            (1, program(0)),
            (1, note),
            (3, program(1)),
            (4, program(1)),
            (4, note),
        ];
        let song = |events: &[(u8, EventKind)]| Song {
            events: events
                .iter()
                .map(|(channel, kind)| SongEvent { seconds: 0.0, channel: *channel, kind: *kind })
                .collect(),
            seconds: 0.0,
        };
        let mut asked = [Some(&preset); 16];
        let programs = [preset.clone(), other.clone()];
        let count = Elsewhere::count(&song(&events), asked, &programs);
        assert_eq!(count, Elsewhere { channels: [1, 4].into(), notes: 4, all: 7 });
        assert_eq!(Elsewhere::count(&song(&events), asked, &[]), Elsewhere { all: 7, ..Elsewhere::default() });
        asked[1] = None;
        asked[4] = Some(&other);
        assert_eq!(Elsewhere::count(&song(&events), asked, &programs), Elsewhere { all: 7, ..Elsewhere::default() });
    }
}
