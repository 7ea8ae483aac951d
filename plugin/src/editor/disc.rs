//! Small discs with an edge.

use egui::{Color32, Painter, Pos2, Stroke};

/// Paints what `Painter::circle` does, from two filled discs. Up to a radius of 8 pixels, egui has these as pictures: they take
/// 4 triangles, where circles take 150. Without a graphics card, triangles are most of the cost of a window full of modes.
pub(super) fn disc(painter: &Painter, centre: Pos2, radius: f32, fill: Color32, edge: Stroke) {
    painter.circle_filled(centre, radius + edge.width / 2.0, edge.color);
    painter.circle_filled(centre, (radius - edge.width / 2.0).max(0.0), fill);
}
