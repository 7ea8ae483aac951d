//! The plugin as hosts find it: the library that cargo built, in the folder layout of each format.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Environment variable: a folder with the `Sprung.clap` and `Sprung.vst3` to test instead of the library from this
/// build, or with the folders `CLAP` and `VST3` that contain them.
const BUNDLES: &str = "SPRUNG_BUNDLES";

/// Path of the library within `Sprung.vst3`.
const VST3_LIBRARY: &str = match (cfg!(target_os = "macos"), cfg!(windows), cfg!(target_arch = "x86_64")) {
    (true, ..) => "Contents/MacOS/Sprung",
    (_, true, true) => "Contents/x86_64-win/Sprung.vst3",
    (_, true, false) => "Contents/arm64-win/Sprung.vst3",
    (_, false, true) => "Contents/x86_64-linux/Sprung.so",
    (_, false, false) => "Contents/aarch64-linux/Sprung.so",
};

/// `Sprung.clap`.
pub(crate) fn clap() -> &'static Path {
    static PATH: OnceLock<PathBuf> = OnceLock::new();
    PATH.get_or_init(|| bundle("CLAP", "Sprung.clap"))
}

/// `Sprung.vst3`, a folder.
pub(crate) fn vst3() -> &'static Path {
    static PATH: OnceLock<PathBuf> = OnceLock::new();
    PATH.get_or_init(|| bundle("VST3", "Sprung.vst3"))
}

/// A bundle in the folder, or in the folder of its format, as installers put it.
fn bundle(format: &str, name: &str) -> PathBuf {
    let folder = folder();
    let places = [folder.join(format).join(name), folder.join(name)];
    places.iter().find(|place| place.exists()).unwrap_or(&places[1]).clone()
}

/// The library within `Sprung.vst3`.
pub(crate) fn vst3_library() -> PathBuf {
    vst3().join(VST3_LIBRARY)
}

/// Whether the bundles to test were given by [`BUNDLES`].
pub(crate) fn are_given() -> bool {
    std::env::var_os(BUNDLES).is_some()
}

/// The folder of the bundles, once it has been determined.
static FOLDER: OnceLock<PathBuf> = OnceLock::new();

/// The folder of the bundles. If none was given: a folder of this process under the target directory, made on first
/// use.
fn folder() -> &'static Path {
    FOLDER.get_or_init(|| match std::env::var_os(BUNDLES) {
        Some(folder) => folder.into(),
        None => assemble(),
    })
}

/// Copies the library into bundles, once for this process and all processes that it starts.
fn assemble() -> PathBuf {
    if cfg!(target_os = "macos") {
        panic!("bundles for macOS have property lists: ‘cargo xtask test’ makes them");
    }
    let library = library();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("bundles-{}", std::process::id()));
    let within = folder.join("Sprung.vst3").join(VST3_LIBRARY);
    std::fs::create_dir_all(within.parent().unwrap()).unwrap();
    for to in [folder.join("Sprung.clap"), within] {
        std::fs::copy(&library, &to).unwrap_or_else(|error| panic!("{}: {error}", library.display()));
    }
    folder
}

/// Removes the bundles if this process made them.
pub(crate) fn remove() {
    if let Some(folder) = FOLDER.get().filter(|_| !are_given()) {
        let _ = std::fs::remove_dir_all(folder);
    }
}

/// The environment variable of a command, so that the started process tests the same bundles.
pub(crate) fn environment() -> (&'static str, &'static Path) {
    (BUNDLES, folder())
}

/// The dynamic library that cargo built together with this test.
fn library() -> PathBuf {
    let test = std::env::current_exe().unwrap();
    let library = test.with_file_name(format!("{DLL_PREFIX}sprung_plugin{DLL_SUFFIX}"));
    assert!(library.is_file(), "{}: cargo has not built the plugin's library", library.display());
    library
}
