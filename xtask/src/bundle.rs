//! `cargo xtask bundle`: packs the plugin into the files that DAWs load.

use crate::files::{copy, replace, write};
use crate::patch;
use crate::shell::{cargo, root, run_to_end};
use crate::steps::TESTED;
use crate::symbols;
use crate::system::{Profile, System};
use std::path::{Path, PathBuf};

/// A plugin format.
#[derive(Clone, Copy)]
pub(crate) enum Format {
    Clap,
    Vst3,
}

impl Format {
    pub(crate) const ALL: [Format; 2] = [Format::Clap, Format::Vst3];

    /// The name of the bundle, the same on every system.
    pub(crate) fn file_name(self) -> &'static str {
        match self {
            Self::Clap => "Sprung.clap",
            Self::Vst3 => "Sprung.vst3",
        }
    }

    /// What is signed of the bundle, as a path beside it: macOS signs folders, Windows files.
    pub(crate) fn signed(self, system: &System) -> PathBuf {
        let library = if system.name == "macos" { PathBuf::new() } else { self.library(system) };
        [self.file_name().into(), library].iter().filter(|part| !part.as_os_str().is_empty()).collect()
    }

    /// Path of the library within the bundle; empty if the library itself is the bundle.
    fn library(self, system: &System) -> PathBuf {
        let (architecture, system) = (&system.architecture[..], system.name);
        // VST 3 SDK, "VST 3 Locations and Format": Windows has its own name for 64-bit ARM.
        let architecture = if (system, architecture) == ("windows", "aarch64") { "arm64" } else { architecture };
        match (self, system) {
            (_, "macos") => "Contents/MacOS/Sprung".into(),
            (Self::Clap, _) => PathBuf::new(),
            (Self::Vst3, "windows") => format!("Contents/{architecture}-win/Sprung.vst3").into(),
            (Self::Vst3, _) => format!("Contents/{architecture}-linux/Sprung.so").into(),
        }
    }
}

/// Builds the plugin for a system, writes the bundles into the folder `bundled` of what is made for it, and returns that folder.
pub(crate) fn run(system: &System, profile: Profile) -> Result<PathBuf, String> {
    patch::run()?;
    let build = "rustc --manifest-path plugin/Cargo.toml --lib --crate-type cdylib";
    let library = system.build(build, profile, &system.library(LIBRARY))?;
    if profile == Profile::Release {
        symbols::check(&library)?;
    }
    fill_all(system, &library)
}

/// The plugin's library, as cargo calls it.
const LIBRARY: &str = "sprung_plugin";

/// Builds all tests, and writes bundles with the library that they have.
pub(crate) fn of_the_tests() -> Result<PathBuf, String> {
    run_to_end(&mut cargo(&format!("test {TESTED} --no-run")), "the tests do not build")?;
    let system = System::own();
    // Where cargo leaves what tests depend on.
    fill_all(&system, &system.folder().join("debug/deps").join(system.library(LIBRARY)))
}

fn fill_all(system: &System, library: &Path) -> Result<PathBuf, String> {
    let folder = system.folder().join("bundled");
    for format in Format::ALL {
        let bundle = folder.join(format.file_name());
        replace(&bundle, |aside| fill(format, system, library, aside))?;
        println!("{}", bundle.display());
    }
    Ok(folder)
}

/// Writes a bundle to a path where nothing exists yet.
fn fill(format: Format, system: &System, library: &Path, bundle: &Path) -> Result<(), String> {
    let place = format.library(system);
    if place.as_os_str().is_empty() {
        return copy(library, bundle);
    }
    copy(library, &bundle.join(place))?;
    if system.name == "macos" {
        let identifier = if matches!(format, Format::Clap) { "org.sprung.clap" } else { "org.sprung.vst3" };
        write(&bundle.join("Contents/Info.plist"), &property_list(identifier, "BNDL"))?;
        write(&bundle.join("Contents/PkgInfo"), "BNDL????")?;
    }
    match format {
        Format::Clap => Ok(()),
        Format::Vst3 => {
            copy(&root().join("plugin/moduleinfo.json"), &bundle.join("Contents/Resources/moduleinfo.json"))
        }
    }
}

/// The property list that macOS requires in a bundle with the executable `Sprung`.
pub(crate) fn property_list(identifier: &str, kind: &str) -> String {
    let keys = [
        ("CFBundleExecutable", "Sprung"),
        ("CFBundleIdentifier", identifier),
        ("CFBundleInfoDictionaryVersion", "6.0"),
        ("CFBundleName", "Sprung"),
        ("CFBundlePackageType", kind),
        ("CFBundleShortVersionString", env!("CARGO_PKG_VERSION")),
        ("CFBundleSignature", "????"),
        ("CFBundleVersion", env!("CARGO_PKG_VERSION")),
    ];
    let entries: String =
        keys.iter().map(|(key, value)| format!("    <key>{key}</key>\n    <string>{value}</string>\n")).collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!DOCTYPE plist PUBLIC \"-//Apple//DTD PLIST 1.0//EN\" \
         \"http://www.apple.com/DTDs/PropertyList-1.0.dtd\">\n<plist version=\"1.0\">\n<dict>\n{entries}\
         \x20   <key>NSHighResolutionCapable</key>\n    <true/>\n</dict>\n</plist>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::remove;

    #[test]
    fn bundles_have_the_layout_of_their_system() {
        let folder = root().join("target/tmp").join(format!("layouts-{}", std::process::id()));
        write(&folder.join("library"), "code").unwrap();
        for (triple, clap, vst3) in [
            ("x86_64-unknown-linux-gnu", "", "Contents/x86_64-linux/Sprung.so"),
            ("x86_64-pc-windows-gnu", "", "Contents/x86_64-win/Sprung.vst3"),
            ("aarch64-pc-windows-msvc", "", "Contents/arm64-win/Sprung.vst3"),
            ("universal2-apple-darwin", "Contents/MacOS/Sprung", "Contents/MacOS/Sprung"),
        ] {
            let system = System::of(Some(triple)).unwrap();
            for (format, library) in [(Format::Clap, clap), (Format::Vst3, vst3)] {
                let bundle = folder.join(triple).join(format.file_name());
                fill(format, &system, &folder.join("library"), &bundle).unwrap();
                // A path that ends with a slash is no file.
                let library = if library.is_empty() { bundle.clone() } else { bundle.join(library) };
                assert_eq!(std::fs::read_to_string(library).unwrap(), "code", "{triple}");
                let list = std::fs::read_to_string(bundle.join("Contents/Info.plist"));
                assert_eq!(list.is_ok_and(|list| list.contains("<string>BNDL</string>")), system.name == "macos");
            }
        }
        remove(&folder).unwrap();
    }
}
