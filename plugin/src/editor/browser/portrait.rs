//! The loaded sound in the browser: its body, what is said of it, what moves it, and its macros to be turned.

use super::sounds::Sounds;
use crate::editor::body::face;
use crate::editor::body::small::Small;
use crate::editor::controls::shown::Shown;
use crate::editor::controls::{Controls, Hint};
use crate::editor::lamps::MOVERS;
use crate::editor::routes::Ring;
use crate::editor::theme::{CELL_HEIGHT, GAP, KNOB, SMALL, TEXT, font};
use crate::editor::widgets::buttons::{Look, button};
use crate::editor::widgets::text::line;
use crate::editor::widgets::{knob, mover, star};
use egui::{Align2, Color32, Id, Rect, ScrollArea, Sense, Stroke, Ui, UiBuilder, vec2};
use sprung::internals::library::Listed;
use sprung::params::{PARAMS, ParamInfo};
use sprung::preset::Playable;
use sprung::units::note_name;

/// Least height in which there is room for the body above the words, and the height of the picture there.
const TALL: f32 = 280.0;
const PICTURE: f32 = 112.0;
/// Side of the star, and height of a line with an exciter.
const STAR: f32 = 22.0;
const MOVER: f32 = 20.0;
/// How many macros, or exciters, stand beside each other in a column that is so wide at least, and in one that is not.
const WIDE: f32 = 220.0;
const BESIDE: [[usize; 2]; 2] = [[4, 3], [3, 2]];

/// Room beside what is said, for the bar that scrolls it.
const BAR: f32 = 6.0;

/// What is said of a sound that is in no file.
const NEW: &str = "In no file of yours yet: type a name below and press Enter, and it is kept.";

/// The state of the column.
#[derive(Default)]
pub(super) struct Portrait {
    /// Whether it says how the sound is made.
    is_open: bool,
    figure: Small,
}

impl Portrait {
    /// Shows the loaded sound, which is `listed` if it has a file. Returns whether its star was clicked.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        listed: Option<&Listed>,
        sounds: &Sounds,
        shown: &Shown,
        controls: &mut Controls,
    ) -> bool {
        let palette = controls.palette;
        let mut is_starred = false;
        let mut inner = ui.new_child(UiBuilder::new().id_salt("portrait").max_rect(rect));
        ScrollArea::vertical().id_salt("portrait").auto_shrink(false).show(&mut inner, |ui| {
            ui.spacing_mut().item_spacing = vec2(0.0, 3.0);
            if rect.height() >= TALL {
                self.paint(ui, shown, controls);
            }
            let title = next(ui, STAR);
            if let Some(listed) = listed {
                let at = title.with_min_x(title.right() - STAR);
                let is_on = sounds.is_favourite(listed);
                let response = star::show(ui, at, Id::unique("star of the sound"), "this sound", is_on, palette);
                is_starred = response.clicked();
                if response.hovered() {
                    *controls.hint = Hint::new("Favourite", "Keeps this sound among your favourites.");
                }
            }
            let name = title.with_max_x(title.right() - STAR - 4.0);
            line(ui.painter(), name, Align2::LEFT_CENTER, &controls.params.name(), TEXT + 3.0, palette.text);
            let Some(listed) = listed else { return say(ui, NEW, palette.muted) };
            let tags = listed.tags().iter().map(String::as_str).chain(listed.moods().iter().copied());
            say(ui, &tags.collect::<Vec<_>>().join("  "), palette.muted);
            let author = Some(listed.playable.author()).filter(|author| !author.is_empty());
            let about = [author.map(|author| format!("by {author}")), Some(range(&listed.playable))];
            say(ui, &about.into_iter().flatten().collect::<Vec<_>>().join(" · "), palette.muted);
            say(ui, listed.playable.comment(), palette.text);
            if shown.preset().is_some() {
                macros(ui, shown, controls);
                moved_by(ui, controls);
            }
            self.details(ui, listed.playable.details(), controls);
        });
        is_starred
    }

    /// Paints the body on a shelf.
    fn paint(&mut self, ui: &mut Ui, shown: &Shown, controls: &Controls) {
        let place = next(ui, PICTURE);
        let shelf = place.bottom() - 4.0;
        ui.painter().hline(place.x_range(), shelf, Stroke::new(2.0, controls.palette.line));
        let room = place.with_max_y(shelf - 1.0).shrink2(vec2(0.16 * place.width(), 0.0)).with_min_y(place.top() + 6.0);
        face::paint_standing(ui.painter(), room, self.figure.get(shown), controls.palette);
    }

    /// Says how the sound is made, where one wants to know.
    fn details(&mut self, ui: &mut Ui, details: &str, controls: &mut Controls) {
        if details.is_empty() {
            return;
        }
        ui.add_space(4.0);
        let look = if self.is_open { Look::On } else { Look::Off };
        let row = next(ui, 20.0);
        let at = row.with_max_x(row.left() + 64.0);
        let response = button(ui, at, "Details", "Details of this sound", look, controls.palette);
        if response.hovered() {
            *controls.hint = Hint::new("Details", "How it is made, and where its figures come from.");
        }
        if response.clicked() {
            self.is_open = !self.is_open;
        }
        if self.is_open {
            say(ui, details, controls.palette.muted);
        }
    }
}

