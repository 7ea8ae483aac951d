//! `sprung presets list`: the factory's sounds as lines of text or as JSON, and the programs of General MIDI.

use super::select::Select;
use serde_json::{Value, json};
use sprung::internals::library::Listed;
use sprung::preset::{Guide, Playable, Programs};
use sprung::units::note_name;
use std::fmt::Write;
use std::sync::Arc;
use terminal_size::{Width, terminal_size_of};

/// Smallest width of a terminal, in characters, for which lines are wrapped.
const NARROWEST: usize = 40;

#[derive(clap::Args)]
pub(super) struct Args {
    #[command(flatten)]
    select: Select,
    /// List what the programs of General MIDI play
    #[arg(long)]
    gm: bool,
    /// Print JSON: name, family, tags, programs, keys, macros, description
    #[arg(long)]
    json: bool,
}

/// The output of the command.
pub(super) fn list(args: &Args) -> String {
    let found = args.select.found();
    let width = terminal_size_of(std::io::stdout()).map(|(Width(width), _)| usize::from(width));
    match (args.json, args.gm) {
        (true, _) => format!("{:#}\n", Value::Array(found.iter().map(|one| described(one)).collect())),
        (false, true) => programs(&found),
        (false, false) => lines(&found, width.filter(|width| *width >= NARROWEST)),
    }
}

/// The numbers, from 1, of the programs of General MIDI that a sound plays.
fn numbers(name: &str) -> Vec<u8> {
    let programs = Programs::general_midi();
    (0..128).filter(|number| programs.sound(*number) == Some(name)).map(|number| number + 1).collect()
}

fn described(found: &Listed) -> Value {
    let playable = &found.playable;
    let mut described = json!({
        "name": playable.name(),
        "kit": matches!(playable, Playable::Kit(_)),
        "family": found.family_name(),
        "tags": found.tags(),
        "author": playable.author(),
        "comment": playable.comment(),
        "details": playable.details(),
        // A sound of the user's may have the name of a factory sound.
        "programs": if found.path.is_none() { numbers(playable.name()) } else { Vec::new() },
        "file": found.path.as_ref().map(|path| path.display().to_string()),
    });
    match playable {
        Playable::Preset(preset) => {
            let Guide { lowest, highest, home, macros, phrase, .. } = &preset.guide;
            described["range"] = json!({ "lowest": lowest, "highest": highest, "home": home });
            described["macros"] = json!(macros);
            described["phrase"] = json!(phrase.as_ref().map(ToString::to_string));
        }
        Playable::Kit(kit) => {
            let pads = kit.pads.iter().map(|(key, pad)| json!({ "key": key, "name": pad.name }));
            described["pads"] = Value::Array(pads.collect());
        }
    }
    described
}

/// Lines with name, family, keys and description. With a terminal's width, long descriptions are wrapped and indented.
fn lines(found: &[Arc<Listed>], width: Option<usize>) -> String {
    let longest = |text: fn(&Listed) -> &str| found.iter().map(|one| text(one).chars().count()).max().unwrap_or(0);
    let (names, families) = (longest(Listed::name), longest(Listed::family_name));
    let mut out = String::new();
    for one in found {
        let keys = match &one.playable {
            Playable::Preset(preset) => {
                format!("{}-{}", note_name(preset.guide.lowest), note_name(preset.guide.highest))
            }
            Playable::Kit(_) => String::new(),
        };
        let head = format!("{:names$}  {:families$}  {keys:7}  ", one.name(), one.family_name());
        let comment = one.playable.comment().lines().next().unwrap_or_default();
        let indent = head.chars().count();
        let rows = match width {
            Some(width) if width > indent + 20 => wrapped(comment, width - indent),
            Some(width) => vec![comment.chars().take(width.saturating_sub(indent)).collect()],
            None => vec![comment.to_owned()],
        };
        for (row, text) in rows.iter().enumerate() {
            let _ = writeln!(
                out,
                "{}",
                format!("{}{text}", if row == 0 { head.clone() } else { " ".repeat(indent) }).trim_end()
            );
        }
    }
    out
}

/// Wraps text to rows of at most `width` characters, broken between words. A longer word gets a row of its own.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut rows = vec![String::new()];
    for word in text.split_whitespace() {
        let row = rows.last_mut().expect("there is a row");
        if row.is_empty() {
            row.push_str(word);
        } else if row.chars().count() + 1 + word.chars().count() <= width {
            row.push(' ');
            row.push_str(word);
        } else {
            rows.push(word.to_owned());
        }
    }
    rows
}

/// The programs of General MIDI whose sounds are among those found.
fn programs(found: &[Arc<Listed>]) -> String {
    let programs = Programs::general_midi();
    let family = |name: &str| found.iter().find(|one| one.name() == name).map(|one| one.family_name());
    let mut out = String::new();
    for number in 0..128 {
        if let Some((name, family)) = programs.sound(number).and_then(|name| Some((name, family(name)?))) {
            let _ = writeln!(out, "{:3}  {name:24}{family}", number + 1);
        }
    }
    let mut before = None;
    for number in 0..128 {
        let kit = programs.drums(number).filter(|name| family(name).is_some());
        if kit != before && kit.is_some_and(|kit| number == 0 || Some(kit) != programs.drums(0)) {
            let _ = writeln!(out, "{:3}  {:24}channel 10", number + 1, kit.unwrap_or_default());
        }
        before = kit;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Command {
        #[command(flatten)]
        args: Args,
    }

    fn args(line: &str) -> Args {
        Command::parse_from(["list"].into_iter().chain(line.split_whitespace())).args
    }

    #[test]
    fn sounds_are_found_by_family_tag_and_words() {
        let names = |line: &str| args(line).select.found().iter().map(|one| one.name().to_owned()).collect::<Vec<_>>();
        assert!(names("").len() > 100);
        assert!(
            names("--family mallet").contains(&"Marimba".to_owned())
                && !names("--family mallet").contains(&"Kick".to_owned())
        );
        assert!(
            names("--search MARIMBA").contains(&"Marimba".to_owned())
                && !names("--search marimba").contains(&"Kick".to_owned())
        );
        assert!(names("--tag nothing").is_empty());
        let json: Value = serde_json::from_str(&list(&args("--search marimba --json"))).unwrap();
        let marimba = json.as_array().unwrap().iter().find(|one| one["name"] == "Marimba").unwrap();
        assert_eq!((marimba["programs"][0].as_u64(), marimba["kit"].as_bool()), (Some(13), Some(false)));
    }

    #[test]
    fn a_line_is_one_without_a_terminal_and_wrapped_in_one() {
        let found = args("").select.found();
        assert_eq!(lines(&found, None).lines().count(), found.len());
        for width in [60, 100, 200] {
            let wide = lines(&found, Some(width));
            assert!(wide.lines().all(|line| line.chars().count() <= width), "{width}");
        }
        assert_eq!(wrapped("a bb  ccc d", 4), ["a bb", "ccc", "d"]);
    }

    #[test]
    fn general_midi_has_128_programs_and_its_kits() {
        let listed = list(&args("--gm"));
        assert!(listed.lines().count() > 128 && listed.contains(" 13  Marimba"), "{listed}");
        assert!(listed.lines().nth(128).is_some_and(|line| line.starts_with("  1  ") && line.ends_with("channel 10")));
    }
}
