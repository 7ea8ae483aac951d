//! Loads sounds: those that the window lists, and preset and kit files given by path.

use super::gestures;
use crate::params::SprungParams;
use crate::state::State;
use nice_plug_core::context::gui::GuiContext;
use sprung::preset::Playable;
use std::fs::File;
use std::path::Path;

/// Loads a preset or kit, and tells the host the new knob positions.
pub(crate) fn load(playable: Playable, params: &SprungParams, host: &GuiContext) {
    let State { seed, view, .. } = params.state();
    gestures::load(State::new(playable, seed, view), params, host);
}

/// Reads a preset or kit file.
pub(crate) fn read(path: &str) -> Result<Playable, String> {
    let mut open = |path: &Path| open(path, &path.display().to_string(), "a preset, kit, scale or mapping");
    check(path).and_then(|path| Playable::read(path, &mut open)).map_err(|error| error.to_string())
}

/// Opens a file, and nothing else: opening a pipe would block the window.
pub(crate) fn open(path: &Path, name: &str, expected: &str) -> sprung::Result<File> {
    let failed = |source| sprung::Error::io(name, source);
    if !std::fs::metadata(path).map_err(failed)?.is_file() {
        return Err(sprung::Error::format(name, format!("this is not a file: expected {expected}")));
    }
    File::open(path).map_err(failed)
}

/// Only full paths are accepted, since users do not know a host's working folder.
fn check(path: &str) -> sprung::Result<&Path> {
    let path = Path::new(path);
    if path.is_absolute() && path.extension().is_some_and(|extension| extension == "toml") {
        return Ok(path);
    }
    let example = if cfg!(windows) { "C:\\Sounds\\bell.toml" } else { "/home/me/bell.toml" };
    Err(sprung::Error::value(path.display().to_string(), format!("expected a whole path, such as {example}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_whole() {
        for path in ["", "bell.toml", "/tmp/bell", "-"] {
            let error = read(path).unwrap_err();
            assert!(error.contains("expected a whole path, such as "), "{error}");
        }
    }

    #[test]
    fn kits_are_read() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/kits/acoustic-kit.toml");
        let path = std::fs::canonicalize(path).unwrap().display().to_string();
        assert!(matches!(read(&path), Ok(Playable::Kit(_))));
    }
}
