//! Little pictures of what moves a body.

use crate::editor::theme::Palette;
use egui::{Color32, Painter, Rect, Shape, Stroke, pos2};
use sprung::params::Param;
use sprung_picture::Glyph;

/// Paints the exciter whose level this parameter is.
pub(crate) fn paint(painter: &Painter, rect: Rect, param: Param, colour: Color32, palette: &Palette) {
    let at = |[x, y]: [f32; 2]| pos2(rect.left() + x * rect.width(), rect.top() + y * rect.height());
    let glyph = Glyph::of(param);
    for (lines, width, colour) in
        [(glyph.lines, 1.6, colour), (glyph.thin, 1.0, colour), (glyph.touched, 1.0, palette.muted)]
    {
        lines.iter().for_each(|line| {
            painter.add(Shape::line(line.iter().copied().map(at).collect(), Stroke::new(width, colour)));
        });
    }
    let (dots, radius) = glyph.dots;
    dots.iter().for_each(|dot| {
        painter.circle_filled(at(*dot), radius * rect.height(), colour);
    });
}
