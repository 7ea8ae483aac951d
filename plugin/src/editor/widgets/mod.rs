//! Knobs, buttons, fields and lines of text: what the parts of the window are made of.

pub(super) mod buttons;
pub(super) mod carried;
pub(super) mod choice;
pub(super) mod knob;
pub(super) mod list;
pub(super) mod mover;
pub(super) mod number;
pub(super) mod progress;
pub(super) mod star;
pub(super) mod text;
mod typing;

use super::theme::Palette;
use egui::{Color32, Painter, Pos2, Rect, Response, Stroke, StrokeKind, Ui};

/// Shows a place as that of what has the focus, if it has it.
pub(super) fn outline(ui: &Ui, response: &Response, rect: Rect, radius: u8, palette: &Palette) {
    if response.has_focus() {
        ui.painter().rect_stroke(rect, radius, Stroke::new(1.5, palette.text), StrokeKind::Inside);
    }
}

/// Paints what `Painter::circle` does, with the edge around the radius, from two filled discs. `fill` must be opaque. Up to a radius of
/// 6.7 physical pixels, egui has discs as pictures: both together take 4 triangles, where a circle with an edge takes 150.
pub(super) fn disc(painter: &Painter, centre: Pos2, radius: f32, fill: Color32, edge: Stroke) {
    painter.circle_filled(centre, radius + edge.width, edge.color);
    painter.circle_filled(centre, radius, fill);
}
