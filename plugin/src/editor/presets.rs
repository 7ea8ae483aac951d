//! The top of the window: factory presets, preset and kit files, and the last message.

use super::gestures::{announce, positions};
use crate::params::SprungParams;
use crate::state::State;
use egui::{ComboBox, TextEdit, Ui};
use nice_plug_core::context::gui::GuiContext;
use sprung::io::{Inputs, Output, Target};
use sprung::preset::{Playable, Preset, Replaced};
use std::fs::File;
use std::io::Write as _;
use std::path::Path;

/// The text that the user is typing, and the last message.
#[derive(Default)]
pub(super) struct Presets {
    path: String,
    message: String,
    /// A path whose file is replaced if the user saves to it again.
    confirm: Option<String>,
}

impl Presets {
    pub(super) fn show(&mut self, ui: &mut Ui, params: &SprungParams, host: &GuiContext) {
        ui.horizontal(|ui| {
            let name = params.name();
            ComboBox::from_id_salt("presets").selected_text(name.as_str()).width(220.0).height(400.0).show_ui(
                ui,
                |ui| {
                    for preset in Preset::factory() {
                        if ui.selectable_label(preset.name == name, &preset.name).clicked() {
                            self.message.clear();
                            load(Playable::Preset(preset.clone()), params, host);
                        }
                    }
                },
            );
            let path = TextEdit::singleline(&mut self.path).hint_text("path of a preset or kit file, …/name.toml");
            ui.add(path.desired_width(ui.available_width() - 110.0));
            if ui.button("Load").clicked() {
                self.message = match read(&self.path) {
                    Ok((playable, remarks)) => {
                        load(playable, params, host);
                        [vec![format!("loaded {}", self.path)], remarks].concat().join("; ")
                    }
                    Err(message) => message,
                };
            }
            if ui.button("Save").clicked() {
                self.save(params);
            }
        });
        if !self.message.is_empty() {
            ui.label(&self.message);
        }
        let complaints = params.complaints();
        if let Some(line) = summary(&complaints) {
            ui.colored_label(ui.visuals().warn_fg_color, line).on_hover_text(complaints.join("\n"));
        }
    }

    fn save(&mut self, params: &SprungParams) {
        let replace = self.confirm.take().is_some_and(|path| path == self.path);
        let Playable::Preset(preset) = params.state().playable else {
            self.message =
                "a kit is kept in the project with its presets: only single presets are saved as files".to_owned();
            return;
        };
        self.message = match write(preset, &self.path, replace) {
            Ok(name) => {
                params.rename(name);
                format!("saved {}", self.path)
            }
            Err(sprung::Error::Exists { path }) => {
                self.confirm = Some(self.path.clone());
                format!("{path}: the file exists; press Save again to replace it")
            }
            Err(error) => error.to_string(),
        };
    }
}

/// A message about the project's last state, if not all of it was understood: the first complaint, and the number of
/// others.
fn summary(complaints: &[String]) -> Option<String> {
    let [first, rest @ ..] = complaints else { return None };
    let rest = if rest.is_empty() { String::new() } else { format!(" (and {} more)", rest.len()) };
    Some(format!("Not all of the project’s state was understood: {first}{rest}"))
}

/// Loads a preset or kit, and tells the host the new knob positions.
pub(super) fn load(playable: Playable, params: &SprungParams, host: &GuiContext) {
    let State { seed, view, .. } = params.state();
    let before = positions(params);
    params.load(State::new(playable, seed, view).into());
    announce(params, host, &before);
}

/// Reads a preset or kit file. Returns it with a remark about each retired parameter in it.
fn read(path: &str) -> Result<(Playable, Vec<String>), String> {
    let mut open =
        |path: &Path| File::open(path).map_err(|source| sprung::Error::io(path.display().to_string(), source));
    let mut remarks = vec![];
    let mut remark = |_: &str, replaced: Replaced| remarks.push(replaced.to_string());
    let read = check(path).and_then(|path| Playable::read(path, &mut open, &mut remark));
    read.map(|playable| (playable, remarks)).map_err(|error| error.to_string())
}

/// Writes a preset file, so that an interrupted save leaves the old file. The preset gets the file's name; returns that
/// name.
fn write(mut preset: Preset, path: &str, replace: bool) -> sprung::Result<String> {
    let path = check(path)?;
    preset.name = path.file_stem().unwrap_or_default().to_string_lossy().trim().to_owned();
    let text = preset.to_toml();
    // A file name may not be a valid preset name, and a saved preset must load again.
    Preset::parse(&text, &path.display().to_string())?;
    let mut output = Output::create(&Target::new(path), replace, &Inputs::default())?;
    let written = output.stream().write_all(text.as_bytes());
    written.map_err(|source| sprung::Error::io(path.display().to_string(), source))?;
    output.commit()?;
    Ok(preset.name)
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
    fn presets_are_saved_whole_and_replaced_only_when_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("my sound.toml").display().to_string();
        let [bell, kick] = ["Church Bell", "Kick"].map(|name| Preset::find(name).unwrap());
        assert_eq!(write(bell.clone(), &path, false).unwrap(), "my sound");
        let renamed = |preset: &Preset| {
            (Playable::Preset(Preset { name: "my sound".to_owned(), ..preset.clone() }), Vec::<String>::new())
        };
        assert_eq!(read(&path).unwrap(), renamed(bell));
        assert!(matches!(write(kick.clone(), &path, false), Err(sprung::Error::Exists { .. })));
        assert_eq!(read(&path).unwrap(), renamed(bell));
        write(kick.clone(), &path, true).unwrap();
        assert_eq!(read(&path).unwrap(), renamed(kick));
    }

    #[test]
    fn a_preset_that_would_not_load_is_not_saved() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(format!("{}.toml", "n".repeat(101))).display().to_string();
        let error = write(Preset::find("Kick").unwrap().clone(), &path, false).unwrap_err().to_string();
        assert!(error.contains("name: expected one line of at most 100 characters"), "{error}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

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
