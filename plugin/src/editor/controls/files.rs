//! Loads sounds: those that the window lists, and preset and kit files given by path.

use super::gestures;
use crate::params::SprungParams;
use crate::state::State;
use nice_plug_core::context::gui::GuiContext;
use sprung::preset::{Playable, Preset, Replaced};
use std::fs::File;
use std::path::Path;

/// A message if the last state that was loaded was not understood completely: the first complaint, and the number of
/// the others.
pub(crate) fn summary(complaints: &[String]) -> Option<String> {
    let [first, rest @ ..] = complaints else { return None };
    let rest = if rest.is_empty() { String::new() } else { format!(" (and {} more)", rest.len()) };
    Some(format!("Not all of the project’s state was understood: {first}{rest}"))
}

/// Loads a preset or kit, and tells the host the new knob positions.
pub(crate) fn load(playable: Playable, params: &SprungParams, host: &GuiContext) {
    let State { seed, view, .. } = params.state();
    gestures::load(State::new(playable, seed, view), params, host);
}

/// The factory sound at this distance from the named one, in the order of the list.
pub(crate) fn neighbour(name: &str, places: isize) -> Option<&'static Preset> {
    let all = Preset::factory();
    let place = all.iter().position(|preset| preset.name == name).unwrap_or(0);
    all.get((place as isize + places).rem_euclid(all.len() as isize) as usize)
}

/// Reads a preset or kit file. Returns it with a remark about each retired parameter in it.
pub(crate) fn read(path: &str) -> Result<(Playable, Vec<String>), String> {
    let mut open = |path: &Path| open(path, &path.display().to_string(), "a preset, kit, scale or mapping");
    let mut remarks = vec![];
    let mut remark = |_: &str, replaced: Replaced| remarks.push(replaced.to_string());
    let read = check(path).and_then(|path| Playable::read(path, &mut open, &mut remark));
    read.map(|playable| (playable, remarks)).map_err(|error| error.to_string())
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
    fn kits_are_read_and_what_was_not_understood_is_told_in_a_line() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../assets/kits/acoustic-kit.toml");
        let path = std::fs::canonicalize(path).unwrap().display().to_string();
        assert!(matches!(read(&path), Ok((Playable::Kit(_), _))));
        let lines = ["a", "b", "c"].map(str::to_owned);
        assert_eq!(summary(&[]), None);
        assert_eq!(summary(&lines[..1]).as_deref(), Some("Not all of the project’s state was understood: a"));
        assert!(summary(&lines).unwrap().ends_with(": a (and 2 more)"));
    }
}
