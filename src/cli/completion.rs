//! `sprung completions`: completions for shells, whose script calls this program each time Tab is pressed.

use super::terminal::print;
use clap_complete::engine::{ValueCompleter, complete};
use clap_complete::env::{CompleteEnv, EnvCompleter, Shells};
use clap_complete::{CompletionCandidate, PathCompleter, Shell};
use sprung::internals::library::{Catalogue, Library};
use sprung::params::{PARAMS, Param};
use sprung::{Error, Result};
use std::ffi::{OsStr, OsString};
use std::io;
use std::path::Path;

pub(super) const EXAMPLES: &str = "\
Examples:
  sprung completions bash > ~/.local/share/bash-completion/completions/sprung
  sprung completions fish > ~/.config/fish/completions/sprung.fish
  sprung completions powershell >> $PROFILE";

#[derive(clap::Args)]
pub(super) struct Args {
    /// The shell to complete for
    shell: Shell,
}

/// The environment variable of a completion request. It contains the shell's name.
const VARIABLE: &str = "SPRUNG_COMPLETE";

const SHELLS: Shells<'_> = Shells(&[
    &Bash,
    &clap_complete::env::Elvish,
    &clap_complete::env::Fish,
    &clap_complete::env::Powershell,
    &clap_complete::env::Zsh,
]);

pub(super) fn run(args: &Args) -> Result<()> {
    let shell = args.shell.to_string();
    let completer = SHELLS.completer(&shell).ok_or_else(|| Error::value("shell", format!("‘{shell}’ is unknown")))?;
    let mut script = Vec::new();
    completer
        .write_registration(VARIABLE, "sprung", "sprung", "sprung", &mut script)
        .map_err(|error| Error::io("the script", error))?;
    print(&String::from_utf8_lossy(&script))
}

/// Answers a completion request of a shell's script. Returns false if there is none.
pub(super) fn answer(command: fn() -> clap::Command) -> clap::error::Result<bool> {
    let folder = std::env::current_dir().ok();
    CompleteEnv::with_factory(command).var(VARIABLE).shells(SHELLS).try_complete(std::env::args_os(), folder.as_deref())
}

/// Completes sounds of the factory and the user, ignoring case, and paths of preset files.
pub(super) fn presets(typed: &OsStr) -> Vec<CompletionCandidate> {
    let start = typed.to_string_lossy().to_lowercase();
    let sounds = Catalogue::read(Library::of_user().as_ref()).sounds;
    let named = sounds.iter().filter(|listed| listed.name().to_lowercase().starts_with(&start));
    let mut candidates: Vec<_> = named
        .map(|listed| {
            let comment = listed.playable.comment().lines().next().unwrap_or_default();
            CompletionCandidate::new(listed.name()).help(Some(comment.to_owned().into()))
        })
        .collect();
    let files = PathCompleter::file().filter(|path| path.extension().is_some_and(|ending| ending == "toml"));
    candidates.extend(files.complete(typed));
    candidates
}

/// Completes the ids of parameters.
#[cfg(feature = "play")]
pub(super) fn parameters(typed: &OsStr) -> Vec<CompletionCandidate> {
    let matching = PARAMS.iter().filter(|info| info.id.starts_with(&*typed.to_string_lossy()));
    matching.map(|info| CompletionCandidate::new(info.id).help(Some(info.help.into()))).collect()
}

/// Completes `id=` for each parameter, and `id=choice` after the name of a parameter with choices.
pub(super) fn settings(typed: &OsStr) -> Vec<CompletionCandidate> {
    let typed = typed.to_string_lossy();
    let candidates: Vec<(String, &str)> = match typed.split_once('=') {
        None => PARAMS.iter().map(|info| (format!("{}=", info.id), info.help)).collect(),
        Some((id, _)) => {
            let choices = Param::from_id(id).map_or(&[][..], |param| param.info().choices);
            choices.iter().map(|choice| (format!("{id}={choice}"), "")).collect()
        }
    };
    let matching = candidates.into_iter().filter(|(value, _)| value.starts_with(&*typed));
    matching.map(|(value, help)| CompletionCandidate::new(value).help(Some(help.to_owned().into()))).collect()
}

/// Candidates for an option that also accepts other values.
pub(super) fn among(values: &'static [&'static str]) -> clap_complete::ArgValueCandidates {
    clap_complete::ArgValueCandidates::new(|| values.iter().map(CompletionCandidate::new).collect())
}

/// Bash splits words at `=` before the request, replaces only the text after the last `=`, and inserts candidates
/// literally. clap's own adapter does not handle this: `--set mode=` and names with spaces would not be completed.
struct Bash;

