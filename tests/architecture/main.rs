//! Checks what ARCHITECTURE.md says about the sources: dependencies point one way, and every file states its purpose.

mod module;
mod planted;
mod rules;
mod tree;

use rules::Row;
use std::fs;
use std::path::{Path, PathBuf};
use tree::Tree;

/// For each module of the library, the other modules that it may use.
const ALLOWED: &[Row] = &[
    ("units", &[]),
    ("error", &[]),
    ("text", &[]),
    ("manual", &[]),
    ("dsp", &[]),
    ("params", &["units"]),
    ("patch", &["params", "dsp"]),
    ("sound", &["dsp", "error", "params", "patch", "units"]),
    ("preset", &["error", "params", "patch", "sound", "text", "units"]),
    ("engine", &["dsp", "params", "patch", "sound", "units"]),
    ("io", &["dsp", "engine", "error", "units"]),
    ("request", &["engine", "error", "io", "params", "preset", "render", "sound", "text", "units"]),
    ("batch", &["analysis", "dsp", "error", "io", "params", "render", "request"]),
    ("sampler", &["analysis", "engine", "error", "io", "params", "preset", "render", "sound", "text"]),
    ("render", &["dsp", "engine", "error", "io", "params", "patch", "preset", "sound", "text", "units"]),
    ("realtime", &["engine", "error", "io", "params", "patch", "render", "sound", "units"]),
    ("figure", &["error", "text"]),
    ("analysis", &["dsp", "engine", "error", "figure", "io", "params", "patch", "preset", "sound", "text", "units"]),
    ("lab", &["dsp", "error", "figure", "text"]),
    (
        "internals",
        &[
            "analysis", "dsp", "engine", "error", "figure", "io", "lab", "manual", "params", "preset", "realtime",
            "render", "request", "sound", "text",
        ],
    ),
];

/// Crates, and parts of the standard library, that only the listed modules may use.
const OUTSIDE: &[Row] = &[
    ("hound", &["io"]),
    ("midly", &["io"]),
    ("sprung_fourier", &["io", "analysis"]),
    ("symphonia", &["io"]),
    ("nalgebra", &["analysis"]),
    ("toml", &["preset", "analysis"]),
    ("plotters", &["figure", "analysis", "lab"]),
    ("ebur128", &["render", "analysis"]),
    ("rayon", &["batch", "render", "sampler"]),
    ("flacenc", &["io"]),
    ("std::fs", &["batch", "io", "preset", "analysis", "sampler"]),
    ("alsa", &["realtime"]),
    ("cpal", &["realtime"]),
    ("jack", &["realtime"]),
    ("midir", &["realtime"]),
    ("rtrb", &["realtime"]),
    // Decoders that panic do so on a thread of their own.
    ("std::thread", &["io", "realtime"]),
];

/// Libraries that the plugin must not use, because it has no signal processing of its own.
const NOT_OF_THE_PLUGIN: &[Row] = &[("sprung::dsp", &[]), ("libm", &[])];

/// Crates that the library needs without any features, which is how the plugin builds it.
const ALWAYS_BUILT: &[&str] = &["libm", "midly", "same-file", "strsim", "tempfile", "thiserror", "toml", "toml_writer"];

/// Root files of the crates whose files must not import each other.
const CRATES: &[&str] = &[
    "src/lib.rs",
    "src/cli/main.rs",
    "src/fourier/src/lib.rs",
    "plugin/src/lib.rs",
    "plugin/tests/hosts/main.rs",
    "src/python/src/lib.rs",
    "src/web/src/lib.rs",
    "xtask/src/main.rs",
    "benches/peers/main.rs",
    "tests/analysis/main.rs",
    "tests/architecture/main.rs",
    "tests/cli/main.rs",
    "tests/cross/src/main.rs",
    "tests/engine/main.rs",
    "tests/golden/main.rs",
    "tests/lab/main.rs",
    "tests/levels/main.rs",
    "tests/realtime/main.rs",
];

fn project() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(root: &str) -> Tree {
    Tree::read(Path::new(root), &|file| fs::read_to_string(project().join(file)).ok()).unwrap()
}

#[track_caller]
fn assert_none(breaches: &[String]) {
    assert!(breaches.is_empty(), "\n{}", breaches.join("\n"));
}

/// Dependencies point one way, no two files import each other, other packages stay where they belong, and the plugin has no signal
/// processing of its own. In one test, since parsing takes most of its time.
#[test]
fn no_import_breaks_a_rule() {
    assert!(
        ["src/lib.rs", "plugin/src/lib.rs"].iter().all(|root| CRATES.contains(root)),
        "these have rules of their own"
    );
    let mut breaches = rules::outside(&read("plugin/src/main.rs"), NOT_OF_THE_PLUGIN);
    for root in CRATES {
        let tree = read(root);
        let round = |((one, other), [there, back]): ((PathBuf, PathBuf), [usize; 2])| {
            format!("{}:{there} and {}:{back} import each other", one.display(), other.display())
        };
        breaches.extend(rules::circles(&tree).into_iter().map(round));
        match *root {
            "src/lib.rs" => {
                assert!(tree.len() > 80, "only {} modules were found", tree.len());
                breaches.extend(rules::directions(&tree, ALLOWED));
                breaches.extend(rules::outside(&tree, OUTSIDE));
            }
            "plugin/src/lib.rs" => breaches.extend(rules::outside(&tree, NOT_OF_THE_PLUGIN)),
            _ => {}
        }
    }
    assert_none(&breaches);
    let round = ALLOWED.iter().filter(|(name, _)| rules::reaches(ALLOWED, name, name)).map(|(name, _)| *name);
    assert_eq!(round.collect::<Vec<_>>(), [""; 0], "the rows themselves go round");
}

