//! Little pictures of what moves a body.

use crate::editor::theme::Palette;
use egui::{Color32, Painter, Rect, Shape, Stroke, pos2};
use sprung::params::Param;

/// Paints the exciter whose level this parameter is.
pub(crate) fn paint(painter: &Painter, rect: Rect, param: Param, colour: Color32, palette: &Palette) {
    let stroke = Stroke::new(1.6, colour);
    let at = |x: f32, y: f32| pos2(rect.left() + x * rect.width(), rect.top() + y * rect.height());
    match param {
        Param::MalletLevel => {
            painter.line_segment([at(0.0, 1.0), at(0.7, 0.3)], stroke);
            painter.circle_filled(at(0.74, 0.26), 0.2 * rect.height(), colour);
        }
        Param::PluckLevel => {
            painter.add(Shape::line(vec![at(0.15, 0.1), at(0.85, 0.1), at(0.5, 0.75), at(0.15, 0.1)], stroke));
            painter.line_segment([at(0.0, 0.95), at(1.0, 0.95)], Stroke::new(1.0, palette.muted));
        }
        Param::NoiseLevel => {
            for [x, y] in [[0.1, 0.5], [0.25, 0.2], [0.35, 0.75], [0.5, 0.45], [0.62, 0.15], [0.7, 0.8], [0.9, 0.4]] {
                painter.circle_filled(at(x, y), 1.6, colour);
            }
        }
        Param::BowLevel => {
            painter.add(Shape::line(vec![at(0.0, 0.9), at(0.2, 0.45), at(0.6, 0.2), at(1.0, 0.1)], stroke));
            painter.line_segment([at(0.0, 0.9), at(1.0, 0.1)], Stroke::new(1.0, colour));
        }
        Param::BreathLevel => {
            painter.add(Shape::line(vec![at(1.0, 0.2), at(0.35, 0.2), at(0.0, 0.75), at(1.0, 0.75)], stroke));
            painter.line_segment([at(0.05, 0.9), at(0.5, 0.9)], Stroke::new(1.0, palette.muted));
        }
        _ => {
            let points =
                [[0.0, 0.5], [0.2, 0.5], [0.3, 0.1], [0.45, 0.9], [0.6, 0.2], [0.7, 0.6], [0.8, 0.5], [1.0, 0.5]];
            painter.add(Shape::line(points.map(|[x, y]| at(x, y)).to_vec(), stroke));
        }
    }
}
