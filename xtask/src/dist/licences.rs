//! The licences of the crates that the command and the plugin contain, with their texts.

use crate::shell::cargo;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A crate’s name and version, its licence, and the texts in its folder.
type Crates = BTreeMap<String, (String, Vec<String>)>;

/// All crates of some manifests, each with its licence, and each text once with the crates that it belongs to.
pub(super) fn of_crates(manifests: &[&str]) -> Result<String, String> {
    let mut crates = Crates::new();
    for manifest in manifests {
        let mut command = cargo(&format!("metadata --format-version 1 --manifest-path {manifest}"));
        let output = command.output().map_err(|error| format!("cargo metadata: {error}"))?;
        if !output.status.success() {
            return Err(format!("cargo metadata: {}", String::from_utf8_lossy(&output.stderr)));
        }
        let metadata: Value = serde_json::from_slice(&output.stdout).map_err(|error| error.to_string())?;
        read(&metadata, &mut crates);
    }
    Ok(written(&crates))
}

/// Adds the crates that are built into something; crates for tests and for other chores are left out.
fn read(metadata: &Value, crates: &mut Crates) {
    let no_list = Vec::new();
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let nodes: BTreeMap<String, Value> =
        list(&metadata["resolve"]["nodes"]).into_iter().map(|node| (text(&node["id"]), node)).collect();
    let (mut used, mut open) = (BTreeSet::new(), vec![text(&metadata["resolve"]["root"])]);
    while let Some(id) = open.pop() {
        if !used.insert(id.clone()) {
            continue;
        }
        for dependency in nodes.get(&id).map(|node| list(&node["deps"])).unwrap_or_default() {
            let kinds = dependency["dep_kinds"].as_array().unwrap_or(&no_list);
            if kinds.iter().any(|kind| kind["kind"].is_null()) {
                open.push(text(&dependency["pkg"]));
            }
        }
    }
    for package in list(&metadata["packages"]) {
        // A missing source does not identify our own crates: crates that are patched by path have none either.
        let name = text(&package["name"]);
        let is_own = name.starts_with("sprung") || name == "xtask";
        if used.contains(&text(&package["id"])) && !is_own {
            // The manifests of corrected crates are in our tree, and their texts beside the source.
            let texts = [(&package["manifest_path"], 1), (&package["targets"][0]["src_path"], 2)]
                .map(|(path, up)| path.as_str().and_then(|path| Path::new(path).ancestors().nth(up)))
                .into_iter()
                .flatten()
                .map(texts)
                .find(|texts| !texts.is_empty());
            let licence = package["license"].as_str().unwrap_or("see its text").to_owned();
            crates.insert(format!("{name} {}", text(&package["version"])), (licence, texts.unwrap_or_default()));
        }
    }
}

/// The texts of a crate’s licences.
fn texts(folder: &Path) -> Vec<String> {
    let Ok(files) = std::fs::read_dir(folder) else { return Vec::new() };
    let is_licence = |name: &str| {
        ["LICENSE", "LICENCE", "COPYING", "COPYRIGHT", "NOTICE", "UNLICENSE"]
            .iter()
            .any(|start| name.to_uppercase().starts_with(start))
    };
    let mut paths: Vec<_> = files
        .flatten()
        .filter(|file| is_licence(&file.file_name().to_string_lossy()))
        .map(|file| file.path())
        .collect();
    paths.sort();
    paths.iter().filter_map(|path| std::fs::read_to_string(path).ok()).collect()
}

fn written(crates: &Crates) -> String {
    let mut result = "The crates that Sprung contains, their licences, and the texts of these.\n\n".to_owned();
    let mut by_text: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for (name, (licence, texts)) in crates {
        result += &format!("{name}: {licence}\n");
        texts.iter().for_each(|text| by_text.entry(text.trim()).or_default().push(name));
    }
    for (text, names) in by_text {
        result += &format!("\n{}\n{}\n\n{text}\n", "=".repeat(80), names.join(", "));
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_crates_and_those_of_tests_are_left_out_and_texts_are_told_once() {
        let dependency = |id: &str, kind: Value| serde_json::json!({ "pkg": id, "dep_kinds": [{ "kind": kind }] });
        let package = |id: &str, source: Value| serde_json::json!({ "id": id, "name": id, "version": "1", "license": "MIT", "source": source, "manifest_path": "/nowhere/Cargo.toml" });
        let metadata = serde_json::json!({
            "resolve": { "root": "sprung-plugin", "nodes": [
                { "id": "sprung-plugin", "deps": [dependency("a", Value::Null), dependency("t", "dev".into())] },
                { "id": "a", "deps": [dependency("b", Value::Null), dependency("sprung", Value::Null)] },
                { "id": "b", "deps": [dependency("patched", Value::Null)] },
            ] },
            "packages": [
                package("sprung-plugin", Value::Null),
                package("sprung", Value::Null),
                package("a", "x".into()),
                package("b", "x".into()),
                package("t", "x".into()),
                package("patched", Value::Null),
            ],
        });
        let mut crates = Crates::new();
        read(&metadata, &mut crates);
        assert_eq!(crates.keys().collect::<Vec<_>>(), ["a 1", "b 1", "patched 1"]);
        crates.values_mut().for_each(|(_, texts)| texts.push("The text\n".to_owned()));
        let written = written(&crates);
        assert_eq!(
            (written.matches("The text").count(), written.contains("a 1, b 1, patched 1")),
            (1, true),
            "{written}"
        );
    }
}
