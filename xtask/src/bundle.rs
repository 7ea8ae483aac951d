//! `cargo xtask bundle`: packs the plugin into the files that DAWs load.

use crate::files::{copy, replace, write};
use crate::patch;
use crate::shell::{cargo, root, run_to_end};
use crate::symbols;
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

    /// Path of the library within the bundle; empty if the library itself is the bundle.
    fn library(self) -> PathBuf {
        let (architecture, system) = (std::env::consts::ARCH, std::env::consts::OS);
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

/// Builds the plugin, writes the bundles into `target/bundled` and returns that folder.
pub(crate) fn run(release: bool) -> Result<PathBuf, String> {
    // Debug symbols are most of the library's size.
    let (profile, linking) = if release { ("--release", "-- -C strip=symbols") } else { ("", "") };
    patch::run()?;
    build(&format!(
        "rustc --manifest-path plugin/Cargo.toml --lib --crate-type cdylib --target-dir target {profile} {linking}"
    ))?;
    let library = library(if release { "release" } else { "debug" });
    if release {
        symbols::check(&library)?;
    }
    fill_all(&library)
}

/// The command that runs the plugin's own tests.
pub(crate) const TESTS: &str = "test --manifest-path plugin/Cargo.toml --features standalone --no-fail-fast";

/// Writes bundles with the library that [`TESTS`] builds, so that it is not compiled a second time with other features.
pub(crate) fn of_the_tests() -> Result<PathBuf, String> {
    build(&format!("{TESTS} --no-run"))?;
    // Where cargo leaves what tests depend on.
    fill_all(&library("debug/deps"))
}

fn build(arguments: &str) -> Result<(), String> {
    run_to_end(&mut cargo(arguments), "the plugin does not build")
}

/// The library that cargo has built in a profile's folder.
fn library(folder: &str) -> PathBuf {
    let name = format!("{}sprung_plugin{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    root().join("target").join(folder).join(name)
}

fn fill_all(library: &Path) -> Result<PathBuf, String> {
    let folder = root().join("target/bundled");
    for format in Format::ALL {
        let bundle = folder.join(format.file_name());
        replace(&bundle, |aside| fill(format, library, aside))?;
        println!("{}", bundle.display());
    }
    Ok(folder)
}

/// Writes a bundle to a path where nothing exists yet.
fn fill(format: Format, library: &Path, bundle: &Path) -> Result<(), String> {
    let place = format.library();
    if place.as_os_str().is_empty() {
        return copy(library, bundle);
    }
    copy(library, &bundle.join(place))?;
    if cfg!(target_os = "macos") {
        write(&bundle.join("Contents/Info.plist"), &property_list(format))?;
        write(&bundle.join("Contents/PkgInfo"), "BNDL????")?;
    }
    match format {
        Format::Clap => Ok(()),
        Format::Vst3 => {
            copy(&root().join("plugin/moduleinfo.json"), &bundle.join("Contents/Resources/moduleinfo.json"))
        }
    }
}

/// The property list that macOS requires in a bundle.
fn property_list(format: Format) -> String {
    let keys = [
        ("CFBundleExecutable", "Sprung"),
        ("CFBundleIdentifier", if matches!(format, Format::Clap) { "org.sprung.clap" } else { "org.sprung.vst3" }),
        ("CFBundleInfoDictionaryVersion", "6.0"),
        ("CFBundleName", "Sprung"),
        ("CFBundlePackageType", "BNDL"),
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
