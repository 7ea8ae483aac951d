//! A list of folders and files, in which files are chosen to be opened, or a place to save a sound.
//!
//! The systems' own dialogs differ in what they need: a portal that many Linux systems lack, or a host's main thread, which
//! waits for them. This one is the same everywhere and waits for nothing.

mod listing;

use super::controls::{Controls, Hint, Pick, Said};
use super::drops;
use super::theme::{GAP, PADDING, SMALL, TEXT, font, paint_panel};
use super::widgets::buttons::{Look, button};
use super::widgets::list;
use super::widgets::progress::PAUSE;
use super::widgets::text::{is_entered, line, name_field, take_over};
use crate::editor::background::Background;
use egui::{Align2, Id, Rect, Role, ScrollArea, Sense, TextEdit, Ui, UiBuilder, WidgetInfo, pos2, vec2};
use listing::{Entry, Listing};
use sprung::internals::library::{Library, export};
use sprung::internals::text::file_stem;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Height of a row of the list, and least width of a column.
const ROW: f32 = 22.0;
const COLUMN: f32 = 230.0;
/// Width of the places at the left, and of buttons.
const SIDE: f32 = 96.0;
const BUTTON: f32 = 72.0;

/// What became of it.
pub(super) enum Picked {
    Nothing,
    /// These files are to be opened.
    Files(Vec<PathBuf>),
    /// The sound was saved.
    Saved(String),
}

/// The state of the list.
#[derive(Default)]
pub(super) struct Picker {
    pick: Option<Pick>,
    listing: Listing,
    /// Folders to go to from anywhere.
    places: Vec<Entry>,
    /// The folder that is being read, and the search for places.
    work: Option<Background<Listing>>,
    search: Option<Background<Vec<Entry>>>,
    chosen: BTreeSet<PathBuf>,
    /// The path that is shown or typed, and the name of the file to save.
    path: String,
    name: String,
    /// Whether the path is being typed, so that a folder that arrives late does not write over it.
    is_typed: bool,
    /// Whether the field for what is most likely typed takes the focus.
    takes_focus: bool,
    /// Whether nothing was shown yet, and what had the focus then.
    is_new: bool,
    before: Option<Id>,
    /// A path that is written over if the user saves again.
    confirm: Option<PathBuf>,
    complaint: String,
}

impl Picker {
    /// Prepares for being shown, in the folder that was shown last.
    pub(super) fn open(&mut self, pick: Pick, library: Option<&Library>) {
        if let Pick::Place(sound) = &pick {
            self.name = format!("{}.toml", file_stem(sound.name()));
        }
        (self.pick, self.takes_focus, self.is_new) = (Some(pick), true, true);
        self.search = listing::find_places(library.map(Library::presets_folder)).ok();
        let last = self.listing.folder.clone();
        let first = || std::env::home_dir().unwrap_or_else(|| PathBuf::from("/"));
        self.go(if last.as_os_str().is_empty() { first() } else { last });
    }

    /// Ends the reading of a folder.
    pub(super) fn close(&mut self) {
        (self.work, self.search) = (None, None);
    }

    fn go(&mut self, path: PathBuf) {
        self.chosen.clear();
        (self.complaint, self.confirm, self.is_typed) = (String::new(), None, false);
        let endings = match self.pick {
            Some(Pick::Scale) => drops::SCALES.to_vec(),
            Some(Pick::Place(_)) => drops::SOUNDS.to_vec(),
            _ => [&drops::SOUNDS[..], &drops::SCALES, &drops::RECORDINGS].concat(),
        };
        if !path.is_absolute() {
            // Nobody knows a host's working folder.
            self.complaint = format!("{}: expected a whole path", path.display());
            return;
        }
        match listing::start(path, endings) {
            Ok(work) => self.work = Some(work),
            Err(message) => self.complaint = message,
        }
    }

    /// Takes over the folder that has been read, and the places. Returns the file whose path was typed.
    fn follow(&mut self, ui: &Ui) -> Option<PathBuf> {
        if let Some(search) = &mut self.search {
            ui.ctx().request_repaint_after(PAUSE);
            if let Some(ended) = search.take() {
                (self.search, self.places) = (None, ended.unwrap_or_default());
            }
        }
        let Some(ended) = self.work.as_mut()?.take() else {
            ui.ctx().request_repaint_after(PAUSE);
            return None;
        };
        self.work = None;
        match ended {
            Ok(listing) => {
                if !self.is_typed {
                    self.path = listing.folder.display().to_string();
                    // Its field has the focus: it is marked again, so that typing replaces it.
                    if ui.memory(|memory| memory.has_focus(Id::unique("path"))) {
                        take_over(ui, Id::unique("path"), &self.path);
                    }
                }
                self.chosen.clear();
                self.listing = listing;
                self.listing.file.take()
            }
            Err(message) => {
                self.complaint = message;
                None
            }
        }
    }

