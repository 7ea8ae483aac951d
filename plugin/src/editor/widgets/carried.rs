//! What is being dragged from one place of the window to another, beside the pointer.

use super::text::line;
use crate::editor::theme::{Palette, RADIUS, TEXT};
use egui::{Align2, Color32, CursorIcon, Id, LayerId, Order, Rect, Stroke, StrokeKind, Ui, vec2};

/// Size of the label.
const SIZE: [f32; 2] = [120.0, 22.0];

/// Paints the name of what is being dragged.
pub(crate) fn paint(ui: &Ui, name: &str, edge: Color32, palette: &Palette) {
    let Some(at) = ui.input(|input| input.pointer.latest_pos()) else { return };
    let painter = ui.ctx().layer_painter(LayerId::new(Order::Tooltip, Id::unique("carried")));
    let rect = Rect::from_min_size(at + vec2(10.0, -10.0), SIZE.into());
    painter.rect(rect, RADIUS, palette.raised, Stroke::new(1.0, edge), StrokeKind::Inside);
    line(&painter, rect.shrink2(vec2(6.0, 0.0)), Align2::LEFT_CENTER, name, TEXT, palette.text);
    ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
}
