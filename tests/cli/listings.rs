//! Listings of the command: presets, parameters, manual pages, completion scripts.

use crate::Sandbox;
use sprung::internals::library::Library;
use sprung::params::{PARAMS, Unit};
use sprung::preset::{KitPreset, Playable, Preset};
use std::process::{Command, Stdio};

/// The rows of the manual's tables of parameters: the page, the parameter's id, and the cell with its range and default.
fn rows_of_the_manual() -> Vec<(String, String, String)> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/manual");
    let mut rows = Vec::new();
    for page in std::fs::read_dir(folder).unwrap() {
        let path = page.unwrap().path();
        let (text, page) = (std::fs::read_to_string(&path).unwrap(), path.display().to_string());
        let mut prefix = None;
        for line in text.lines() {
            let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
            let (first, last) = (cells[0], cells[cells.len() - 1]);
            match prefix {
                _ if !line.starts_with('|') => prefix = None,
                // The ids of several sections differ by a prefix, which the head then has.
                None if last == "range, default" => prefix = Some(first.split('`').nth(1).unwrap_or("")),
                Some(prefix) if !line.starts_with("|--") => {
                    let id = first.strip_prefix('`').and_then(|id| id.strip_suffix('`'));
                    let id = id.unwrap_or_else(|| panic!("{page}: expected one parameter: {line}"));
                    rows.push((page.clone(), format!("{prefix}{id}"), last.to_owned()));
                }
                _ => {}
            }
        }
    }
    rows
}

#[test]
fn the_manual_has_the_ranges_and_defaults_of_the_parameters() {
    let rows = rows_of_the_manual();
    assert!(rows.len() > 80, "{}", rows.len());
    for (page, id, cell) in rows {
        let info = PARAMS.iter().find(|info| info.id == id).unwrap_or_else(|| panic!("{page}: there is no {id}"));
        let parse =
            |text: &str| info.parse(&text.replace('−', "-")).unwrap_or_else(|error| panic!("{page}: {id}: {error}"));
        // After a semicolon follows advice.
        let facts = cell.split(';').next().unwrap();
        if info.unit == Unit::Choice {
            assert_eq!(parse(facts.trim_matches('`')), info.default, "{page}: {id}: {cell}");
            continue;
        }
        let (range, default) = facts.rsplit_once(", ").unwrap_or_else(|| panic!("{page}: {id}: {cell}"));
        let [low, high] = match (range.strip_prefix('±'), range.split_once(" to ")) {
            (Some(most), _) => [format!("−{most}"), most.to_owned()],
            // Both have the unit of the last.
            (None, Some((low, high))) if !low.contains(' ') => {
                [format!("{low} {}", high.split_once(' ').map_or("", |(_, unit)| unit)), high.to_owned()]
            }
            (None, Some((low, high))) => [low.to_owned(), high.to_owned()],
            (None, None) => panic!("{page}: {id}: {cell}"),
        };
        let told = [&*low, &*high, default].map(parse);
        assert_eq!(told, [info.min, info.max, info.default], "{page}: {id}: {cell}");
    }
}

#[test]
fn presets_are_listed_shown_and_checked() {
    let sandbox = Sandbox::new();
    let list = String::from_utf8(sandbox.succeeds("presets list")).unwrap();
    assert_eq!(list.lines().count(), Preset::factory().len() + KitPreset::factory().len());
    assert!(list.lines().any(|line| line.starts_with("Kick ")), "{list}");
    let programs = String::from_utf8(sandbox.succeeds("presets list --gm")).unwrap();
    assert!(programs.contains("\n 13  Marimba"), "{programs}");
    let found: serde_json::Value =
        serde_json::from_slice(&sandbox.succeeds("presets list --family kit --json")).unwrap();
    assert_eq!(found.as_array().unwrap().len(), KitPreset::factory().len());

    let kick = String::from_utf8(sandbox.succeeds("presets show kick")).unwrap();
    assert_eq!(&Preset::parse(&kick, "kick").unwrap(), Preset::find("Kick").unwrap());
    sandbox.write("kick.toml", &kick);
    assert_eq!(sandbox.succeeds("presets show kick.toml"), kick.as_bytes());

    sandbox.write("bad.toml", "format = 1\nname = \"a\"\ncolour = 1");
    sandbox.write("worse.toml", "format = 9");
    let stdout = sandbox.succeeds("presets check kick.toml");
    assert_eq!(String::from_utf8(stdout).unwrap(), "kick.toml: ‘Kick’ is in order\n");
    let output = sandbox.sprung("presets check bad.toml kick.toml worse.toml none.toml").assert().code(1);
    let stderr = String::from_utf8(output.get_output().stderr.clone()).unwrap();
    for message in ["bad.toml: unknown key ‘colour’", "worse.toml: format 9", "none.toml: ", "3 of 4 cannot be used"]
    {
        assert!(stderr.contains(message), "{message}: {stderr}");
    }
    sandbox.fails("presets check", 2, "<FILE>");
}

