//! Reads the song that a command plays, and warns if its program changes conflict with `--preset` and `--channel`.

use super::terminal::{complain, counted};
use sprung::Result;
use sprung::engine::EventKind;
use sprung::io::{Inputs, Song};
use sprung::sound::Kit;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// Maximum number of repairs that are reported one by one.
const MOST_REPAIRS: usize = 10;

/// How a song is read and played.
#[derive(clap::Args)]
pub(super) struct SongArgs {
    /// Repair a MIDI file that strays from the standard, and say how
    #[arg(long, requires = "song")]
    lenient: bool,
    /// Leave program changes out: everything plays on --preset and --channel
    #[arg(long)]
    ignore_programs: bool,
}

impl SongArgs {
    /// Reads the song; `-` is stdin.
    pub(super) fn read(&self, path: &Path, inputs: &mut Inputs) -> Result<Song> {
        if path == Path::new("-") {
            return self.parse(inputs.stdin()?.lock(), "stdin");
        }
        self.parse(inputs.open(path)?, &path.display().to_string())
    }

    fn parse(&self, reader: impl std::io::Read, origin: &str) -> Result<Song> {
        if !self.lenient {
            return Song::read(reader, origin);
        }
        let (song, repairs) = Song::read_leniently(reader, origin)?;
        for repair in repairs.iter().take(MOST_REPAIRS) {
            complain("warning", format_args!("{origin}: {repair}"));
        }
        if repairs.len() > MOST_REPAIRS {
            complain("warning", format_args!("{origin}: {} repairs more", repairs.len() - MOST_REPAIRS));
        }
        Ok(song)
    }

    /// The kits that program changes select.
    pub(super) fn programs<'a>(&self, programs: &'a [Arc<Kit>]) -> &'a [Arc<Kit>] {
        if self.ignore_programs { &[] } else { programs }
    }

    /// Warns of program changes without a preset, and of notes that do not play with the kit that the user `asked` for.
    pub(super) fn warn_of_programs(&self, song: &Song, asked: [Option<&Arc<Kit>>; 16], programs: &[Arc<Kit>]) {
        if self.ignore_programs {
            return;
        }
        warn_of_missing_programs(song, programs.len());
        let Elsewhere { channels, notes, all } = Elsewhere::count(song, asked, programs);
        if notes > 0 {
            let (all, them) = (counted(all, "note"), counted(channels.len(), "channel"));
            let verb = if notes == 1 { "does" } else { "do" };
            let all_alike = asked.iter().all(|kit| *kit == asked[0]);
            let given = if all_alike { "--preset" } else { "--preset or --channel" };
            complain(
                "warning",
                format_args!(
                    "{notes} of {all}, on {them}, {verb} not play on {given} because of program changes; \
                     --ignore-programs plays them on it"
                ),
            );
        }
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

fn warn_of_missing_programs(song: &Song, programs: usize) {
    let missing: BTreeSet<(u8, u8)> = song
        .events
        .iter()
        .filter_map(|event| match event.kind {
            EventKind::Program(number) if usize::from(number) >= programs => Some((event.channel, number)),
            _ => None,
        })
        .collect();
    for (channel, number) in missing {
        complain(
            "warning",
            format_args!(
                "channel {}: there is no program {number} (the presets are 0 to {}); the channel keeps its preset",
                channel + 1,
                programs - 1
            ),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprung::io::SongEvent;
    use sprung::params::Param;
    use sprung::patch::Patch;

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
