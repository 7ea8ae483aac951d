//! `cargo xtask patch`: the plugin's wrapper, nice-plug, as crates.io has it but for the corrections in this folder.
//!
//! They keep its VST3 from ending its host and from leaving file descriptors behind. ARCHITECTURE.md, “Around the
//! wrapper”, tells the faults in the words of a report.

mod calls;
mod edit;
mod run_loop;
mod window;
mod worker;

use crate::files::{copy, make_folder_of, replace, write};
use crate::shell::{cargo, root};
use edit::Edit;
use sha2::{Digest as _, Sha256};
use std::fs;
use std::path::{Path, PathBuf};

/// The version that the corrections are for.
const VERSION: &str = "0.4.2";

/// The SHA-256 of that version's files, as [`digest_of`] reckons it.
const SOURCE: &str = "391d811e2293b24ebd2b8fa589194d71b32ae003415a61e5ba6222c7abcb7961";

/// The corrections, fault by fault.
const EDITS: [&[Edit]; 4] = [worker::EDITS, window::EDITS, run_loop::EDITS, calls::EDITS];

/// Where plugin/Cargo.toml looks for the wrapper. The folder's name is in cargo's message if the wrapper is not there.
const PLACE: &str = "target/run-cargo-xtask-patch/nice-plug";

/// A file beside the patched source, with the digest of what it was made with.
const STAMP: &str = "made-with";

/// Writes the patched wrapper to where the plugin's workspace expects it, unless it is there already.
///
/// # Errors
/// If the plugin asks for another version than the corrections were made for, if the source of that version cannot be
/// had or is not the one that they were made for, or if it cannot be written.
pub(crate) fn run() -> Result<PathBuf, String> {
    check_version(&read(&root().join("plugin/Cargo.toml"))?)?;
    let place = root().join(PLACE);
    let wanted = stamp();
    if fs::read_to_string(place.join(STAMP)).is_ok_and(|found| found == wanted) {
        return Ok(place);
    }
    let source = source()?;
    let found = digest_of(&source)?;
    if found != SOURCE {
        return Err(format!(
            "{}: this is not nice-plug {VERSION} as crates.io has it (SHA-256 {found} in place of {SOURCE}): delete \
             the folder, and cargo will unpack it again",
            source.display()
        ));
    }
    make_folder_of(&place)?;
    replace(&place, |aside| {
        copy(&source, aside)?;
        // Files of the registry may be read-only; those that are edited are written anew.
        for file in files() {
            let path = aside.join(file);
            let text = apply(file, &read(&path)?)?;
            fs::remove_file(&path).map_err(|error| format!("{}: {error}", path.display()))?;
            write(&path, &text)?;
        }
        write(&aside.join(STAMP), &wanted)
    })?;
    println!("{}: nice-plug {VERSION} with {} corrections", place.display(), edits().count());
    Ok(place)
}

/// Whether the plugin asks for the version that the rule is for.
fn check_version(manifest: &str) -> Result<(), String> {
    let manifest: toml::Table = manifest.parse().map_err(|error| format!("plugin/Cargo.toml: {error}"))?;
    let asked = manifest["dependencies"]["nice-plug"]["version"].as_str().unwrap_or("no version");
    if asked == format!("={VERSION}") {
        return Ok(());
    }
    Err(format!(
        "plugin/Cargo.toml asks for nice-plug {asked}, and the corrections in xtask/src/patch are for \
         ={VERSION}: look which of them that version still needs (ARCHITECTURE.md, “Around the wrapper”), then write \
         its number and the SHA-256 of its source there"
    ))
}

/// The folder in which cargo keeps the source of the registry's nice-plug, fetched if need be.
fn source() -> Result<PathBuf, String> {
    // A package that depends on the wrapper and nothing else, with the plugin's own versions of all below.
    let folder = root().join("target/run-cargo-xtask-patch/fetch");
    let manifest = format!(
        "[package]\nname = \"fetch\"\nedition = \"2024\"\n[workspace]\n[lib]\npath = \"lib.rs\"\n[dependencies]\n\
         nice-plug = {{ version = \"={VERSION}\", default-features = false }}\n"
    );
    write(&folder.join("Cargo.toml"), &manifest)?;
    write(&folder.join("lib.rs"), "")?;
    write(&folder.join("Cargo.lock"), &read(&root().join("plugin/Cargo.lock"))?)?;
    let mut command = cargo("metadata --format-version 1 --filter-platform");
    let output = command
        .arg(host()?)
        .arg("--manifest-path")
        .arg(folder.join("Cargo.toml"))
        .output()
        .map_err(|error| format!("cargo: {error}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(format!("the source of nice-plug {VERSION} cannot be fetched:\n{said}"));
    }
    let metadata: serde_json::Value =
        serde_json::from_slice(&output.stdout).map_err(|error| format!("cargo metadata: {error}"))?;
    let package = metadata["packages"].as_array().into_iter().flatten().find(|package| package["name"] == "nice-plug");
    let manifest = package.and_then(|package| package["manifest_path"].as_str()).map(Path::new);
    manifest.and_then(Path::parent).map(Path::to_owned).ok_or_else(|| "cargo metadata: no nice-plug in it".to_owned())
}

/// The target that this machine's compiler builds for.
fn host() -> Result<String, String> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = std::process::Command::new(rustc).arg("-vV").output().map_err(|error| format!("rustc: {error}"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| format!("rustc -vV names no host: {text}"))
}

fn edits() -> impl Iterator<Item = &'static Edit> {
    EDITS.into_iter().flatten()
}