#[test]
fn sounds_of_the_user_have_names_too() {
    let sandbox = Sandbox::new();
    assert_eq!(sandbox.succeeds("presets list --own"), b"");
    sandbox.fails("render --note C4 --preset MyKick -o a.wav", 1, "there is no factory preset or kit ‘MyKick’");
    let mine = Preset { name: "MyKick".to_owned(), ..Preset::find("Kick").unwrap().clone() };
    // Where each system keeps a program's data.
    let folder = match std::env::consts::OS {
        "windows" => "data/Sprung",
        "macos" => "data/Library/Application Support/Sprung",
        _ => "data/sprung",
    };
    let library = Library::at(sandbox.path(folder));
    library.save(&Playable::Preset(mine.clone()), false).unwrap();
    std::fs::write(library.presets_folder().join("broken.toml"), "x").unwrap();
    let output = sandbox.sprung("presets list --own --json").assert().success().get_output().clone();
    let listed: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((listed[0]["name"].as_str(), listed[0]["programs"].as_array().map(Vec::len)), (Some("MyKick"), Some(0)));
    assert!(String::from_utf8(output.stderr).unwrap().contains("broken.toml"));
    let shown = String::from_utf8(sandbox.succeeds("presets show mykick")).unwrap();
    assert_eq!(Preset::parse(&shown, "shown").unwrap(), mine);
    sandbox.succeeds("render --note C4 --preset MyKick -o a.wav");
    sandbox.succeeds("render --note C4 --preset Kick -o b.wav");
    assert_eq!(sandbox.read("a.wav"), sandbox.read("b.wav"));
    // The preset's file is an input, so no output may replace it.
    let mut replace = sandbox.sprung("render --note C4 --preset MyKick --force -o");
    let output = replace.arg(library.presets_folder().join("mykick.toml")).assert().code(1).get_output().clone();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("mykick.toml: this is the input"), "{told}");
}

#[test]
fn kits_are_shown_and_checked() {
    let sandbox = Sandbox::new();
    sandbox.write("kit.toml", "kit = 1\nname = \"K\"\nkeys = [{ key = 36, sound = \"Kick\", pitch = 60 }]");
    assert_eq!(sandbox.succeeds("presets check kit.toml"), "kit.toml: ‘K’ is in order\n".as_bytes());
    let shown = String::from_utf8(sandbox.succeeds("presets show kit.toml")).unwrap();
    assert!(shown.ends_with("[[keys]]\nkey = \"C2\"\nsound = \"Kick\"\npitch = \"C4\"\n"), "{shown}");
    sandbox.write("shown.toml", &shown);
    assert_eq!(sandbox.succeeds("presets show shown.toml"), shown.as_bytes());
    sandbox.write("bad.toml", "kit = 1\nname = \"K\"\nkeys = [{ key = 36, sound = \"../kick.toml\" }]");
    sandbox.fails(
        "presets show bad.toml",
        1,
        "bad.toml: keys[0].sound: ../kick.toml: it lies outside the kit’s folder",
    );
}

#[test]
fn parameters_are_listed_in_every_form() {
    let sandbox = Sandbox::new();
    let json: serde_json::Value = serde_json::from_slice(&sandbox.succeeds("params --json")).unwrap();
    let ids: Vec<&str> = json.as_array().unwrap().iter().map(|row| row["id"].as_str().unwrap()).collect();
    assert_eq!(ids, PARAMS.iter().map(|info| info.id).collect::<Vec<_>>());
    for args in ["params", "params --markdown"] {
        let text = String::from_utf8(sandbox.succeeds(args)).unwrap();
        assert!(PARAMS.iter().all(|info| text.contains(info.id) && text.contains(info.help)), "{text}");
    }
    sandbox.fails("params --json --markdown", 2, "cannot be used with");
}

