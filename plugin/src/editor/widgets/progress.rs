//! The panel that shows how far work in the background is: what it is, a bar, and a button to cancel.

use super::buttons::{Look, button};
use super::text::line;
use crate::editor::theme::{PADDING, Palette, RADIUS, SMALL, TEXT};
use egui::{Align2, Id, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};
use std::time::Duration;

/// Time between two repaints while the bar grows.
pub(crate) const PAUSE: Duration = Duration::from_millis(50);
/// Greatest width of the panel, and its height.
const SIZE: [f32; 2] = [380.0, 68.0];
/// Size of the button.
const BUTTON: [f32; 2] = [68.0, 22.0];

/// The contents of the panel.
pub(crate) struct Face<'a> {
    /// What is being done, and to what.
    pub(crate) verb: &'a str,
    pub(crate) name: &'a str,
    pub(crate) share: f64,
    /// The name of the button for accessibility.
    pub(crate) cancel: &'a str,
    /// Whether it was cancelled.
    pub(crate) is_ending: bool,
}

/// Paints the panel. Returns the response of its button.
pub(crate) fn paint(ui: &Ui, within: Rect, face: &Face, palette: &Palette) -> Response {
    let size = vec2(SIZE[0].min(within.width() - 2.0 * PADDING), SIZE[1]);
    let panel = Rect::from_center_size(within.center(), size);
    // Clicks on the panel do not reach the widgets under it.
    ui.interact(panel, Id::unique(("work", face.verb)), Sense::click_and_drag());
    ui.painter().rect(panel, RADIUS, palette.ground, Stroke::new(1.0, palette.line), StrokeKind::Inside);
    let inner = panel.shrink(PADDING + 2.0);
    let percent = Rect::from_min_max(pos2(inner.right() - 44.0, inner.top()), pos2(inner.right(), inner.top() + 18.0));
    let written = format!("{:.0} %", 100.0 * face.share);
    line(ui.painter(), percent, Align2::RIGHT_CENTER, &written, SMALL, palette.muted);
    let title = Rect::from_min_max(inner.min, pos2(percent.left() - 4.0, percent.bottom()));
    let name = format!("{} {}", if face.is_ending { "Cancelling" } else { face.verb }, face.name);
    line(ui.painter(), title, Align2::LEFT_CENTER, &name, TEXT, palette.text);
    let cancel = Rect::from_min_max(inner.max - vec2(BUTTON[0], BUTTON[1]), inner.max);
    let groove = Rect::from_min_max(
        pos2(inner.left(), cancel.center().y - 3.0),
        pos2(cancel.left() - PADDING, cancel.center().y + 3.0),
    );
    ui.painter().rect_filled(groove, 3.0, palette.line);
    let filled = groove.with_max_x(groove.left() + groove.width() * face.share as f32);
    ui.painter().rect_filled(filled, 3.0, palette.accent);
    let bar = ui.interact(groove, Id::unique(("work progress", face.verb)), Sense::hover());
    bar.widget_info(|| WidgetInfo {
        value: Some(100.0 * face.share),
        ..WidgetInfo::labeled(Role::ProgressIndicator, true, &name)
    });
    let look = if face.is_ending { Look::Disabled } else { Look::Plain };
    button(ui, cancel, "Cancel", face.cancel, look, palette)
}
