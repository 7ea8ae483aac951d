//! `cargo xtask bundle`: the plugin as the files that DAWs load.

use crate::shell::{cargo, root};
use std::fs;
use std::path::{Path, PathBuf};

/// A plugin format.
#[derive(Clone, Copy)]
pub(crate) enum Format {
    Clap,
    Vst3,
}

impl Format {
    pub(crate) const ALL: [Format; 2] = [Format::Clap, Format::Vst3];

    /// What the bundle is called, on every system.
    pub(crate) fn file_name(self) -> &'static str {
        match self {
            Self::Clap => "Sprung.clap",
            Self::Vst3 => "Sprung.vst3",
        }
    }

    /// Where the library lies within the bundle; empty if it is the bundle.
    fn library(self) -> PathBuf {
        let (architecture, system) = (std::env::consts::ARCH, std::env::consts::OS);
        // VST 3 SDK, "VST 3 Locations and Format": Windows has a name of its own for 64-bit ARM.
        let architecture = if (system, architecture) == ("windows", "aarch64") { "arm64" } else { architecture };
        match (self, system) {
            (_, "macos") => "Contents/MacOS/Sprung".into(),
            (Self::Clap, _) => PathBuf::new(),
            (Self::Vst3, "windows") => format!("Contents/{architecture}-win/Sprung.vst3").into(),
            (Self::Vst3, _) => format!("Contents/{architecture}-linux/Sprung.so").into(),
        }
    }
}

/// Builds the plugin and puts the bundles into `target/bundled`, which it gives.
pub(crate) fn run(release: bool) -> Result<PathBuf, String> {
    // What a debugger would want is most of the library's size.
    let (profile, linking) = if release { ("--release", "-- -C strip=symbols") } else { ("", "") };
    let mut build = cargo(&format!(
        "rustc --package sprung-plugin --lib --crate-type cdylib --target-dir target {profile} {linking}"
    ));
    if !build.status().map_err(|error| format!("cargo: {error}"))?.success() {
        return Err("the plugin does not build".to_owned());
    }
    let library = format!("{}sprung_plugin{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let library = root().join("target").join(if release { "release" } else { "debug" }).join(library);
    let folder = root().join("target/bundled");
    for format in Format::ALL {
        let bundle = folder.join(format.file_name());
        replace(&bundle, |aside| fill(format, &library, aside))?;
        println!("{}", bundle.display());
    }
    Ok(folder)
}

/// Writes a bundle to a path where nothing is.
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

/// What macOS wants to know of a bundle.
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

/// Replaces what is at `path` by what `fill` makes at the path that it is given: nothing is ever half there, and if
/// `fill` fails, what was there stays.
pub(crate) fn replace(path: &Path, fill: impl FnOnce(&Path) -> Result<(), String>) -> Result<(), String> {
    let beside = |suffix: &str| {
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(format!(".{suffix}-{}", std::process::id()));
        path.with_file_name(name)
    };
    let (new, old) = (beside("new"), beside("old"));
    let result = fill(&new).and_then(|()| {
        let existed = path.symlink_metadata().is_ok();
        if existed {
            fs::rename(path, &old).map_err(|error| format!("{}: {error}", path.display()))?;
        }
        fs::rename(&new, path).map_err(|error| {
            if existed {
                let _ = fs::rename(&old, path);
            }
            format!("{}: {error}", path.display())
        })
    });
    // What is left over of either is of no use, and the result says what matters.
    let _ = remove(&new);
    let _ = remove(&old);
    result
}

/// Removes a file or a folder with all that is in it. Gives whether there was one.
pub(crate) fn remove(path: &Path) -> Result<bool, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", path.display());
    match path.symlink_metadata() {
        Ok(about) if about.is_dir() => fs::remove_dir_all(path).map(|()| true).map_err(failed),
        Ok(_) => fs::remove_file(path).map(|()| true).map_err(failed),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(failed(error)),
    }
}

/// Copies a file, or a folder with all that is in it, and makes the folders above.
pub(crate) fn copy(from: &Path, to: &Path) -> Result<(), String> {
    if !from.is_dir() {
        make_folder_of(to)?;
        return fs::copy(from, to)
            .map(drop)
            .map_err(|error| format!("{} to {}: {error}", from.display(), to.display()));
    }
    for entry in fs::read_dir(from).map_err(|error| format!("{}: {error}", from.display()))? {
        let entry = entry.map_err(|error| format!("{}: {error}", from.display()))?;
        copy(&entry.path(), &to.join(entry.file_name()))?;
    }
    Ok(())
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    make_folder_of(path)?;
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

pub(crate) fn make_folder_of(path: &Path) -> Result<(), String> {
    let folder = path.parent().unwrap_or(path);
    fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bundle_is_replaced_whole_or_not_at_all() {
        let folder = root().join("target/tmp").join(format!("bundle-{}", std::process::id()));
        let bundle = folder.join("Sprung.vst3");
        for text in ["first", "second"] {
            replace(&bundle, |aside| write(&aside.join("Contents/a"), text)).unwrap();
            assert_eq!(fs::read_to_string(bundle.join("Contents/a")).unwrap(), text);
        }
        let failed = replace(&bundle, |aside| write(&aside.join("Contents/a"), "half").and(Err("no".to_owned())));
        assert_eq!(failed, Err("no".to_owned()));
        assert_eq!(fs::read_to_string(bundle.join("Contents/a")).unwrap(), "second");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "nothing is left beside it");
        assert_eq!(remove(&folder), Ok(true));
        assert_eq!(remove(&folder), Ok(false));
    }
}