const BASH_SCRIPT: &str = r#"_sprung() {
    local IFS=$'\n'
    COMPREPLY=($(SPRUNG_COMPLETE=bash SPRUNG_COMPLETE_INDEX=$COMP_CWORD sprung -- "${COMP_WORDS[@]}" 2>/dev/null))
    if [[ ${COMPREPLY-} == *[=/] ]]; then
        compopt -o nospace 2>/dev/null
    fi
}
complete -o bashdefault -o nosort -F _sprung sprung 2>/dev/null || complete -o bashdefault -F _sprung sprung
"#;

impl EnvCompleter for Bash {
    fn name(&self) -> &'static str {
        "bash"
    }

    fn is(&self, name: &str) -> bool {
        name == "bash"
    }

    fn write_registration(&self, _: &str, _: &str, _: &str, _: &str, out: &mut dyn io::Write) -> io::Result<()> {
        out.write_all(BASH_SCRIPT.as_bytes())
    }

    fn write_complete(
        &self,
        command: &mut clap::Command,
        words: Vec<OsString>,
        folder: Option<&Path>,
        out: &mut dyn io::Write,
    ) -> io::Result<()> {
        let index = std::env::var("SPRUNG_COMPLETE_INDEX").ok().and_then(|index| index.parse().ok()).unwrap_or(0);
        let words: Vec<String> = words.iter().map(|word| word.to_string_lossy().into_owned()).collect();
        let (whole, kept) = joined(&words, index);
        let at = whole.len() - 1;
        // Inside a quotation that is still open, the candidate is inserted literally.
        let is_quoted = words.get(index).is_some_and(|word| word.starts_with(['"', '\'']));
        for candidate in complete(command, whole.into_iter().map(OsString::from).collect(), at, folder)? {
            let value = candidate.get_value().to_string_lossy();
            let rest = value.get(kept..).unwrap_or_default();
            writeln!(out, "{}", if is_quoted { rest.to_owned() } else { quoted(rest) })?;
        }
        Ok(())
    }
}

/// The words up to `index`, joined again at `=` and without quotes, and the number of bytes of the last word that bash
/// keeps.
fn joined(words: &[String], index: usize) -> (Vec<String>, usize) {
    let (mut whole, mut kept, mut after_equals) = (vec![String::new()], 0, false);
    for (n, word) in words.iter().take(index + 1).enumerate() {
        let is_equals = word == "=";
        if n > 0 && !is_equals && !after_equals {
            whole.push(String::new());
        }
        if let Some(last) = whole.last_mut() {
            kept = last.len() + usize::from(is_equals);
            last.push_str(&unquoted(word));
        }
        after_equals = is_equals;
    }
    (whole, kept)
}

fn unquoted(word: &str) -> String {
    let mut characters = word.chars();
    let mut plain = String::new();
    while let Some(character) = characters.next() {
        match character {
            '\\' => plain.extend(characters.next()),
            '"' | '\'' => {}
            other => plain.push(other),
        }
    }
    plain
}

fn quoted(value: &str) -> String {
    let mut quoted = String::new();
    for character in value.chars() {
        if character.is_ascii() && !character.is_ascii_alphanumeric() && !"-_./=,:+@%~".contains(character) {
            quoted.push('\\');
        }
        quoted.push(character);
    }
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_joined_and_quoted_as_bash_does() {
        let words = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect::<Vec<_>>();
        for (typed, index, expected, kept) in [
            (&["s", "--set", "mode", "=", "mo"][..], 4, &["s", "--set", "mode=mo"][..], 5),
            (&["s", "--set", "mode", "="], 3, &["s", "--set", "mode="], 5),
            (&["s", "--set", "a", "=", "1", "--set", "b"], 6, &["s", "--set", "a=1", "--set", "b"], 0),
            (&["s", "--set", "a", "=", "--json"], 2, &["s", "--set", "a"], 0),
            (&["s", "--preset", "Church\\ B", "--json"], 2, &["s", "--preset", "Church B"], 0),
            (&["s", "--set", "\"a=b"], 2, &["s", "--set", "a=b"], 0),
            (&["s", "--preset", "=", "\"Church B"], 3, &["s", "--preset=Church B"], 9),
            (&["s", ""], 1, &["s", ""], 0),
        ] {
            assert_eq!(joined(&words(typed), index), (words(expected), kept), "{typed:?}");
        }
        assert_eq!(quoted("Church Bell's"), "Church\\ Bell\\'s");
        assert_eq!(unquoted(&quoted("a b'c\"d\\e$f")), "a b'cd\\e$f".replace("cd", "c\"d"));
    }
}