/// The next place in the column.
fn next(ui: &mut Ui, height: f32) -> Rect {
    let wide = ui.available_width();
    ui.allocate_exact_size(vec2(wide, height), Sense::hover()).0
}

/// Writes lines that are broken to the column's width; nothing for no words.
fn say(ui: &mut Ui, words: &str, colour: Color32) {
    if !words.is_empty() {
        let galley = ui.painter().layout(words.to_owned(), font(SMALL + 0.5), colour, ui.available_width() - BAR);
        let place = next(ui, galley.size().y + 2.0);
        ui.painter().galley(place.min, galley, colour);
    }
}

/// The keys of a sound, in words.
fn range(playable: &Playable) -> String {
    match playable {
        Playable::Preset(preset) => {
            let guide = &preset.guide;
            let [lowest, highest, home] = [guide.lowest, guide.highest, guide.home].map(note_name);
            format!("{lowest} to {highest}, best at {home}")
        }
        Playable::Kit(kit) => format!("kit of {} pads", kit.pads.len()),
    }
}

/// A caption above some things.
fn caption(ui: &mut Ui, words: &str, controls: &Controls) {
    ui.add_space(4.0);
    let place = next(ui, 14.0);
    line(ui.painter(), place, Align2::LEFT_CENTER, words, SMALL, controls.palette.muted);
}

/// Shows things of a kind in rows of this height, as many beside each other as there is room for.
fn rows<T>(ui: &mut Ui, things: &[T], kind: usize, height: f32, mut show: impl FnMut(&mut Ui, Rect, &T)) {
    let columns = BESIDE[usize::from(ui.available_width() < WIDE)][kind];
    for row in things.chunks(columns) {
        let place = next(ui, height);
        let wide = place.width() / columns as f32;
        for (column, thing) in row.iter().enumerate() {
            let corner = place.min + vec2(column as f32 * wide, 0.0);
            show(ui, Rect::from_min_size(corner, vec2(wide, height)), thing);
        }
    }
}

/// The macros that the sound names, as knobs.
fn macros(ui: &mut Ui, shown: &Shown, controls: &mut Controls) {
    let guide = shown.guide();
    let named = |info: &'static ParamInfo| guide.macro_name(info.id).map(|name| (info, name.to_owned()));
    let macros: Vec<_> = PARAMS.iter().filter_map(named).collect();
    if macros.is_empty() {
        return;
    }
    caption(ui, "Macros", controls);
    rows(ui, &macros, 0, CELL_HEIGHT, |ui, cell, (info, name)| {
        let cell = cell.with_max_y(cell.bottom() - 4.0).shrink2(vec2(1.0, 0.0));
        let ring = Ring::of(info, (&shown.patch().routes, shown.guide()), controls);
        knob::show(ui, (cell, KNOB), info, name, &ring, controls);
    });
}

/// The exciters that act.
fn moved_by(ui: &mut Ui, controls: &Controls) {
    let palette = controls.palette;
    let movers: Vec<_> = MOVERS.iter().filter(|mover| mover.is_on(controls)).collect();
    if movers.is_empty() {
        return;
    }
    caption(ui, "Moved by", controls);
    rows(ui, &movers, 1, MOVER, |ui, at, lamp| {
        let picture = Rect::from_min_size(at.min + vec2(0.0, 2.0), vec2(MOVER, MOVER - 4.0));
        mover::paint(ui.painter(), picture, lamp.param, palette.accent, palette);
        let name = at.with_min_x(picture.right() + GAP);
        line(ui.painter(), name, Align2::LEFT_CENTER, lamp.section, SMALL + 0.5, palette.text);
    });
}
