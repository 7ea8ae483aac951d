//! The list of the sounds that were found, each with a star that makes it a favourite and a picture of its body.

use super::sounds::Sounds;
use crate::editor::body::face;
use crate::editor::theme::{Palette, SMALL, TEXT};
use crate::editor::widgets::text::line;
use crate::editor::widgets::{list, outline};
use egui::{Align2, Id, Rect, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, pos2, vec2};
use sprung::internals::library::Listed;
use std::f32::consts::TAU;
use std::sync::Arc;

/// Height of a row, and least width of a column.
pub(super) const ROW: f32 = 22.0;
const COLUMN: f32 = 210.0;

/// Width of the picture of a body.
const PICTURE: f32 = 24.0;

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
        list::show(ui, below, "sounds", [COLUMN, ROW], (found.len(), chosen), |ui, place, cell| {
            let (sound, cell) = (&found[place], cell.shrink2(vec2(2.0, 1.0)));
            let star = Rect::from_min_size(cell.min, vec2(20.0, cell.height()));
            let response = ui.interact(cell.with_min_x(star.right()), row(place), Sense::click());
            let is_on = sound.name() == present;
            response.widget_info(|| WidgetInfo::selected(Role::ListItem, true, is_on, sound.name()));
            if response.clicked() {
                clicked.sound = Some(place);
            }
            if is_on || response.hovered() {
                ui.painter().rect_filled(cell, 3.0, palette.raised);
            }
            outline(ui, &response, response.rect, 3, palette);
            if show_star(ui, star, place, sound.name(), sounds.is_favourite(sound), palette) {
                clicked.star = Some(place);
            }
            let colour = if is_on { palette.accent_text } else { palette.text };
            let picture = Rect::from_min_size(star.right_top() + vec2(1.0, 0.25), vec2(PICTURE, cell.height()));
            if let Some(figure) = sounds.figure(sound) {
                face::paint(ui.painter(), picture.shrink2(vec2(1.0, 3.0)), figure, &[], None, palette);
            }
            let name = cell.with_min_x(picture.right() + 5.0);
            let name = line(ui.painter(), name, Align2::LEFT_CENTER, sound.name(), TEXT, colour);
            let rest = Rect::from_min_max(pos2(name.right() + 8.0, cell.top()), cell.max - vec2(4.0, 0.0));
            let what =
                if sound.path.is_some() { "yours" } else { sound.playable.tags().first().map_or("", String::as_str) };
            line(ui.painter(), rest, Align2::RIGHT_CENTER, what, SMALL, palette.muted);
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
