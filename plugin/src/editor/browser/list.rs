//! The sounds that were found, on shelves: each with its body, its name, and a star that makes it a favourite.

use super::sounds::Sounds;
use crate::editor::body::face;
use crate::editor::theme::{Palette, RADIUS, SMALL, TEXT};
use crate::editor::widgets::text::line;
use crate::editor::widgets::{list, outline, star};
use egui::{Align2, EventFilter, Id, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};
use sprung::internals::library::Listed;
use std::ops::Range;
use std::sync::Arc;

/// Height of a line of text.
pub(super) const ROW: f32 = 22.0;
/// Least width and height of a sound on its shelf: six stand on one of the usual window, and three in a list that is low.
const TILES: [[f32; 2]; 2] = [[112.0, 92.0], [86.0, 68.0]];
/// Height below which a list is low: that of three shelves.
const LOW: f32 = 300.0;
/// Room for a sound's name below its shelf, and the side of the star above it.
const NAME: f32 = 24.0;
const STAR: f32 = 18.0;

/// The list, for one pass.
pub(super) struct List<'a> {
    pub(super) found: &'a [Arc<Listed>],
    /// The name of the loaded sound.
    pub(super) present: &'a str,
    /// The place of the sound that was chosen by a key: the list scrolls to it.
    pub(super) chosen: Option<usize>,
    /// Headings, each with the place of the first sound below it.
    pub(super) headings: &'a [(usize, String)],
}

/// The places of what was clicked.
#[derive(Default)]
pub(super) struct Clicked {
    pub(super) sound: Option<usize>,
    pub(super) star: Option<usize>,
}

impl List<'_> {
    /// Shows the list.
    pub(super) fn show(&self, ui: &mut Ui, rect: Rect, sounds: &Sounds, palette: &Palette) -> Clicked {
        let Self { found, present, .. } = *self;
        let mut clicked = Clicked::default();
        self.show_shelves(ui, rect, palette, |ui, place, cell| {
            let sound = &found[place];
            let response = ui.interact(cell.shrink(2.0), row(place), Sense::click());
            let is_on = sound.name() == present;
            response.widget_info(|| WidgetInfo::selected(Role::ListItem, true, is_on, sound.name()));
            if response.clicked() {
                clicked.sound = Some(place);
            }
            if response.has_focus() {
                // They lead along the shelves.
                let filter = EventFilter { vertical_arrows: true, horizontal_arrows: true, ..EventFilter::default() };
                ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
            }
            if is_on || response.hovered() {
                ui.painter().rect_filled(response.rect, RADIUS, palette.raised);
            }
            outline(ui, &response, response.rect, RADIUS, palette);
            let (stands, name) = cell.split_top_bottom_at_y(cell.bottom() - NAME);
            ui.painter().hline(cell.x_range(), stands.bottom(), Stroke::new(2.0, palette.line));
            if let Some(figure) = sounds.figure(sound).filter(|_| ui.is_rect_visible(stands)) {
                let room = stands.shrink2(vec2(14.0, 6.0));
                face::paint_standing(ui.painter(), room.with_max_y(stands.bottom() - 1.0), figure, palette);
            }
            let colour = if is_on { palette.accent_text } else { palette.text };
            let name = name.shrink2(vec2(4.0, 0.0)).with_max_y(cell.bottom() - 4.0);
            line(ui.painter(), name, Align2::CENTER_CENTER, sound.name(), TEXT, colour);
            if sound.path.is_some() {
                line(ui.painter(), cell.shrink2(vec2(6.0, 4.0)), Align2::LEFT_TOP, "yours", SMALL, palette.muted);
            }
            let at = Rect::from_min_size(cell.right_top() + vec2(-STAR - 4.0, 4.0), vec2(STAR, STAR));
            let id = Id::unique(("star", place));
            if star::show(ui, at, id, sound.name(), sounds.is_favourite(sound), palette).clicked() {
                clicked.star = Some(place);
            }
        });
        clicked
    }

    /// Shows the cells of the sounds on their shelves, and the headings above these.
    fn show_shelves(&self, ui: &mut Ui, rect: Rect, palette: &Palette, mut cell: impl FnMut(&Ui, usize, Rect)) {
        let [width, height] = tile(rect);
        let columns = list::columns(rect, width);
        let shelves = shelves(rect, self.found.len(), self.headings);
        let whole = shelves.len() as f32 * height + self.headings.len() as f32 * ROW;
        list::scrolled(ui, rect, "sounds", whole, |ui, area| {
            // What lies below so many shelves and headings begins here.
            let top = |shelves: usize, headings: usize| area.top() + shelves as f32 * height + headings as f32 * ROW;
            for (number, (first, says)) in self.headings.iter().enumerate() {
                let above = shelves.partition_point(|shelf| shelf.end <= *first);
                let at = Rect::from_min_size(pos2(area.left(), top(above, number)), vec2(area.width(), ROW));
                line(ui.painter(), at, Align2::LEFT_CENTER, says, TEXT, palette.muted);
            }
            let size = vec2(area.width() / columns as f32, height);
            for (number, shelf) in shelves.iter().enumerate() {
                let above = self.headings.partition_point(|(first, _)| *first <= shelf.start);
                for (column, place) in shelf.clone().enumerate() {
                    let corner = pos2(area.left() + column as f32 * size.x, top(number, above));
                    let at = Rect::from_min_size(corner, size);
                    if self.chosen == Some(place) {
                        ui.scroll_to_rect(at.expand(height), None);
                    }
                    if list::is_near(ui, at) {
                        cell(ui, place, at);
                    }
                }
            }
        });
    }
}

/// Width and height of a sound on its shelf, in a list of this size.
fn tile(rect: Rect) -> [f32; 2] {
    TILES[usize::from(rect.height() < LOW)]
}

/// The places of the sounds on each shelf of a list of this size: a heading starts a new shelf.
pub(super) fn shelves(rect: Rect, count: usize, headings: &[(usize, String)]) -> Vec<Range<usize>> {
    let columns = list::columns(rect, tile(rect)[0]);
    let (mut shelves, mut start) = (Vec::new(), 0);
    for end in headings.iter().map(|(place, _)| *place).chain([count]) {
        while start < end {
            shelves.push(start..(start + columns).min(end));
            start = (start + columns).min(end);
        }
    }
    shelves
}

/// How many shelves of a list of this size are seen at once.
pub(super) fn seen(rect: Rect) -> usize {
    ((rect.height() / tile(rect)[1]) as usize).max(1)
}

/// The widget of a sound in the list.
pub(super) fn row(place: usize) -> Id {
    Id::unique(("sound", place))
}
