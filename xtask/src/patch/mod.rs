//! `cargo xtask patch`: writes packages used by the plugin, as on crates.io but with the corrections in this folder.
//!
//! The corrections keep the wrapper's VST3 from crashing its host and from leaking file descriptors, make sure that a closed
//! window is gone and one that is shown late is drawn, give the window the host's scale, pass on dropped files and more keys, let
//! the window open the host's menu of a parameter, and let a plugin with many outputs play on those that a host has buffers for. On
//! Windows they keep a click from ending the host, and pass on the keys that nobody types. `plugin/UPSTREAM.md` describes these
//! faults as in bug reports. One more edit corrects no fault: it only silences a warning of the compiler.

mod baseview;
mod calls;
mod digest;
mod edit;
mod egui_baseview;
mod menu;
mod ports;
mod run_loop;
mod size;
mod state;
mod window;
mod worker;

use crate::files::{copy, make_folder_of, replace, write};
use crate::shell::{cargo, root};
use edit::Edit;
use std::fs;
use std::path::{Path, PathBuf};

/// A package with corrections.
struct Package {
    name: &'static str,
    /// The version for which the corrections were made.
    version: &'static str,
    /// The SHA-256 of that version's files, as computed by [`digest::of_folder`].
    source: &'static str,
    /// The corrections, grouped by fault.
    edits: &'static [&'static [Edit]],
}

const PACKAGES: [Package; 4] = [
    Package {
        name: "nice-plug",
        version: "0.4.2",
        source: "391d811e2293b24ebd2b8fa589194d71b32ae003415a61e5ba6222c7abcb7961",
        edits: &[
            worker::EDITS,
            window::EDITS,
            run_loop::EDITS,
            calls::EDITS,
            menu::EDITS,
            ports::EDITS,
            size::EDITS,
            state::EDITS,
        ],
    },
    Package {
        name: "nice-plug-core",
        version: "0.4.2",
        source: "ec16c3484f27d64d405e43f1ef5b392a16f8453117d92288c033821e4bd5efe5",
        edits: &[menu::INTERFACE, size::INTERFACE],
    },
    Package {
        name: "baseview",
        version: "0.4.2",
        source: "010bdeb0ca653a1a2568e52137b4496548ec0fa7d74594a03f04c3e864603840",
        edits: &[baseview::EDITS, size::WINDOW],
    },
    Package {
        name: "egui-baseview",
        version: "0.9.0",
        source: "f8ccbcb2aa109bf5a3583b0b42e49056c1e12332ffc2054de407e44b6d0bee96",
        edits: &[egui_baseview::EDITS],
    },
];

/// The folder in which the manifests in plugin/wrapper expect the sources. If it is missing, its name in the compiler's message
/// says which command to run.
const PLACE: &str = "target/run-cargo-xtask-patch";

/// The folder with the packages' manifests.
const MANIFESTS: &str = "plugin/wrapper";

/// A file next to the patched source that contains the digest of everything it was made from.
const STAMP: &str = "made-with";

/// Writes the patched packages to the place where the manifests in the tree expect them, unless they are there already.
///
/// # Errors
/// If the plugin requires another version than the corrections were made for, if the source of that version cannot be
/// fetched or differs from the one they were made for, if the manifest in the tree asks for something else than the source's
/// own, or if the result cannot be written.
pub(crate) fn run() -> Result<(), String> {
    let manifest = read(&root().join("plugin/Cargo.toml"))?;
    PACKAGES.iter().try_for_each(|package| package.patch(&manifest))
}

