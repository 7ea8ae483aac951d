//! Completion in a real bash: checks what it offers when Tab is pressed.

use crate::{Sandbox, exists};
use sprung::params::PARAMS;
use sprung::preset::Preset;
use std::process::Command;

/// Loads the script in an interactive bash, types `line` and a tab, and returns the resulting line.
fn typed(sandbox: &Sandbox, line: &str) -> String {
    let program = assert_cmd::cargo::cargo_bin!("sprung");
    let folder = program.parent().unwrap().display();
    // Binds a key to a function that writes the line to a file.
    let rc = format!(
        "PATH={folder}:$PATH\nsource <(sprung completions bash)\nbind 'set bell-style none'\n\
         show() {{ printf '%s' \"$READLINE_LINE\" > line; exit; }}\nbind -x '\"\\C-x\": show'\n"
    );
    sandbox.write("rc", rc);
    let input = sandbox.write("keys", format!("{line}\t\x18"));
    // `script` gives bash a terminal, without which readline does not run.
    let status = Command::new("script")
        .args(["-qec", "bash --noprofile --rcfile rc -i", "/dev/null"])
        .current_dir(sandbox.path("."))
        .env("TERM", "dumb")
        .stdin(std::fs::File::open(input).unwrap())
        .output()
        .unwrap();
    std::fs::read_to_string(sandbox.path("line")).unwrap_or_else(|error| panic!("{line}: {error}: {status:?}"))
}

#[test]
fn tab_completes_presets_parameters_and_choices() {
    if !exists("/bin/bash") || Command::new("script").arg("--version").output().is_err() {
        println!("ignored: needs bash and script (util-linux)");
        return;
    }
    let sandbox = Sandbox::new();
    sandbox.write("mine.toml", "");
    for (line, expected) in [
        ("sprung ren", "sprung render "),
        ("sprung render --pres", "sprung render --preset "),
        ("sprung render --preset Floor", "sprung render --preset Floor\\ Tom "),
        ("sprung render --preset floor", "sprung render --preset Floor\\ Tom "),
        ("sprung render --preset Floor\\ T", "sprung render --preset Floor\\ Tom "),
        ("sprung render --preset \"Floor T", "sprung render --preset \"Floor Tom\" "),
        ("sprung render --preset=Glocken", "sprung render --preset=Glockenspiel "),
        ("sprung render --preset min", "sprung render --preset mine.toml "),
        ("sprung presets show Floor", "sprung presets show Floor\\ Tom "),
        ("sprung render --set note_o", "sprung render --set note_off="),
        ("sprung render --set note_off=ri", "sprung render --set note_off=ring "),
        ("sprung render --set=note_off=ri", "sprung render --set=note_off=ring "),
        ("sprung render --note C4 --set mode=leg", "sprung render --note C4 --set mode=legato "),
        ("sprung render --normalize pe", "sprung render --normalize peak="),
        ("sprung render --bits 32", "sprung render --bits 32f "),
        ("sprung lab pitch --methods synth-exact,verl", "sprung lab pitch --methods synth-exact,verlet "),
        ("sprung render min", "sprung render mine.toml "),
    ] {
        assert_eq!(typed(&sandbox, line), expected);
    }
}

/// The completions that the program gives to bash's script for the last of these words.
fn offered(words: &[&str]) -> Vec<String> {
    let output = Command::new(assert_cmd::cargo::cargo_bin!("sprung"))
        .env("SPRUNG_COMPLETE", "bash")
        .env("SPRUNG_COMPLETE_INDEX", words.len().to_string())
        .args(["--", "sprung"])
        .args(words)
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
}

#[test]
fn everything_that_there_is_is_offered() {
    let presets = offered(&["render", "--preset", ""]);
    let missing = |name: &&str| !presets.contains(&name.replace(' ', "\\ ").replace('\'', "\\'"));
    let missing: Vec<&str> = Preset::factory().iter().map(|preset| preset.name.as_str()).filter(missing).collect();
    assert!(missing.is_empty(), "{missing:?} not in {presets:?}");
    assert_eq!(
        offered(&["render", "--set", ""]),
        PARAMS.iter().map(|info| format!("{}=", info.id)).collect::<Vec<_>>()
    );
    for info in PARAMS.iter().filter(|info| !info.choices.is_empty()) {
        assert_eq!(offered(&["render", "--set", info.id, "="]), info.choices);
    }
    assert!(offered(&["render", "--set", "decay", "="]).is_empty());
}
