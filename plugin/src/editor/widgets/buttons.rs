//! Buttons and tabs in the window's own style.

use super::text::line;
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::{Palette, SMALL, TEXT};
use egui::{Align2, Color32, Id, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo};

/// How a button looks.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Look {
    Plain,
    /// Its setting is off, or on.
    Off,
    On,
    /// The action that one most likely wants.
    Main,
    /// It cannot be used now.
    Disabled,
}

/// A button with a text, called `name` for accessibility.
pub(crate) fn button(ui: &Ui, rect: Rect, text: &str, name: &str, look: Look, palette: &Palette) -> Response {
    let sense = if look == Look::Disabled { Sense::hover() } else { Sense::click() };
    let response = ui.interact(rect, Id::unique(("button", name)), sense);
    response.widget_info(|| match look {
        Look::Off | Look::On => WidgetInfo::selected(Role::Button, true, look == Look::On, name),
        _ => WidgetInfo::labeled(Role::Button, look != Look::Disabled, name),
    });
    // What can be used now has a face, on the ground and on a panel.
    let (fill, edge, colour) = match look {
        Look::On | Look::Main => (palette.accent, palette.outline, palette.on_accent),
        Look::Disabled => (Color32::TRANSPARENT, Color32::TRANSPARENT, palette.muted),
        Look::Plain | Look::Off if response.hovered() => (palette.raised, palette.muted, palette.text),
        Look::Plain | Look::Off => (palette.raised, palette.outline, palette.text),
    };
    ui.painter().rect(rect, 4.0, fill, Stroke::new(1.0, edge), StrokeKind::Inside);
    if response.has_focus() {
        ui.painter().rect_stroke(rect, 4.0, Stroke::new(1.5, palette.accent), StrokeKind::Inside);
    }
    line(ui.painter(), rect.shrink2(egui::vec2(3.0, 0.0)), Align2::CENTER_CENTER, text, TEXT, colour);
    response
}

/// The tab that opens the manual at a topic. Returns whether it was clicked.
pub(crate) fn help_tab(ui: &Ui, rect: Rect, topic: &str, controls: &mut Controls) -> bool {
    let response = tab(ui, rect, "?", false, controls.palette);
    response.widget_info(|| WidgetInfo::selected(Role::Tab, true, false, format!("Manual: {topic}")));
    if response.hovered() {
        *controls.hint = Hint::new("Manual", format!("What this page does: {topic}"));
    }
    response.clicked()
}

/// A tab: a word, underlined if its page is shown.
pub(crate) fn tab(ui: &Ui, rect: Rect, text: &str, is_on: bool, palette: &Palette) -> Response {
    let response = ui.interact(rect, Id::unique(("tab", text)), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Tab, true, is_on, text));
    let colour = if is_on || response.hovered() { palette.text } else { palette.muted };
    line(ui.painter(), rect, Align2::CENTER_CENTER, text, SMALL + 1.0, colour);
    if is_on {
        let under = Rect::from_min_max(rect.left_bottom() - egui::vec2(0.0, 2.0), rect.right_bottom());
        ui.painter().rect_filled(under, 1.0, palette.accent);
    }
    if response.has_focus() {
        ui.painter().rect_stroke(rect, 3.0, Stroke::new(1.0, palette.accent), StrokeKind::Inside);
    }
    response
}
