//! The sounds that were found, on shelves: each with its body, its name, and a star that makes it a favourite.

use super::sounds::Sounds;
use crate::editor::body::face;
use crate::editor::theme::{Palette, RADIUS, SMALL, TEXT};
use crate::editor::widgets::text::line;
use crate::editor::widgets::{list, outline};
use egui::{Align2, Id, Rect, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, vec2};
use sprung::internals::library::Listed;
use std::f32::consts::TAU;
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
    /// What is said above them; may be empty.
    pub(super) says: &'a str,
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
        let Self { found, present, chosen, says } = *self;
        let mut clicked = Clicked::default();
        let told = if says.is_empty() { 0.0 } else { ROW };
        line(ui.painter(), rect.with_max_y(rect.top() + ROW), Align2::LEFT_CENTER, says, TEXT, palette.muted);
        let below = rect.with_min_y(rect.top() + told);
        let tile = TILES[usize::from(rect.height() < LOW)];
        list::show(ui, below, "sounds", tile, (found.len(), chosen), |ui, place, cell| {
            let sound = &found[place];
            let response = ui.interact(cell.shrink(2.0), row(place), Sense::click());
            let is_on = sound.name() == present;
            response.widget_info(|| WidgetInfo::selected(Role::ListItem, true, is_on, sound.name()));
            if response.clicked() {
                clicked.sound = Some(place);
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
            let star = Rect::from_min_size(cell.right_top() + vec2(-STAR - 4.0, 4.0), vec2(STAR, STAR));
            if show_star(ui, star, place, sound.name(), sounds.is_favourite(sound), palette) {
                clicked.star = Some(place);
            }
        });
        clicked
    }
}

/// The widget of a sound in the list.
pub(super) fn row(place: usize) -> Id {
    Id::unique(("sound", place))
}

/// A star that is filled for favourites. Returns whether it was clicked.
fn show_star(ui: &Ui, rect: Rect, place: usize, name: &str, is_on: bool, palette: &Palette) -> bool {
    let response = ui.interact(rect, Id::unique(("star", place)), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, is_on, format!("Favourite {name}")));
    outline(ui, &response, response.rect, 3, palette);
    let corner = |number: usize| {
        let radius = if number.is_multiple_of(2) { 6.0 } else { 2.6 };
        rect.center() + radius * Vec2::angled((number as f32 / 10.0 - 0.25) * TAU)
    };
    let colour =
        if is_on { palette.accent } else { palette.muted.gamma_multiply(if response.hovered() { 1.0 } else { 0.7 }) };
    let points: Vec<_> = (0..10).map(corner).collect();
    if is_on {
        // A star is not convex, but its five points and its centre are.
        for number in (0..10).step_by(2) {
            let triangle = vec![points[number], points[(number + 1) % 10], points[(number + 9) % 10]];
            ui.painter().add(Shape::convex_polygon(triangle, colour, Stroke::NONE));
        }
        let middle = points.iter().skip(1).step_by(2).copied().collect();
        ui.painter().add(Shape::convex_polygon(middle, colour, Stroke::NONE));
    } else {
        ui.painter().add(Shape::closed_line(points, Stroke::new(1.0, colour)));
    }
    response.clicked()
}