    /// Shows the list. Returns what became of it, when the user is done.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        library: Option<&Library>,
        controls: &mut Controls,
    ) -> Option<Picked> {
        let palette = controls.palette;
        paint_panel(ui.painter(), rect, palette);
        let inner = rect.shrink(PADDING);
        let focused = ui.memory(|memory| memory.focused());
        if std::mem::take(&mut self.is_new) {
            self.before = focused;
        }
        // A user who was quicker keeps the focus where it is.
        self.takes_focus &= focused.is_none() || focused == self.before;
        let typed = self.follow(ui);
        let saves = matches!(self.pick, Some(Pick::Place(_)));
        if let Some(name) = typed.as_ref().and_then(|file| file.file_name()).filter(|_| saves) {
            self.name = name.to_string_lossy().into_owned();
        }
        let mut wanted = typed.filter(|_| !saves).map(|file| vec![file]);

        let top = inner.with_max_y(inner.top() + 24.0);
        let up = top.with_max_x(top.left() + 44.0);
        let parent = self.listing.folder.parent().map(Path::to_owned);
        let look = if parent.is_some() { Look::Plain } else { Look::Disabled };
        let mut to = None;
        if button(ui, up, "Up", "Folder above", look, palette).clicked() {
            to = parent;
        }
        let cancel = top.with_min_x(top.right() - BUTTON);
        let field = Rect::from_min_max(pos2(up.right() + GAP, top.top()), pos2(cancel.left() - GAP, top.bottom()));
        let edit = TextEdit::singleline(&mut self.path).id(Id::unique("path")).hint_text("a folder or file");
        let response = ui.put(field, edit.font(font(TEXT)).margin(vec2(6.0, 4.0)));
        name_field(&response, "Path of a folder or file", &self.path);
        // When what is there is known, so that the first letter replaces it.
        if self.takes_focus && self.work.is_none() {
            self.takes_focus = false;
            let (field, text) = if saves { ("file name", &self.name) } else { ("path", &self.path) };
            take_over(ui, Id::unique(field), text);
        }
        self.is_typed |= response.changed();
        if is_entered(&response) {
            to = Some(PathBuf::from(self.path.trim()));
        }
        if button(ui, cancel, "Cancel", "Choose no file", Look::Plain, palette).clicked() {
            return Some(Picked::Nothing);
        }

        let bottom = inner.with_min_y(inner.bottom() - 24.0);
        let told = if self.complaint.is_empty() { 0.0 } else { 18.0 };
        let foot = bottom.right_top() - vec2(0.0, GAP + told);
        let middle = Rect::from_min_max(top.left_bottom() + vec2(0.0, GAP), foot);
        let complaint = Rect::from_min_max(pos2(inner.left(), foot.y), foot + vec2(0.0, told));
        line(ui.painter(), complaint, Align2::LEFT_CENTER, &self.complaint, SMALL, palette.warning);
        to = self.places(ui, middle.with_max_x(middle.left() + SIDE), controls).or(to);
        let list = middle.with_min_x(middle.left() + SIDE + 2.0 * GAP);
        let (entered, opened) = self.list(ui, list, saves, controls);
        to = entered.or(to);
        wanted = wanted.or(opened.map(|file| vec![file]));

        let main = bottom.with_min_x(bottom.right() - BUTTON);
        let rest = bottom.with_max_x(main.left() - GAP).with_min_x(list.left());
        if saves {
            let edit = TextEdit::singleline(&mut self.name).id(Id::unique("file name")).hint_text("a name");
            let response = ui.put(rest, edit.font(font(TEXT)).margin(vec2(6.0, 4.0)));
            name_field(&response, "Name of the file", &self.name);
            let text = if self.confirm.is_some() { "Replace" } else { "Save" };
            // What is shown is where it is saved.
            let is_there = self.work.is_none() && self.path == self.listing.folder.display().to_string();
            let look = if is_there { Look::Main } else { Look::Disabled };
            let is_asked = button(ui, main, text, "Save in this folder", look, palette).clicked();
            if is_there && (is_asked || is_entered(&response)) {
                match self.save(library) {
                    Ok(message) => return Some(Picked::Saved(message)),
                    Err(message) => self.complaint = message,
                }
            }
        } else {
            let text = match self.pick {
                Some(Pick::Scale) => "Scales (.scl) and keyboard mappings (.kbm)",
                _ => "Sounds and kits (.toml), scales (.scl, .kbm), recordings to make a sound of",
            };
            line(ui.painter(), rest, Align2::LEFT_CENTER, text, SMALL, palette.muted);
            let look = if self.chosen.is_empty() { Look::Disabled } else { Look::Main };
            let response = button(ui, main, "Open", "Open the chosen files", look, palette);
            if response.hovered() {
                *controls.hint =
                    Hint::new("Open", "As if it were dropped on the window. Ctrl chooses several recordings.");
            }
            if response.clicked() && look == Look::Main {
                wanted = Some(self.chosen.iter().cloned().collect());
            }
            if let Some(files) = wanted {
                return Some(Picked::Files(files));
            }
        }
        if let Some(path) = to {
            self.go(path);
        }
        None
    }

    /// Shows folders to go to. Returns the one that is clicked.
    fn places(&self, ui: &mut Ui, rect: Rect, controls: &Controls) -> Option<PathBuf> {
        let mut inner = ui.new_child(UiBuilder::new().id_salt("places").max_rect(rect));
        let shown = ScrollArea::vertical().id_salt("places").auto_shrink(false).show(&mut inner, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            let mut clicked = None;
            for Entry { name, path, .. } in &self.places {
                let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW - 2.0), Sense::hover());
                let look = if *path == self.listing.folder { Look::On } else { Look::Off };
                if button(ui, row, name, &format!("Go to {name}"), look, controls.palette).clicked() {
                    clicked = Some(path.clone());
                }
            }
            clicked
        });
        shown.inner
    }

    /// Shows what is in the folder. Returns the folder that was clicked, and the file that was chosen by two clicks or by Enter.
    fn list(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        saves: bool,
        controls: &Controls,
    ) -> (Option<PathBuf>, Option<PathBuf>) {
        let palette = controls.palette;
        let (mut entered, mut opened) = (None, None);
        if self.listing.entries.is_empty() {
            let text = match (self.work.is_some(), saves) {
                (true, _) => "Reading …",
                (false, true) => "No sound here yet: Save puts this one here.",
                (false, false) => "Nothing here that can be opened: go Up, or to a place at the left.",
            };
            let place = rect.with_max_y(rect.top() + ROW);
            line(ui.painter(), place, Align2::LEFT_CENTER, text, TEXT, palette.muted);
        }
        list::show(ui, rect, "files", [COLUMN, ROW], self.listing.entries.len(), |ui, place, cell| {
            let (Entry { name, path, is_folder }, cell) = (&self.listing.entries[place], cell.shrink2(vec2(2.0, 1.0)));
            let response = ui.interact(cell, Id::unique(("file", place)), Sense::click());
            let is_chosen = self.chosen.contains(path);
            let label = if *is_folder { format!("Folder {name}") } else { name.clone() };
            response.widget_info(|| WidgetInfo::selected(Role::ListItem, true, is_chosen, &label));
            if is_chosen || response.hovered() || response.has_focus() {
                ui.painter().rect_filled(cell, 3.0, palette.raised);
            }
            let colour = if is_chosen { palette.accent_text } else { palette.text };
            let text = if *is_folder { format!("{name}/") } else { name.clone() };
            line(ui.painter(), cell.shrink2(vec2(5.0, 0.0)), Align2::LEFT_CENTER, &text, TEXT, colour);
            if !response.clicked() {
                return;
            }
            let (adds, is_by_key) = ui.input(|input| (input.modifiers.command, !input.pointer.any_click()));
            match (is_folder, saves) {
                // The second of two clicks is on what the first has brought there.
                (true, _) if response.double_clicked() => {}
                (true, _) => entered = Some(path.clone()),
                (false, true) => self.name.clone_from(name),
                (false, false) if response.double_clicked() && is_chosen || is_by_key => opened = Some(path.clone()),
                (false, false) => {
                    if !adds {
                        self.chosen.clear();
                    }
                    if !is_chosen || !adds {
                        self.chosen.insert(path.clone());
                    } else {
                        self.chosen.remove(path);
                    }
                }
            }
        });
        (entered, opened)
    }

    /// Saves the sound in the folder. A file that is there is only replaced when it is asked for again.
    fn save(&mut self, library: Option<&Library>) -> Said {
        let Some(Pick::Place(sound)) = &self.pick else { return Err(String::new()) };
        let name = self.name.trim();
        let is_sound = name.to_lowercase().ends_with(".toml");
        let name = if is_sound { name.to_owned() } else { format!("{name}.toml") };
        if name.len() == ".toml".len() || name.contains(['/', '\\', ':']) {
            return Err("expected the name of a file".to_owned());
        }
        let path = self.listing.folder.join(name);
        let replace = self.confirm.take().is_some_and(|confirmed| confirmed == path);
        match export(sound, &path, library, replace) {
            Ok(path) => Ok(format!("saved {}", path.display())),
            Err(sprung::Error::Exists { path: there }) => {
                self.confirm = Some(path);
                Err(format!("{there} exists; Replace writes over it"))
            }
            Err(error) => Err(error.to_string()),
        }
    }
}