/// The files that are edited, each once.
fn files() -> Vec<&'static str> {
    let mut files: Vec<_> = edits().map(|edit| edit.file).collect();
    files.sort_unstable();
    files.dedup();
    files
}

/// A file of the wrapper with its corrections.
fn apply(file: &str, text: &str) -> Result<String, String> {
    let mut text = text.to_owned();
    for Edit { old, new, times, .. } in edits().filter(|edit| edit.file == file) {
        let found = text.matches(old).count();
        if found != *times {
            return Err(format!("nice-plug's {file} has this {found} times in place of {times}:\n{old}"));
        }
        text = text.replace(old, new);
    }
    Ok(text)
}

/// The digest of all files in a package's folder with their paths, but for what cargo adds when it unpacks them.
fn digest_of(folder: &Path) -> Result<String, String> {
    let mut files = Vec::new();
    list(folder, &mut files)?;
    let mut paths: Vec<(String, PathBuf)> = files
        .into_iter()
        .map(|path| {
            let inside = path.strip_prefix(folder).expect("it was found in the folder");
            let parts: Vec<_> = inside.iter().map(|part| part.to_string_lossy()).collect();
            (parts.join("/"), path)
        })
        .filter(|(name, _)| name != ".cargo-ok")
        .collect();
    paths.sort();
    let mut sum = Sha256::new();
    for (name, path) in paths {
        let bytes = fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        sum.update(format!("{name}\n{}\n", bytes.len()));
        sum.update(bytes);
    }
    Ok(hex(sum))
}

/// The digest of everything that the patched source depends on.
fn stamp() -> String {
    let mut sum = Sha256::new();
    sum.update(SOURCE);
    for Edit { file, old, new, .. } in edits() {
        sum.update(format!("{file}\n{old}\n{new}\n"));
    }
    hex(sum)
}

fn hex(sum: Sha256) -> String {
    sum.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

fn list(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() { list(&path, files)? } else { files.push(path) }
    }
    Ok(())
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The manifest's table at a path of keys.
    fn table<'a>(manifest: &'a toml::Table, path: &[&str]) -> &'a toml::Value {
        path.iter().skip(1).fold(&manifest[path[0]], |table, key| &table[key])
    }

    #[test]
    fn another_version_is_refused_with_what_to_do() {
        let asks = |version: &str| format!("[dependencies]\nnice-plug = {{ version = \"{version}\" }}");
        assert_eq!(check_version(&asks("=0.4.2")), Ok(()));
        for version in ["=0.4.3", "0.4.2", "^0.4"] {
            let message = check_version(&asks(version)).unwrap_err();
            assert!(message.contains(&format!("asks for nice-plug {version},")), "{message}");
            assert!(message.contains("are for =0.4.2") && message.contains("xtask/src/patch"), "{message}");
        }
    }

    #[test]
    fn every_edit_says_what_it_finds() {
        for edit in edits() {
            assert!(edit.old != edit.new && !edit.old.is_empty() && edit.times > 0, "{}", edit.old);
        }
        let message = apply(edit::WORKER, "something else").unwrap_err();
        assert!(message.contains(edit::WORKER) && message.contains("0 times in place of 1"), "{message}");
    }

    #[test]
    fn the_digest_knows_every_byte_and_path() {
        let folder = root().join("target/tmp").join(format!("digest-{}", std::process::id()));
        let digest = |files: &[(&str, &str)]| {
            for (name, text) in files {
                write(&folder.join(name), text).unwrap();
            }
            let digest = digest_of(&folder).unwrap();
            fs::remove_dir_all(&folder).unwrap();
            digest
        };
        let first = digest(&[("a", "1"), ("b/c", "2")]);
        assert_eq!(first, digest(&[("b/c", "2"), ("a", "1"), (".cargo-ok", "unpacked")]));
        assert_ne!(first, digest(&[("a", "1"), ("b/c", "3")]));
        assert_ne!(first, digest(&[("a", "1"), ("b/d", "2")]));
        assert_ne!(first, digest(&[("a", "1"), ("b/c", "2"), ("e", "")]));
    }

    /// The plugin is a workspace of its own and cannot inherit: what both have must be the same.
    #[test]
    fn both_workspaces_agree() {
        let manifest = |path: &str| read(&root().join(path)).unwrap().parse::<toml::Table>().unwrap();
        let (ours, plugin) = (manifest("Cargo.toml"), manifest("plugin/Cargo.toml"));
        for key in ["version", "edition", "rust-version", "license", "authors"] {
            assert_eq!(table(&ours, &["workspace", "package", key]), table(&plugin, &["package", key]), "{key}");
        }
        assert_eq!(table(&ours, &["workspace", "resolver"]), table(&plugin, &["workspace", "resolver"]));
        assert_eq!(table(&ours, &["workspace", "lints"]), table(&plugin, &["lints"]));
        assert_eq!(table(&ours, &["profile", "dev"]), table(&plugin, &["profile", "dev"]));
        assert_eq!(
            table(&ours, &["profile", "release", "debug"]),
            table(&plugin, &["profile", "release", "debug"]),
            "line numbers"
        );
        let place = table(&plugin, &["patch", "crates-io", "nice-plug", "path"]).as_str().unwrap();
        assert_eq!(place, format!("../{PLACE}"));
    }
}
