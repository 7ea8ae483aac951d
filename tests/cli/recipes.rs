//! The recipes of the manual: their files and commands, from top to bottom in an empty folder.

use crate::{Sandbox, end, note_on, song};
use std::ffi::OsString;
use std::process::Command;

/// The blocks of a page of Markdown: the text after the opening fence, and the lines of the block.
fn blocks(page: &str) -> Vec<(&str, String)> {
    let mut blocks: Vec<(&str, String)> = Vec::new();
    let mut is_inside = false;
    for line in page.lines() {
        match line.strip_prefix("```") {
            Some(_) if is_inside => is_inside = false,
            Some(info) => {
                is_inside = true;
                blocks.push((info, String::new()));
            }
            None if is_inside => blocks.last_mut().unwrap().1.push_str(&format!("{line}\n")),
            None => {}
        }
    }
    blocks
}

/// The PATH with the command under test in front.
fn path_with_sprung() -> OsString {
    let command = assert_cmd::cargo::cargo_bin!("sprung");
    let own = command.parent().unwrap().to_owned();
    let others = std::env::var_os("PATH").unwrap_or_default();
    std::env::join_paths([own].into_iter().chain(std::env::split_paths(&others))).unwrap()
}

#[test]
fn every_recipe_runs_as_printed() {
    let sandbox = Sandbox::new();
    // The MIDI file of one's own that a recipe asks for.
    sandbox.write("song.mid", song(&[note_on(0, 0, 60), note_on(0, 1, 67), note_on(0, 9, 38), end(240)]));
    let (mut files, mut commands) = (0, 0);
    for (info, text) in blocks(include_str!("../../assets/manual/recipes.md")) {
        match info.split_once(' ') {
            Some((_, name)) => {
                sandbox.write(name, &text);
                files += 1;
            }
            None if info == "console" => {
                for line in text.lines() {
                    let mut shell = Command::new("sh");
                    shell.args(["-c", line]).current_dir(sandbox.path("")).env("PATH", path_with_sprung());
                    let output = shell.output().unwrap();
                    let said = String::from_utf8_lossy(&output.stderr);
                    let is_clean = !["warning: ", "note: "].iter().any(|word| said.contains(word));
                    assert!(output.status.success() && is_clean, "{line}: {said}");
                    commands += 1;
                }
            }
            None => panic!("a block of ‘{info}’: expected a file with a name, or commands"),
        }
    }
    assert!(files >= 8 && commands >= 10, "{files} files, {commands} commands");
}
