//! Files dropped on the window: presets and kits are imported, scales and mappings tune the sound, recordings are fitted.

pub(super) mod fitting;
mod recordings;

use crate::editor::controls::{Controls, Said};
use crate::editor::pages::tuning;
use crate::files;
use egui::Ui;
use sprung::internals::library::Library;
use std::path::{Path, PathBuf};

/// The endings of files that can be dropped.
pub(super) const SOUNDS: [&str; 1] = ["toml"];
pub(super) const SCALES: [&str; 2] = ["scl", "kbm"];
pub(super) const RECORDINGS: [&str; 9] = ["aif", "aifc", "aiff", "flac", "mp3", "oga", "ogg", "wav", "wave"];

/// The files that were dropped since the last pass.
pub(super) fn dropped(ui: &Ui) -> Vec<PathBuf> {
    ui.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect())
}

/// Whether a file has one of these endings, in small or capital letters.
pub(super) fn has_ending(path: &Path, endings: &[&str]) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    endings.iter().any(|wanted| ending.eq_ignore_ascii_case(wanted))
}

/// Whether the file's extension is that of a recording.
pub(super) fn is_recording(path: &Path) -> bool {
    has_ending(path, &RECORDINGS)
}

/// Handles a dropped file that is not a recording. Returns a message.
pub(super) fn take(path: &Path, library: Option<&Library>, controls: &mut Controls) -> Said {
    if has_ending(path, &SCALES) {
        tuning::take(path, controls)
    } else if has_ending(path, &SOUNDS) {
        sound(path, library, controls)
    } else {
        Err(format!(
            "{}: expected a recording (.wav, .flac …), a preset or kit (.toml), a scale (.scl) or a keyboard mapping (.kbm)",
            path.display()
        ))
    }
}

/// Loads a preset or kit. One from elsewhere is copied to the user's folder, if there is one.
fn sound(path: &Path, library: Option<&Library>, controls: &mut Controls) -> Said {
    let read = files::read(path);
    let imported = read.and_then(|sound| match library.filter(|library| !library.has(path)) {
        Some(library) => {
            let (sound, place) = library.import(sound)?;
            let message = format!("imported as “{}”, {}", sound.name(), place.display());
            Ok((sound, message))
        }
        None => Ok((sound, format!("loaded {}", path.display()))),
    });
    let (sound, message) = imported.map_err(|error| error.to_string())?;
    controls.history.load(sound, controls.params, controls.host);
    Ok(message)
}