impl Package {
    /// Writes the package with its corrections, unless it is there already.
    fn patch(&self, manifest: &str) -> Result<(), String> {
        self.check_version(manifest)?;
        let Self { name, version, .. } = self;
        let place = root().join(PLACE).join(name);
        let wanted = self.stamp();
        if fs::read_to_string(place.join(STAMP)).is_ok_and(|found| found == wanted) {
            return self.check_manifest(&place);
        }
        let source = self.source()?;
        let found = digest::of_folder(&source)?;
        if found != self.source {
            return Err(format!(
                "{}: this is not {name} {version} as crates.io has it (SHA-256 {found} in place of {}): delete the \
                 folder, and cargo will unpack it again",
                source.display(),
                self.source
            ));
        }
        make_folder_of(&place)?;
        replace(&place, |aside| {
            copy(&source, aside)?;
            // Files of the registry may be read-only, so edited files are created anew.
            for file in self.files() {
                let path = aside.join(file);
                let text = self.apply(file, &read(&path)?)?;
                fs::remove_file(&path).map_err(|error| format!("{}: {error}", path.display()))?;
                write(&path, &text)?;
            }
            write(&aside.join(STAMP), &wanted)
        })?;
        println!("{}: {name} {version} with {} corrections", place.display(), self.edits().count());
        self.check_manifest(&place)
    }

    /// Checks that the plugin requires the version for which the corrections were made.
    fn check_version(&self, manifest: &str) -> Result<(), String> {
        let Self { name, version, .. } = self;
        let manifest: toml::Table = manifest.parse().map_err(|error| format!("plugin/Cargo.toml: {error}"))?;
        let asked = manifest["dependencies"].get(name).and_then(|package| package["version"].as_str());
        let asked = asked.unwrap_or("no version");
        if asked == format!("={version}") {
            return Ok(());
        }
        Err(format!(
            "plugin/Cargo.toml asks for {name} {asked}, and the corrections in xtask/src/patch are for ={version}: look \
             which of them that version still needs (plugin/UPSTREAM.md), then write its number and the SHA-256 of its \
             source there"
        ))
    }

    /// Checks that the manifest in the tree says of the package what its own does, but for tests and where the source is.
    fn check_manifest(&self, source: &Path) -> Result<(), String> {
        let of = |path: &Path| -> Result<toml::Table, String> {
            read(path)?.parse().map_err(|error| format!("{}: {error}", path.display()))
        };
        let path = root().join(MANIFESTS).join(self.name).join("Cargo.toml");
        let (ours, theirs) = (of(&path)?, of(&source.join("Cargo.toml"))?);
        let package = |key| (key, ours["package"].get(key), theirs["package"].get(key));
        let table = |key| (key, ours.get(key), theirs.get(key));
        let parts = ["version", "edition", "license"].map(package).into_iter();
        let mut parts = parts.chain(["features", "dependencies", "target"].map(table));
        match parts.find(|(_, ours, theirs)| ours != theirs) {
            Some((key, ..)) => Err(format!("{}: ‘{key}’ is not as in {}", path.display(), source.display())),
            None => Ok(()),
        }
    }

