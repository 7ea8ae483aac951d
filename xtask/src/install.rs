//! `cargo xtask install` and `uninstall`: copies the bundles to the folders in which DAWs look for plugins.

use crate::bundle::{self, Format};
use crate::files;
use crate::system::{Profile, System};
use std::path::PathBuf;

/// For which users the plugin is installed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scope {
    User,
    System,
}

/// The folder in which DAWs look, by CLAP's entry.h and the VST 3 SDK's "VST 3 Locations and Format".
fn folder(format: Format, scope: Scope) -> Result<PathBuf, String> {
    let name = match format {
        Format::Clap => "CLAP",
        Format::Vst3 => "VST3",
    };
    let from = |variable: &str| {
        let value = std::env::var_os(variable).filter(|value| !value.is_empty());
        value.map(PathBuf::from).ok_or_else(|| format!("{variable} is not set, so there is no telling where DAWs look"))
    };
    Ok(match (std::env::consts::OS, scope) {
        ("windows", Scope::User) => from("LOCALAPPDATA")?.join("Programs/Common").join(name),
        ("windows", Scope::System) => from("COMMONPROGRAMFILES")?.join(name),
        ("macos", Scope::User) => from("HOME")?.join("Library/Audio/Plug-Ins").join(name),
        ("macos", Scope::System) => PathBuf::from("/Library/Audio/Plug-Ins").join(name),
        (_, Scope::User) => from("HOME")?.join(format!(".{}", name.to_lowercase())),
        (_, Scope::System) => PathBuf::from("/usr/lib").join(name.to_lowercase()),
    })
}

/// Builds the plugin for release and copies it to the folders in which DAWs look.
pub(crate) fn install(scope: Scope) -> Result<(), String> {
    let folders = Format::ALL.map(|format| folder(format, scope).map(|folder| (format, folder)));
    let bundles = bundle::run(&System::own(), Profile::Release)?;
    for place in folders {
        let (format, folder) = place?;
        let to = folder.join(format.file_name());
        files::make_folder_of(&to)
            .and_then(|()| files::replace(&to, |aside| files::copy(&bundles.join(format.file_name()), aside)))
            .map_err(|message| explain(message, scope))?;
        println!("installed {}", to.display());
    }
    println!(
        "now let your DAW scan its plugins again (how: assets/manual/daw.md); without a DAW: cargo xtask standalone"
    );
    Ok(())
}

/// Removes the bundles that `install` has copied.
pub(crate) fn uninstall(scope: Scope) -> Result<(), String> {
    for format in Format::ALL {
        let path = folder(format, scope)?.join(format.file_name());
        let was_there = files::remove(&path).map_err(|message| explain(message, scope))?;
        println!("{} {}", if was_there { "removed" } else { "not there:" }, path.display());
    }
    Ok(())
}

fn explain(message: String, scope: Scope) -> String {
    let advice = match scope {
        Scope::User => "",
        Scope::System => "; --system needs an administrator's rights, --user does not",
    };
    format!("{message}{advice}")
}
