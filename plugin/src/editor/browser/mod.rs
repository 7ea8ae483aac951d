//! The browser: finds sounds, plays them, keeps favourites, and saves sounds under a name.

mod details;
mod likeness;
mod list;
pub(super) mod sounds;
mod tags;

use crate::editor::controls::{Controls, Hint, Pick, Said};
use crate::editor::keyboard::audition::Audition;
use crate::editor::theme::{GAP, PADDING, Palette, TEXT, font};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::progress::{Face, PAUSE, paint};
use crate::editor::widgets::text::{is_entered, name_field, take_over};
use crate::files::read;
use crate::link::Link;
use details::{Details, Outcome};
use egui::{Id, Key, Rect, ScrollArea, Sense, Stroke, TextEdit, Ui, UiBuilder, pos2, vec2};
use likeness::Likeness;
use list::{List, ROW, row};
use sounds::{Category, Sounds};
use sprung::internals::library::{Library, Listed};
use sprung::preset::{Guide, Playable};
use std::sync::Arc;
use tags::Tags;

/// Width of the list of categories, and of the details of a sound.
const SIDE: [f32; 2] = [112.0, 250.0];

/// Width of the button that imports files.
const IMPORT: f32 = 54.0;

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
    /// What was said last of files that cannot be read.
    told: Option<String>,
    library: Option<Library>,
    category: Category,
    words: String,
    tags: Tags,
    likeness: Likeness,
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
            told: None,
            library,
            category: Category::All,
            words: String::new(),
            tags: Tags::default(),
            likeness: Likeness::default(),
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

    /// Whether the sounds have changed since they were read.
    pub(super) fn is_stale(&self) -> bool {
        self.sounds.is_none()
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

    /// All sounds, read if they may have changed.
    pub(super) fn sounds(&mut self) -> &Sounds {
        self.sounds.get_or_insert_with(|| Sounds::read(self.library.clone()))
    }

    /// Shows the browser. Returns a message, and whether the user is done here.
    pub(super) fn show(&mut self, ui: &mut Ui, rect: Rect, controls: &mut Controls) -> Option<(Said, bool)> {
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
        let before = self.category;
        self.categories(ui, categories, palette);
        if self.category != before {
            // Not while they are shown: their order would change under the arrow keys.
            sounds.read_recent();
        }
        let mut message = None;
        let present = controls.params.name();
        let (search, rest) = list.split_top_bottom_at_y(list.top() + 28.0);
        let (tags, rows) = rest.split_top_bottom_at_y(rest.top() + tags::height());
        let import = search.with_max_y(search.top() + 22.0).with_min_x(search.right() - IMPORT);
        let command = self.search(ui, search.with_max_x(import.left() - 4.0), palette);
        let response = button(ui, import, "Import", "Import files", Look::Plain, palette);
        if response.hovered() {
            *controls.hint = Hint::new("Import", "Open sounds, kits, scales, or recordings to make a sound of.");
        }
        if response.clicked() {
            controls.interaction.pick = Some(Pick::Any);
        }
        let mut found = sounds.find(self.category, &self.words, self.likeness.places());
        self.tags.retain(&mut found);
        let mut says = String::new();
        if found.is_empty() && self.words.trim().is_empty() && self.tags.are_empty() {
            says = self.category.invitation().to_owned();
        } else if found.is_empty() {
            found = sounds.find(Category::All, &self.words, &[]);
            self.tags.retain(&mut found);
            says = format!("None in {}. Elsewhere:", self.category.name());
            if found.is_empty() {
                let (near, none) = sounds.nearest(&self.words, |_| true);
                (found, says) = (near, none.to_owned());
            }
        }
        self.tags.show(ui, tags, &found, palette);
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
        let list = List { found: &found, present: &present, chosen, says: &says };
        let clicked = list.show(ui, rows, &sounds, palette);
        if let Some(sound) = clicked.star.and_then(|place| found.get(place)) {
            message = sounds.set_favourite(sound.name(), !sounds.is_favourite(sound)).map(Err).or(message);
        }
        if let Some(sound) = chosen.or(clicked.sound).and_then(|place| found.get(place)) {
            self.try_out(ui, sound, controls);
        }
        let name = controls.params.name();
        let shown = found.iter().chain(sounds.all()).find(|sound| sound.name() == name);
        let compared = self.follow_comparison(ui, rows, controls);
        let may_compare = self.likeness.search.is_none();
        let outcome = self.details.show(ui, details, shown.map(Arc::as_ref), may_compare, &sounds, controls);
        if outcome.as_ref().is_some_and(|outcome| outcome.compares)
            && let Playable::Preset(preset) = controls.params.state().playable
        {
            self.likeness.asked = Some((self.category, self.words.clone(), self.tags.clone()));
            message = self.likeness.start(preset, &sounds).err().map(Err).or(message);
        }
        let message = compared.map(Err).or(message);
        let is_stale = outcome.as_ref().is_some_and(|outcome| outcome.is_stale);
        let broken =
            sounds.broken.first().map(|first| format!("{} of your files cannot be read: {first}", sounds.broken.len()));
        let is_told = std::mem::replace(&mut self.told, broken.clone()) == broken;
        let broken = broken.filter(|_| !is_told);
        self.sounds = (!is_stale).then_some(sounds);
        match outcome {
            Some(Outcome { message, is_done, compares: false, .. }) => Some((message, is_done)),
            _ => message.or(broken.map(Err)).map(|message| (message, false)),
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

    /// Shows how far the search for sounds like one is, and its result when it ends, unless one looks for others meanwhile. Returns a
    /// message if there is none.
    fn follow_comparison(&mut self, ui: &Ui, within: Rect, controls: &Controls) -> Option<String> {
        let search = self.likeness.search.as_mut()?;
        let Some(ended) = search.take() else {
            ui.ctx().request_repaint_after(PAUSE);
            let (name, share, is_ending) = (&search.name, search.share(), search.is_cancelled());
            let face = Face { verb: "Comparing with", name, share, is_ending, cancel: "Cancel the comparison" };
            if paint(ui, within, &face, controls.palette).clicked() {
                search.cancel();
            }
            return None;
        };
        ui.ctx().request_repaint();
        let name = std::mem::take(&mut search.name);
        self.likeness.search = None;
        match ended {
            Ok(places) => {
                self.likeness.found = Some((name, places));
                if self.likeness.asked == Some((self.category, self.words.clone(), self.tags.clone())) {
                    self.choose(Category::Like);
                }
                None
            }
            Err(message) => Some(message),
        }
    }

    /// Shows all of a category: words and tags of another search would hide most of it.
    fn choose(&mut self, category: Category) {
        (self.category, self.words) = (category, String::new());
        self.tags.clear();
    }

    fn categories(&mut self, ui: &mut Ui, rect: Rect, palette: &Palette) {
        let mut inner = ui.new_child(UiBuilder::new().id_salt("categories").max_rect(rect));
        ScrollArea::vertical().id_salt("categories").auto_shrink(false).show(&mut inner, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            let compared = self.likeness.found.as_ref().map(|(name, _)| (Category::Like, format!("Like {name}")));
            for (category, name) in compared.into_iter().chain(Category::all().map(|each| (each, each.name()))) {
                let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW - 2.0), Sense::hover());
                let look = if category == self.category { Look::On } else { Look::Off };
                if button(ui, row.shrink2(vec2(0.0, 1.0)), &name, &format!("Show {name}"), look, palette).clicked()
                    && self.category != category
                {
                    self.choose(category);
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
        if is_entered(&response) && self.words.ends_with(".toml") {
            return Command::File;
        }
        match (pressed(Key::ArrowDown), pressed(Key::ArrowUp)) {
            (true, false) => Command::Step(1),
            (false, true) => Command::Step(-1),
            _ => Command::Nothing,
        }
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

    fn load_file(&mut self, controls: &mut Controls) -> Said {
        let playable = read(self.words.trim()).map_err(|error| error.to_string())?;
        self.details.open(playable.name());
        controls.history.load(playable, controls.params, controls.host);
        Ok(format!("loaded {}", self.words.trim()))
    }
}

fn search_field() -> Id {
    Id::unique("search")
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
