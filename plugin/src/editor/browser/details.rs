//! What can be done with the loaded sound in the browser: to use it, and to save it under a name.

use super::sounds::Sounds;
use crate::editor::controls::gestures::touch;
use crate::editor::controls::{Controls, Hint, Pick, Said};
use crate::editor::theme::{SMALL, TEXT, font};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::text::{is_entered, line, name_field, take_over};
use crate::loaded::Loaded;
use egui::{Align2, Id, Key, Rect, TextEdit, Ui, pos2, vec2};
use sprung::internals::library::{Library, Listed, check, made_from, tags_to_save};
use sprung::preset::{Playable, Preset};
use std::sync::Arc;

/// What became of a request of the user's.
pub(super) struct Outcome {
    pub(super) message: Said,
    /// Whether the list of sounds has changed.
    pub(super) is_stale: bool,
    /// Whether that was all the user had wanted here.
    pub(super) is_done: bool,
    /// Whether sounds like the loaded one are wanted.
    pub(super) compares: bool,
}

impl Outcome {
    /// What has worked has changed the list.
    fn of(message: Said) -> Self {
        Self { is_stale: message.is_ok(), message, is_done: false, compares: false }
    }
}

/// What is saved with a sound beside its name, as text.
struct About {
    author: String,
    /// With commas between them.
    tags: String,
    /// The comment, and as the field has it: in one line.
    comment: String,
    line: String,
    details: String,
    /// The sound that they were proposed for.
    loaded: Arc<Loaded>,
}

impl About {
    /// What is proposed for the loaded sound: what it has. What is made of a factory sound is not the factory's, and is not described as
    /// that is.
    fn of(controls: &Controls) -> Self {
        let sound = controls.params.state().into_sound();
        let factory = Preset::factory_at(0).map_or("", |preset| preset.author.as_str());
        let author = Some(sound.author()).filter(|author| *author != factory).unwrap_or_default();
        let [comment, details] = match made_from(&sound) {
            Some(name) => [format!("Made from {name}."), String::new()],
            None => [sound.comment().to_owned(), sound.details().to_owned()],
        };
        let tags = tags_to_save(&sound).join(", ");
        let line = in_a_line(&comment);
        Self { author: author.to_owned(), tags, comment, line, details, loaded: controls.params.loaded() }
    }

    /// Describes a sound.
    fn write(&self, sound: &mut Playable) {
        let tags = self.tags.split(',').map(str::trim).filter(|tag| !tag.is_empty()).map(str::to_owned);
        let comment = if self.line == in_a_line(&self.comment) { &self.comment } else { self.line.trim() };
        let texts = [comment.to_owned(), self.details.clone()];
        sound.describe(self.author.trim().to_owned(), tags.collect(), texts);
    }
}

/// A comment in one line, as a field has it.
fn in_a_line(comment: &str) -> String {
    comment.replace('\n', " ")
}

/// Height of each field of what is saved beside the name, and of all.
const FIELD: f32 = 26.0;
const ABOUT: f32 = 3.0 * FIELD;

/// The state of the text field.
#[derive(Default)]
pub(super) struct Details {
    /// The name to save under.
    pub(super) name: String,
    /// The sound's name that was in the field at first.
    of: String,
    /// A name whose file is replaced if the user saves again.
    confirm: Option<String>,
    /// What to save beside the name, once the user is about to save.
    about: Option<About>,
    /// Whether the field takes the focus when it is shown next.
    takes_name: bool,
    /// Whether a field was left by Escape in this pass.
    pub(super) is_left: bool,
}

impl Details {
    /// Resets the field to the name of the loaded sound. What was typed to be saved with it stays.
    pub(super) fn open(&mut self, name: &str) {
        let about = self.about.take().filter(|_| self.of == name);
        *self = Self { name: name.to_owned(), of: name.to_owned(), about, ..Self::default() };
    }

    /// Gives the field the focus when it is shown next.
    pub(super) fn take_name(&mut self) {
        self.takes_name = true;
    }

    /// Where the buttons for the sound begin in the column, above the fields that they need.
    pub(super) fn top(&self, rect: Rect) -> f32 {
        rect.bottom() - 84.0 - if self.about.is_some() { ABOUT } else { 0.0 }
    }

