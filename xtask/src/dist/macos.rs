//! A package for macOS: every file at its place on the system's disk, packed by Apple's tools.

use super::made::{Made, beside};
use super::sign;
use crate::bundle::{Format, property_list};
use crate::files::{copy, remove, write};
use crate::shell::run_to_end;
use std::path::Path;
use std::process::Command;

/// Environment variable: the identity that signs the package, a “Developer ID Installer”.
const INSTALLER_IDENTITY: &str = "SPRUNG_INSTALLER_IDENTITY";

/// Makes the package, where Apple's tools are.
pub(super) fn package(stage: &Path) -> Result<Made, String> {
    if !cfg!(target_os = "macos") {
        return Ok(Made::Nothing("the package: only macOS has pkgbuild".to_owned()));
    }
    let disk = stage.with_file_name("disk");
    lay_out(stage, &disk)?;
    let path = beside(stage, "pkg");
    let mut build = Command::new("pkgbuild");
    build.args(["--identifier", "org.sprung.package", "--version", env!("CARGO_PKG_VERSION"), "--root"]).arg(&disk);
    if let Ok(identity) = std::env::var(INSTALLER_IDENTITY) {
        build.args(["--sign", &identity, "--timestamp"]);
    }
    run_to_end(build.arg(&path), "pkgbuild")?;
    remove(&disk)?;
    if sign::run(sign::NOTARISE, &[&path])? {
        run_to_end(Command::new("xcrun").args(["stapler", "staple"]).arg(&path), "stapler")?;
    }
    Ok(Made::File(path))
}

/// Copies what was staged to its places on the disk.
fn lay_out(stage: &Path, disk: &Path) -> Result<(), String> {
    copy(&stage.join("bin/sprung"), &disk.join("usr/local/bin/sprung"))?;
    copy(&stage.join("man"), &disk.join("usr/local/share/man"))?;
    for file in ["manual", "LICENSE-APACHE", "LICENSE-MIT", "LICENSES-OF-CRATES.txt"] {
        copy(&stage.join(file), &disk.join("usr/local/share/doc/sprung").join(file))?;
    }
    let program = stage.join("bin/sprung-standalone");
    if program.is_file() {
        let plugins = disk.join("Library/Audio/Plug-Ins");
        for (format, folder) in [(Format::Clap, "CLAP"), (Format::Vst3, "VST3")] {
            copy(&stage.join(format.file_name()), &plugins.join(folder).join(format.file_name()))?;
        }
        let contents = disk.join("Applications/Sprung.app/Contents");
        copy(&program, &contents.join("MacOS/Sprung"))?;
        write(&contents.join("Info.plist"), &property_list("org.sprung.program", "APPL"))?;
        sign::run(sign::CODE, &[&disk.join("Applications/Sprung.app")])?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shell::root;

    #[test]
    fn files_are_laid_out_where_the_system_looks() {
        let folder = root().join("target/tmp").join(format!("disk-{}", std::process::id()));
        let (stage, disk) = (folder.join("stage"), folder.join("disk"));
        for file in ["bin/sprung", "man/man1/sprung.1", "manual/a.md", "LICENSE-APACHE", "LICENSE-MIT"] {
            write(&stage.join(file), file).unwrap();
        }
        write(&stage.join("LICENSES-OF-CRATES.txt"), "").unwrap();
        lay_out(&stage, &disk).unwrap();
        assert!(disk.join("usr/local/bin/sprung").is_file() && !disk.join("Library").exists(), "without the plugin");
        for file in ["bin/sprung-standalone", "Sprung.clap/Contents/MacOS/Sprung", "Sprung.vst3/Contents/MacOS/Sprung"]
        {
            write(&stage.join(file), file).unwrap();
        }
        lay_out(&stage, &disk).unwrap();
        for file in [
            "usr/local/share/man/man1/sprung.1",
            "Library/Audio/Plug-Ins/CLAP/Sprung.clap/Contents/MacOS/Sprung",
            "Library/Audio/Plug-Ins/VST3/Sprung.vst3/Contents/MacOS/Sprung",
            "Applications/Sprung.app/Contents/MacOS/Sprung",
        ] {
            assert!(disk.join(file).is_file(), "{file}");
        }
        let list = std::fs::read_to_string(disk.join("Applications/Sprung.app/Contents/Info.plist")).unwrap();
        assert!(list.contains("<string>APPL</string>") && list.contains("<string>Sprung</string>"), "{list}");
        remove(&folder).unwrap();
    }
}
