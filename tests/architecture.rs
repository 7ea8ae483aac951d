//! The dependencies between the crate's modules point one way.

use std::fs;
use std::path::Path;

/// What each module may use of the crate, as ARCHITECTURE.md has it. `""` stands for a module's own files.
const ALLOWED: &[(&str, &[&str])] = &[
    ("units", &[]),
    ("error", &[]),
    ("text", &[]),
    ("dsp", &["dsp"]),
    ("params", &["units"]),
    ("patch", &["params", "dsp"]),
    ("preset", &["error", "params", "patch", "text", "units", "Error", "Result"]),
    ("engine", &["engine", "dsp", "params", "patch", "units"]),
    ("io", &["io", "dsp", "engine", "error", "units", "Error", "Result"]),
    ("render", &["render", "dsp", "engine", "error", "io", "params", "patch", "preset", "units", "Error", "Result"]),
    (
        "realtime",
        &[
            "realtime", "engine", "error", "io", "params", "patch", "preset", "render", "text", "units", "Error",
            "Result",
        ],
    ),
    ("figure", &["figure", "error", "Error", "Result"]),
    ("analysis", &["analysis", "error", "figure", "units", "Error", "Result"]),
    ("lab", &["lab", "dsp", "error", "figure", "Error", "Result"]),
];

/// Crates that only the named modules may use.
const OUTSIDE: &[(&str, &[&str])] = &[
    ("clap", &["cli", "main"]),
    ("hound", &["io"]),
    ("midly", &["io"]),
    ("toml", &["preset", "analysis"]),
    ("plotters", &["figure", "analysis", "lab"]),
    ("ebur128", &["render"]),
    ("rayon", &["render"]),
    ("std::fs", &["io", "preset", "analysis", "cli"]),
    ("alsa", &["realtime"]),
    ("cpal", &["realtime"]),
    ("jack", &["realtime"]),
    ("midir", &["realtime"]),
    ("rtrb", &["realtime"]),
    ("ratatui", &["realtime"]),
    ("std::thread", &["realtime", "cli"]),
];

fn sources(folder: &Path, into: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, into);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let relative = path.strip_prefix(concat!(env!("CARGO_MANIFEST_DIR"), "/src")).unwrap();
            let module = relative.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs").to_owned();
            // Tests may look further than what they test.
            let text = fs::read_to_string(&path).unwrap();
            let code = text.split("#[cfg(test)]").next().unwrap();
            let code = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
            into.push((module, code));
        }
    }
}

fn all_sources() -> Vec<(String, String)> {
    let mut all = vec![];
    sources(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src")), &mut all);
    assert!(all.len() > 20);
    all
}

#[test]
fn dependencies_point_one_way() {
    for (module, code) in all_sources() {
        let Some((_, allowed)) = ALLOWED.iter().find(|(name, _)| *name == module) else { continue };
        for used in code.split("crate::").skip(1) {
            let name: String = used.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            let names = if name.is_empty() { used.trim_start_matches('{') } else { &name };
            let first = names.split([',', ':', '}', ' ']).next().unwrap();
            assert!(allowed.contains(&first), "src/{module} uses crate::{first}");
        }
    }
}

#[test]
fn outside_crates_stay_where_they_belong() {
    for (module, code) in all_sources() {
        for (name, allowed) in OUTSIDE {
            let uses = code.contains(&format!("{name}::")) || code.contains(&format!("use {name};"));
            assert!(!uses || allowed.contains(&module.as_str()), "src/{module} uses {name}");
        }
    }
}

#[test]
fn the_plugin_has_no_dsp() {
    let plugin = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/plugin/src"));
    let (mut folders, mut files) = (vec![plugin.to_owned()], 0);
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            files += 1;
            let text = fs::read_to_string(&path).unwrap();
            let used = ["dsp::", "libm::"].into_iter().find(|name| text.contains(name));
            assert_eq!(used, None, "{}", path.display());
        }
    }
    assert!(files > 10);
}
