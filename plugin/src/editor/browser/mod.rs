//! The browser: finds sounds, plays them, keeps favourites, and saves sounds under a name.

mod details;
mod sounds;
mod star;

use crate::editor::controls::Controls;
use crate::editor::controls::files::read;
use crate::editor::keyboard::audition::Audition;
use crate::editor::theme::{GAP, PADDING, Palette, SMALL, TEXT, font};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::text::{line, name_field, take_over};
use crate::link::Link;
use details::{Details, Outcome};
use egui::{Align2, Id, Key, Rect, Role, ScrollArea, Sense, Stroke, TextEdit, Ui, UiBuilder, WidgetInfo, pos2, vec2};
use sounds::{Category, Sounds};
use sprung::preset::catalogue::Listed;
use sprung::preset::library::Library;
use sprung::preset::{Guide, Playable};
use std::sync::Arc;

const ROW: f32 = 22.0;
/// Width of the list of categories, and of the details of a sound.
const SIDE: [f32; 2] = [112.0, 250.0];

/// What the browser is opened for.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Aim {
    Find,
    Save,
}

/// The browser's state.
pub(super) struct Browser {
    /// Read when the browser is first opened.
    sounds: Option<Sounds>,
    library: Option<Library>,
    category: Category,
    words: String,
    details: Details,
    /// The key that plays the sound being tried.
    audition: Audition,
    /// Whether the search takes the focus when it is shown next.
    searches: bool,
}

impl Browser {
    /// A browser of a library; `None` if the system names no folder for user data.
    pub(super) fn new(library: Option<Library>) -> Self {
        Self {
            sounds: None,
            library,
            category: Category::All,
            words: String::new(),
            details: Details::default(),
            audition: Audition::default(),
            searches: false,
        }
    }

    /// The user's sounds.
    pub(super) fn library(&self) -> Option<&Library> {
        self.library.as_ref()
    }

    /// Reads the sounds again when they are shown next.
    pub(super) fn forget(&mut self) {
        self.sounds = None;
    }

    /// Prepares for being shown, with the name of the loaded sound: for finding another one, or for saving this one.
    pub(super) fn open(&mut self, name: &str, aim: Aim) {
        self.details.open(name);
        match aim {
            Aim::Find => self.searches = true,
            Aim::Save => self.details.take_name(),
        }
        self.sounds = None;
    }

    /// Shows the browser. Returns a message, and whether the user is done here.
    pub(super) fn show(&mut self, ui: &mut Ui, rect: Rect, controls: &mut Controls) -> Option<(String, bool)> {
        let palette = controls.palette;
        let mut sounds = self.sounds.take().unwrap_or_else(|| Sounds::read(self.library.clone()));
        palette.paint_panel(ui.painter(), rect);
        let inner = rect.shrink(PADDING);
        let details_width = if rect.width() < 900.0 { 190.0 } else { SIDE[1] };
        let categories = Rect::from_min_max(inner.min, pos2(inner.left() + SIDE[0], inner.bottom()));
        let details = Rect::from_min_max(pos2(inner.right() - details_width, inner.top()), inner.max);
        let list = Rect::from_min_max(
            pos2(categories.right() + 2.0 * GAP, inner.top()),
            pos2(details.left() - 2.0 * GAP, inner.bottom()),
        );
        for x in [categories.right() + GAP, details.left() - GAP] {
            ui.painter().vline(ui.painter().round_to_pixel_center(x), inner.y_range(), Stroke::new(1.0, palette.line));
        }
        self.categories(ui, categories, palette);
        let mut message = None;
        let present = controls.params.name();
        let (search, rows) = list.split_top_bottom_at_y(list.top() + 28.0);
        let command = self.search(ui, search, palette);
        let found = sounds.find(self.category, &self.words);
        let chosen = match command {
            Command::Nothing => None,
            // While another field has the focus, the arrow keys belong to that field.
            Command::Step(_) if !has_arrows(ui, found.len()) => None,
            Command::Step(places) => {
                let place = found.iter().position(|sound| sound.name() == present);
                let next = place.map_or(0, |place| place as isize + places);
                usize::try_from(next).ok().filter(|next| *next < found.len())
            }
            Command::File => {
                message = Some(self.load_file(controls));
                None
            }
        };
        let clicked = self.rows(ui, rows, &found, &present, chosen, &mut sounds, &mut message, palette);
        if let Some(sound) = chosen.or(clicked).and_then(|place| found.get(place)) {
            self.try_out(ui, sound, controls);
        }
        let shown = found.iter().find(|sound| sound.name() == controls.params.name());
        let outcome = self.details.show(ui, details, shown.map(Arc::as_ref), &sounds, controls);
        let is_stale = outcome.as_ref().is_some_and(|outcome| outcome.is_stale);
        let broken =
            sounds.broken.first().map(|first| format!("{} of your files cannot be read: {first}", sounds.broken.len()));
        self.sounds = (!is_stale).then_some(sounds);
        match outcome {
            Some(Outcome { message, is_done, .. }) => Some((message, is_done)),
            None => message.or(broken).map(|message| (message, false)),
        }
    }