    /// The folder in which cargo keeps the registry's source of the package. Fetches the source if necessary.
    fn source(&self) -> Result<PathBuf, String> {
        let Self { name, version, .. } = self;
        // A package that depends only on this one, with the versions of all further dependencies from our lock file.
        let folder = root().join(PLACE).join("fetch");
        let manifest = format!(
            "[package]\nname = \"fetch\"\nedition = \"2024\"\n[workspace]\n[lib]\npath = \"lib.rs\"\n[dependencies]\n\
             {name} = {{ version = \"={version}\", default-features = false }}\n"
        );
        write(&folder.join("Cargo.toml"), &manifest)?;
        write(&folder.join("lib.rs"), "")?;
        write(&folder.join("Cargo.lock"), &read(&root().join("Cargo.lock"))?)?;
        let mut command = cargo("metadata --format-version 1 --filter-platform");
        let output = command
            .arg(host()?)
            .arg("--manifest-path")
            .arg(folder.join("Cargo.toml"))
            .output()
            .map_err(|error| format!("cargo: {error}"))?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            return Err(format!("the source of {name} {version} cannot be fetched:\n{said}"));
        }
        let metadata: serde_json::Value =
            serde_json::from_slice(&output.stdout).map_err(|error| format!("cargo metadata: {error}"))?;
        let package = metadata["packages"].as_array().into_iter().flatten().find(|package| package["name"] == *name);
        let manifest = package.and_then(|package| package["manifest_path"].as_str()).map(Path::new);
        manifest.and_then(Path::parent).map(Path::to_owned).ok_or_else(|| format!("cargo metadata: no {name} in it"))
    }

    fn edits(&self) -> impl Iterator<Item = &'static Edit> {
        self.edits.iter().copied().flatten()
    }

    /// The files that have edits, each once.
    fn files(&self) -> Vec<&'static str> {
        let mut files: Vec<_> = self.edits().map(|edit| edit.file).collect();
        files.sort_unstable();
        files.dedup();
        files
    }

    /// The text of a file of the package with its corrections.
    fn apply(&self, file: &str, text: &str) -> Result<String, String> {
        let mut text = text.to_owned();
        for Edit { old, new, times, .. } in self.edits().filter(|edit| edit.file == file) {
            let found = text.matches(old).count();
            if found != *times {
                return Err(format!("{}'s {file} has this {found} times in place of {times}:\n{old}", self.name));
            }
            text = text.replace(old, new);
        }
        Ok(text)
    }

    /// The digest of everything that the patched source depends on.
    fn stamp(&self) -> String {
        let edits = self.edits().map(|Edit { file, old, new, .. }| format!("{file}\n{old}\n{new}\n"));
        digest::of_texts([self.source.to_owned()].into_iter().chain(edits))
    }
}

/// The target that this machine's compiler builds for.
fn host() -> Result<String, String> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = std::process::Command::new(rustc).arg("-vV").output().map_err(|error| format!("rustc: {error}"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| format!("rustc -vV names no host: {text}"))
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_version_is_refused_with_what_to_do() {
        for package in PACKAGES {
            let (name, own) = (package.name, package.version);
            let asks = |version: &str| format!("[dependencies]\n{name} = {{ version = \"{version}\" }}");
            assert_eq!(package.check_version(&asks(&format!("={own}"))), Ok(()));
            for version in ["=0.4.3", own, "^0.4"] {
                let message = package.check_version(&asks(version)).unwrap_err();
                assert!(message.contains(&format!("asks for {name} {version},")), "{message}");
                assert!(
                    message.contains(&format!("are for ={own}")) && message.contains("xtask/src/patch"),
                    "{message}"
                );
            }
            let message = package.check_version("[dependencies]").unwrap_err();
            assert!(message.contains(&format!("asks for {name} no version,")), "{message}");
        }
    }

    #[test]
    fn every_edit_says_what_it_finds() {
        for edit in PACKAGES.iter().flat_map(Package::edits) {
            assert!(edit.old != edit.new && !edit.old.is_empty() && edit.times > 0, "{}", edit.old);
        }
        let message = PACKAGES[0].apply(edit::WORKER, "something else").unwrap_err();
        assert!(message.contains(edit::WORKER) && message.contains("0 times in place of 1"), "{message}");
    }

    /// Without its entry or its path, cargo would build a package uncorrected or not at all.
    #[test]
    fn cargo_finds_every_corrected_package() {
        let manifest = |path: &str| read(&root().join(path)).unwrap().parse::<toml::Table>().unwrap();
        let patched = &manifest("Cargo.toml")["patch"]["crates-io"];
        for Package { name, .. } in PACKAGES {
            let place = patched[name]["path"].as_str().unwrap();
            assert_eq!(place, format!("{MANIFESTS}/{name}"));
            let library = &manifest(&format!("{place}/Cargo.toml"))["lib"]["path"];
            assert_eq!(library.as_str().unwrap(), format!("../../../{PLACE}/{name}/src/lib.rs"));
        }
    }
}