#[test]
fn the_rows_do_not_go_against_the_document() {
    let document = fs::read_to_string(project().join("ARCHITECTURE.md")).unwrap();
    let section = document.split("**Dependencies point one way.**").nth(1).unwrap().split("\n\n").next().unwrap();
    // `a, b ← c ← {d, e}`: neither `a` nor `b` may use `c`, and `c` uses neither `d` nor `e`.
    let chains: Vec<Vec<Vec<&str>>> = section
        .split('`')
        .filter(|code| code.contains('←'))
        .map(|chain| {
            chain
                .split('←')
                .map(|names| names.split([',', ' ', '{', '}']).filter(|name| !name.is_empty()).collect())
                .collect()
        })
        .collect();
    assert_eq!(chains.len(), 2, "{section}");
    for pair in chains.iter().flat_map(|chain| chain.windows(2)) {
        for (used, user) in pair[0].iter().flat_map(|used| pair[1].iter().map(move |user| (*used, *user))) {
            for name in [used, user] {
                // The command is a crate of its own, so no row can name it.
                assert!(name == "cli" || ALLOWED.iter().any(|(row, _)| *row == name), "{name} has no row");
            }
            assert!(!rules::reaches(ALLOWED, used, user), "the rows let {used} use {user}");
        }
    }
}

#[test]
fn the_plugin_builds_nothing_that_only_the_command_needs() {
    let manifest = |file: &str| -> toml::Table { fs::read_to_string(project().join(file)).unwrap().parse().unwrap() };
    let library = manifest("Cargo.toml");
    let is_optional = |value: &toml::Value| value.get("optional").and_then(toml::Value::as_bool) == Some(true);
    let always = library["dependencies"].as_table().unwrap().iter().filter(|(_, value)| !is_optional(value));
    assert_eq!(always.map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ALWAYS_BUILT);
    let used = &manifest("plugin/Cargo.toml")["dependencies"]["sprung"];
    assert_eq!(used.get("default-features").and_then(toml::Value::as_bool), Some(false));
    // The plugin reads and fits recordings that are dropped on its window.
    let features = used["features"].as_array().unwrap().iter().filter_map(toml::Value::as_str);
    assert_eq!(features.collect::<Vec<_>>(), ["fit"]);
}

/// Rust files in a folder, relative to the project.
fn files(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(project().join(folder)).unwrap() {
        let path = folder.join(entry.unwrap().file_name());
        if project().join(&path).is_dir() {
            files(&path, into);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            into.push(path);
        }
    }
}

#[test]
fn every_file_opens_with_its_purpose() {
    let mut all = Vec::new();
    for folder in ["src", "tests", "benches", "plugin", "xtask"] {
        files(Path::new(folder), &mut all);
    }
    assert!(all.len() > 150, "only {} files were found", all.len());
    let breach = |file: &PathBuf| rules::purpose(file, &fs::read_to_string(project().join(file)).unwrap());
    assert_none(&all.iter().filter_map(breach).collect::<Vec<_>>());
}

/// What a file says that depends on its system.
const OF_A_SYSTEM: &[&str] = &[
    "cfg(unix)",
    "cfg(windows)",
    "cfg(target_os",
    "cfg(target_family",
    "cfg(not(target_os",
    "cfg!(unix)",
    "cfg!(windows)",
    "cfg!(target_os",
    "cfg!(all(target_os",
    "libc::",
    "env::consts::",
];

#[test]
fn every_file_that_knows_its_system_is_listed() {
    let list = fs::read_to_string(project().join("PLATFORMS.md")).unwrap();
    let mut all = Vec::new();
    for folder in ["src", "tests", "benches", "plugin", "xtask"] {
        files(Path::new(folder), &mut all);
    }
    // This file has the words.
    all.retain(|file| *file != Path::new("tests/architecture/main.rs"));
    let breach = |file: &PathBuf| {
        let text = fs::read_to_string(project().join(file)).unwrap();
        let sign = OF_A_SYSTEM.iter().find(|sign| text.contains(**sign))?;
        let name = format!("`{}`", file.display());
        (!list.contains(&name)).then(|| format!("{name} has {sign}, and PLATFORMS.md has no row for it"))
    };
    assert_none(&all.iter().filter_map(breach).collect::<Vec<_>>());
}