#[test]
fn manual_and_completions_are_written() {
    let sandbox = Sandbox::new();
    assert!(sandbox.succeeds("man").starts_with(b".ie"));
    sandbox.succeeds("man pages/man1");
    let pages: Vec<_> = std::fs::read_dir(sandbox.path("pages/man1")).unwrap().collect();
    assert!(pages.len() > 5 && sandbox.path("pages/man1/sprung-render.1").exists());
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = String::from_utf8(sandbox.succeeds(&format!("completions {shell}"))).unwrap();
        assert!(script.contains("SPRUNG_COMPLETE"), "{shell}");
    }
    sandbox.fails("man pages/man1", 1, "sprung.1: the file exists; add --force to overwrite it");
    sandbox.write("pages/man1/sprung-render.1", "old");
    std::fs::remove_file(sandbox.path("pages/man1/sprung.1")).unwrap();
    sandbox.fails("man pages/man1", 1, "sprung-render.1: the file exists; add --force to overwrite it");
    assert!(!sandbox.path("pages/man1/sprung.1").exists(), "all pages or none");
    sandbox.succeeds("man --force pages/man1");
    assert!(sandbox.read("pages/man1/sprung-render.1").starts_with(b".ie"));
    sandbox.write("file", "");
    sandbox.fails("man file", 1, "file: ");
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    for args in ["presets list", "params", "params --json", "completions bash", "man", "--help"] {
        let mut child = Command::new(assert_cmd::cargo::cargo_bin!("sprung"))
            .args(args.split_whitespace())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{args}: {:?}", output.status);
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{args}");
    }
}

/// Only on Linux: other systems have no `/dev/full`.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_stdout_is_an_error() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let commands =
        ["presets list", "presets show Kick", "params --json", "man", "completions bash", "render --note C2 -o -"];
    for args in commands.into_iter().chain(["--help", "render --help", "--version", "help lab"]) {
        let output = Command::new(assert_cmd::cargo::cargo_bin!("sprung"))
            .args(args.split_whitespace())
            .stdout(full.try_clone().unwrap())
            .output()
            .unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{args}");
        assert_eq!(stderr, "sprung: error: stdout: No space left on device (os error 28)\n", "{args}");
    }
}

#[test]
fn an_audition_plays_shows_and_measures_what_is_meant() {
    let sandbox = Sandbox::new();
    let audition = "presets audition --family kick --search wooden --out page";
    sandbox.succeeds(audition);
    let page = String::from_utf8(sandbox.read("page/index.html")).unwrap();
    assert!(page.contains("<h2>Click Kick</h2>") && page.contains("attack flatness"), "{page}");
    assert!(sandbox.read("page/click-kick.wav").starts_with(b"RIFF"));
    assert!(sandbox.read("page/click-kick.png").starts_with(b"\x89PNG"));
    sandbox.fails(audition, 1, "index.html: the file exists");
    sandbox.succeeds(&format!("{audition} --force"));
    sandbox.fails("presets audition --search nothing-like-it --out none", 1, "no sound is meant");
}

#[test]
fn the_presets_like_a_recording_begin_with_the_one_that_made_it() {
    let sandbox = Sandbox::new();
    sandbox.succeeds(
        "render --note 58 --velocity 100 --length 1 --tail none --preset Marimba --gain-db -12 -o strike.wav",
    );
    let found = sandbox.succeeds("presets like strike.wav --family mallet --note 58 --count 3 --json");
    let found: serde_json::Value = serde_json::from_slice(&found).unwrap();
    assert_eq!((found[0]["name"].as_str(), found[0]["key"].as_f64()), (Some("Marimba"), Some(58.0)));
    let distance = |n: usize| found[n]["distance_db"].as_f64().unwrap();
    assert!(distance(0) < 2.0 && distance(1) > 4.0 && distance(1) <= distance(2) && found[3].is_null());
    sandbox.write(
        "silence.wav",
        [
            &b"RIFF\x2c\0\0\0WAVEfmt \x10\0\0\0\x01\0\x01\0\x80\xbb\0\0\0\x77\x01\0\x02\0\x10\0data\x08\0\0\0"[..],
            &[0; 8],
        ]
        .concat(),
    );
    sandbox.fails("presets like silence.wav", 1, "silence.wav: it is silent");
    sandbox.fails("presets like strike.wav --search nothing-is-called-so", 1, "no preset fits these options");
}
