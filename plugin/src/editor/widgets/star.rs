//! The star of a favourite.

use super::outline;
use crate::editor::theme::Palette;
use egui::{Id, Rect, Response, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo};
use std::f32::consts::TAU;

/// Shows a star that is filled for favourites.
pub(crate) fn show(ui: &Ui, rect: Rect, id: Id, name: &str, is_on: bool, palette: &Palette) -> Response {
    let response = ui.interact(rect, id, Sense::click());
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
    response
}
