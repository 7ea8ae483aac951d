//! Paints a body.

use crate::editor::theme::Palette;
use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Painter, Rect, Shape, Stroke};
use sprung_picture::{Figure, Ink, Picture, Pose};

/// Space between a body and the frame that says that it is only a guess.
const AROUND: f32 = 14.0;

/// Paints a dashed frame around a body that is drawn for a table of modes, which knows of none.
pub(crate) fn paint_guess(painter: &Painter, rect: Rect, figure: &Figure, palette: &Palette) {
    let frame = figure.frame(rect).expand(AROUND).intersect(rect);
    let corners = [frame.left_top(), frame.right_top(), frame.right_bottom(), frame.left_bottom(), frame.left_top()];
    painter.extend(Shape::dashed_line(&corners, Stroke::new(1.0, palette.muted), 6.0, 5.0));
}

/// Paints the body.
pub(crate) fn paint(painter: &Painter, rect: Rect, figure: &Figure, pose: &Pose, palette: &Palette) {
    paint_picture(painter, Picture::of(rect, figure, pose, palette.accent), palette);
}

/// Paints a body at rest.
pub(crate) fn paint_still(painter: &Painter, rect: Rect, figure: &Figure, palette: &Palette) {
    paint(painter, rect, figure, &Pose::default(), palette);
}

/// Paints a body that stands on the lower edge of the rectangle.
pub(crate) fn paint_standing(painter: &Painter, rect: Rect, figure: &Figure, palette: &Palette) {
    let picture = Picture::of(rect, figure, &Pose::default(), palette.accent);
    paint_picture(painter, picture.standing(rect.bottom()), palette);
}

fn paint_picture(painter: &Painter, picture: Picture, palette: &Palette) {
    if let [first, .., last] = picture.string[..] {
        painter.line_segment([first, last], Stroke::new(1.0, palette.line));
        for end in [first, last] {
            painter.circle_filled(end, 3.0, palette.muted);
        }
        painter.add(Shape::line(picture.string, Stroke::new(2.5, palette.accent)));
    }
    for (ends, colour) in picture.outline {
        painter.line_segment(ends, Stroke::new(1.0, colour));
    }
    let vertices = picture.vertices.into_iter().map(|(pos, color)| Vertex { pos, uv: WHITE_UV, color }).collect();
    painter.add(Mesh { vertices, indices: picture.triangles.concat(), ..Mesh::default() });
    for (ink, points) in picture.lines {
        let stroke = match ink {
            Ink::Edge => Stroke::new(1.2, palette.text.gamma_multiply(0.5)),
            Ink::Fine => Stroke::new(1.0, palette.text.gamma_multiply(0.25)),
            Ink::Node => Stroke::new(1.0, palette.text.gamma_multiply(0.6)),
            Ink::Joint => Stroke::new(1.3, palette.muted),
        };
        painter.add(Shape::line(points, stroke));
    }
    if let Some(at) = picture.strike {
        painter.circle(at, 5.5, palette.panel, Stroke::new(2.0, palette.text));
        painter.circle_filled(at, 1.8, palette.text);
    }
}