    /// Shows the buttons for a sound at the bottom of the column. `may_compare` says that no search for sounds like one is under way.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        shown: Option<&Listed>,
        may_compare: bool,
        sounds: &Sounds,
        controls: &mut Controls,
    ) -> Option<Outcome> {
        let palette = controls.palette;
        self.is_left = false;
        let is_escaped = ui.input(|input| input.key_pressed(Key::Escape));
        let name = controls.params.name();
        // Undo, or a host, may have brought another sound back.
        if self.of != name {
            self.open(&name);
        }
        let mut enters = false;
        // Another sound may have been loaded since, by other ways than this list.
        self.about.take_if(|about| !Arc::ptr_eq(&about.loaded, &controls.params.loaded()));
        if let Some(about) = &mut self.about {
            let fields = [
                ("by", "Author of the saved sound", "your name", &mut about.author),
                ("tags", "Tags of the saved sound", "with commas between", &mut about.tags),
                ("about", "Description of the saved sound", "what it is", &mut about.line),
            ];
            for (row, (title, name, hint, text)) in fields.into_iter().enumerate() {
                let top = rect.bottom() - 54.0 - ABOUT + row as f32 * FIELD;
                let place = Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), 24.0));
                line(ui.painter(), place, Align2::LEFT_CENTER, title, SMALL, palette.muted);
                let edit = TextEdit::singleline(text).id(Id::unique(name)).hint_text(hint);
                let place = place.with_min_x(place.left() + 34.0);
                let response = ui.put(place, edit.font(font(TEXT)).margin(vec2(6.0, 4.0)));
                name_field(&response, name, text);
                enters |= is_entered(&response);
                self.is_left |= is_escaped && response.lost_focus();
            }
        }
        // Who types a name wants to save.
        let [use_look, save_look] =
            if self.about.is_some() { [Look::Plain, Look::Main] } else { [Look::Main, Look::Plain] };
        let row = Rect::from_min_size(pos2(rect.left(), self.top(rect)), vec2(rect.width(), 24.0));
        let (uses, similar) = row.split_left_right_at_fraction(0.42);
        let response = button(ui, uses.with_max_x(uses.right() - 4.0), "Use it", "Use this sound", use_look, palette);
        if response.hovered() {
            *controls.hint = Hint::new("Use it", "Keeps this sound and closes the list, as Enter does.");
        }
        if response.clicked() {
            return Some(Outcome { is_stale: false, is_done: true, ..Outcome::of(Ok(String::new())) });
        }
        let look = if controls.params.is_preset() && may_compare { Look::Plain } else { Look::Disabled };
        if button(ui, similar, "More like this", "Find sounds like this one", look, palette).clicked() {
            return Some(Outcome { compares: true, is_stale: false, ..Outcome::of(Ok(String::new())) });
        }
        let row = Rect::from_min_max(pos2(rect.left(), rect.bottom() - 54.0), pos2(rect.right(), rect.bottom() - 30.0));
        let elsewhere = row.with_min_x(row.right() - 24.0);
        let field = row.with_max_x(elsewhere.left() - 4.0);
        let id = Id::unique("save name");
        let edit = TextEdit::singleline(&mut self.name).id(id).hint_text("a name");
        let response = ui.put(field, edit.font(font(TEXT)).margin(vec2(6.0, 4.0)));
        name_field(&response, "Name to save under", &self.name);
        if std::mem::take(&mut self.takes_name) {
            take_over(ui, id, &self.name);
        }
        if response.has_focus() && self.about.is_none() {
            self.about = Some(About::of(controls));
            ui.ctx().request_repaint();
        }
        enters |= is_entered(&response);
        self.is_left |= is_escaped && response.lost_focus();
        let response = button(ui, elsewhere, "…", "Save in another folder", Look::Plain, palette);
        if response.hovered() {
            *controls.hint = Hint::new("Save in another folder", "A copy, in any folder.");
        }
        if response.clicked() {
            let sound = self.sound(controls);
            // Before a folder is looked for.
            if let Err(error) = check(&sound) {
                self.takes_name = true;
                return Some(Outcome::of(Err(error.to_string())));
            }
            controls.interaction.pick = Some(Pick::Place(Box::new(sound)));
        }
        let wide = (rect.width() - 8.0) / 3.0;
        let save = Rect::from_min_size(pos2(rect.left(), rect.bottom() - 24.0), vec2(wide, 24.0));
        let rename = save.translate(vec2(wide + 4.0, 0.0));
        let bin = rename.translate(vec2(wide + 4.0, 0.0));
        let own = shown.filter(|sound| sound.path.is_some());
        let text = if self.confirm.is_some() { "Replace" } else { "Save" };
        let response = button(ui, save, text, "Save under this name", save_look, palette);
        if response.hovered() {
            let folder = sounds.library.as_ref().map(|library| library.presets_folder().display().to_string());
            *controls.hint = Hint::new("Save", folder.unwrap_or_default());
        }
        if enters || response.clicked() {
            let outcome = self.save(sounds, controls);
            // Enter is pressed again, or the name is corrected.
            self.takes_name = enters && !outcome.is_stale;
            return Some(Outcome { is_done: enters && outcome.is_stale, ..outcome });
        }
        let look = if own.is_some() { Look::Plain } else { Look::Disabled };
        if button(ui, rename, "Rename", "Give your sound this name", look, palette).clicked()
            && let (Some(own), Some(library)) = (own, &sounds.library)
        {
            return Some(self.rename(own, library, controls));
        }
        if button(ui, bin, "Bin", "Move your sound to the bin", look, palette).clicked()
            && let (Some(path), Some(library)) = (own.and_then(|own| own.path.as_ref()), &sounds.library)
        {
            let moved = library.discard(path).map(|place| format!("moved to {}", place.display()));
            return Some(Outcome::of(moved.map_err(|error| error.to_string())));
        }
        None
    }

    /// Renames a file of the user's. The sound stays a favourite, if it is one, and a recent one under the new name.
    fn rename(&mut self, own: &Listed, library: &Library, controls: &mut Controls) -> Outcome {
        let name = self.name.trim().to_owned();
        let Some(path) = &own.path else { return Outcome::of(Err(String::new())) };
        let path = match library.rename(path, &name) {
            Ok(path) => path,
            Err(error) => return Outcome::of(Err(error.to_string())),
        };
        // In this order, since the new name may be the old one.
        let star = || -> sprung::Result<()> {
            if library.favourites()?.contains(own.name()) {
                library.set_favourite(own.name(), false)?;
                library.set_favourite(&name, true)?;
            }
            library.note_recent(&name)
        };
        let starred = star().map_err(|error| format!("renamed, but its place in lists may be lost: {error}"));
        if controls.params.name() == own.name() {
            controls.params.rename(name);
            touch(controls.params, controls.host);
            controls.history.begin_trial();
        }
        Outcome { is_stale: true, ..Outcome::of(starred.map(|()| format!("renamed {}", path.display()))) }
    }

    /// The present sound as it is saved.
    fn sound(&mut self, controls: &Controls) -> Playable {
        let mut sound = controls.params.state().into_sound();
        sound.rename(self.name.trim());
        self.about.get_or_insert_with(|| About::of(controls)).write(&mut sound);
        sound
    }

    fn save(&mut self, sounds: &Sounds, controls: &mut Controls) -> Outcome {
        let name = self.name.trim().to_owned();
        let replace = self.confirm.take().is_some_and(|confirmed| confirmed == name);
        let Some(library) = &sounds.library else {
            return Outcome::of(Err("the system does not say where your data is kept".to_owned()));
        };
        let sound = self.sound(controls);
        Outcome::of(match library.save(&sound, replace) {
            Ok(path) => {
                controls.params.rename(name);
                controls.params.describe_as(&sound);
                touch(controls.params, controls.host);
                controls.history.saved(controls.params);
                Ok(format!("saved {}", path.display()))
            }
            Err(sprung::Error::Exists { path }) => {
                self.confirm = Some(name);
                Err(format!("{path} exists; Enter again, or Replace, writes over it"))
            }
            Err(error) => Err(error.to_string()),
        })
    }
}