    /// Releases the key of the tried sound when its time is over.
    pub(super) fn follow_time(&mut self, now: f64, controls: &Controls) {
        self.audition.follow_time(now, controls.params.link());
    }

    /// Releases the key of the tried sound at once.
    pub(super) fn release(&mut self, link: &Link) {
        self.audition.release(link);
    }

    fn categories(&mut self, ui: &mut Ui, rect: Rect, palette: &Palette) {
        let mut inner = ui.new_child(UiBuilder::new().id_salt("categories").max_rect(rect));
        ScrollArea::vertical().id_salt("categories").auto_shrink(false).show(&mut inner, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            for category in Category::all() {
                let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW - 2.0), Sense::hover());
                let name = category.name();
                let look = if category == self.category { Look::On } else { Look::Off };
                if button(ui, row, &name, &format!("Show {name}"), look, palette).clicked() && self.category != category
                {
                    // All of the category is shown: words of another search would hide most of it.
                    (self.category, self.words) = (category, String::new());
                }
                if matches!(category, Category::Kits) {
                    ui.add_space(6.0);
                }
            }
        });
    }

    fn search(&mut self, ui: &mut Ui, rect: Rect, palette: &Palette) -> Command {
        let field = search_field();
        let rect = rect.with_max_y(rect.top() + 22.0);
        let clear = rect.with_min_x(rect.right() - rect.height());
        let rest = if self.words.is_empty() { rect } else { rect.with_max_x(clear.left() - 4.0) };
        let edit = TextEdit::singleline(&mut self.words).id(field).hint_text("Search, or a file’s whole path");
        let response = ui.put(rest, edit.font(font(TEXT)).margin(vec2(6.0, 3.0)));
        name_field(&response, "Search", &self.words);
        if rest != rect && button(ui, clear, "×", "Clear the search", Look::Plain, palette).clicked() {
            self.words.clear();
            self.searches = true;
        }
        if std::mem::take(&mut self.searches) {
            take_over(ui, field, &self.words);
        }
        let pressed = |key| ui.input(|input| input.key_pressed(key));
        if response.lost_focus() && pressed(Key::Enter) && self.words.ends_with(".toml") {
            return Command::File;
        }
        match (pressed(Key::ArrowDown), pressed(Key::ArrowUp)) {
            (true, false) => Command::Step(1),
            (false, true) => Command::Step(-1),
            _ => Command::Nothing,
        }
    }

    /// Shows the sounds. Returns the one that was clicked.
    #[allow(clippy::too_many_arguments, reason = "a part of one function")]
    fn rows(
        &self,
        ui: &mut Ui,
        rect: Rect,
        found: &[Arc<Listed>],
        present: &str,
        chosen: Option<usize>,
        sounds: &mut Sounds,
        message: &mut Option<String>,
        palette: &Palette,
    ) -> Option<usize> {
        let mut clicked = None;
        let columns = ((rect.width() / 210.0) as usize).max(1);
        let mut inner = ui.new_child(UiBuilder::new().id_salt("sounds").max_rect(rect));
        if found.is_empty() {
            line(
                ui.painter(),
                rect.with_max_y(rect.top() + 24.0),
                Align2::LEFT_CENTER,
                "Nothing has these words.",
                TEXT,
                palette.muted,
            );
        }
        ScrollArea::vertical().id_salt("sounds").auto_shrink(false).show(&mut inner, |ui| {
            let rows = found.len().div_ceil(columns);
            let width = ui.available_width();
            let (area, _) = ui.allocate_exact_size(vec2(width, rows as f32 * ROW), Sense::hover());
            for (place, sound) in found.iter().enumerate() {
                let size = vec2(width / columns as f32, ROW);
                let corner = area.min + vec2((place % columns) as f32 * size.x, (place / columns) as f32 * size.y);
                let cell = Rect::from_min_size(corner, size).shrink2(vec2(2.0, 1.0));
                if chosen == Some(place) {
                    ui.scroll_to_rect(cell.expand(ROW), None);
                }
                if !ui.is_rect_visible(cell) {
                    continue;
                }
                let star = Rect::from_min_size(cell.min, vec2(20.0, cell.height()));
                let response = ui.interact(cell.with_min_x(star.right()), row(place), Sense::click());
                let is_on = sound.name() == present;
                response.widget_info(|| WidgetInfo::selected(Role::ListItem, true, is_on, sound.name()));
                if response.clicked() {
                    clicked = Some(place);
                }
                if is_on || response.hovered() {
                    ui.painter().rect_filled(cell, 3.0, palette.raised);
                }
                let is_favourite = sounds.is_favourite(sound);
                if star::show(ui, star, place, sound.name(), is_favourite, palette) {
                    *message = sounds.set_favourite(sound.name(), !is_favourite).or(message.take());
                }
                let colour = if is_on { palette.accent_text } else { palette.text };
                let name = cell.with_min_x(star.right() + 2.0);
                let name = line(ui.painter(), name, Align2::LEFT_CENTER, sound.name(), TEXT, colour);
                let rest = Rect::from_min_max(pos2(name.right() + 8.0, cell.top()), cell.max - vec2(4.0, 0.0));
                let what = if sound.path.is_some() {
                    "yours"
                } else {
                    sound.playable.tags().first().map_or("", String::as_str)
                };
                line(ui.painter(), rest, Align2::RIGHT_CENTER, what, SMALL, palette.muted);
            }
        });
        clicked
    }

    /// Loads a sound and plays it on the key that suits it best.
    fn try_out(&mut self, ui: &Ui, sound: &Listed, controls: &mut Controls) {
        controls.history.load(sound.playable.clone(), controls.params, controls.host);
        self.details.open(sound.name());
        let key = match &sound.playable {
            Playable::Preset(preset) => preset.guide.home,
            Playable::Kit(kit) => kit.pads.first().map_or(Guide::default().home, |(key, _)| *key),
        };
        self.audition.strike(key, 0.75, ui.input(|input| input.time), controls.params.link());
    }

    fn load_file(&mut self, controls: &mut Controls) -> String {
        match read(self.words.trim()) {
            Ok((playable, remarks)) => {
                self.details.open(playable.name());
                controls.history.load(playable, controls.params, controls.host);
                [vec![format!("loaded {}", self.words.trim())], remarks].concat().join("; ")
            }
            Err(message) => message,
        }
    }
}

fn search_field() -> Id {
    Id::unique("search")
}

/// The row of a sound in the list.
fn row(place: usize) -> Id {
    Id::unique(("sound", place))
}

/// Whether the arrow keys belong to the list with so many rows: true if the list or the search has the focus, or
/// nothing has.
fn has_arrows(ui: &Ui, rows: usize) -> bool {
    let focused = ui.memory(|memory| memory.focused());
    focused.is_none_or(|focused| focused == search_field() || (0..rows).any(|place| focused == row(place)))
}

/// A request made with the search field's keys.
enum Command {
    Nothing,
    /// Load the sound at this distance in the list.
    Step(isize),
    /// Load the file whose path was typed.
    File,
}
