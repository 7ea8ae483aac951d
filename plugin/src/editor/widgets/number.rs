//! A number under its name, which can be dragged or typed.

use super::text::line;
use crate::editor::controls::{Controls, Hint};
use crate::editor::theme::SMALL;
use egui::{Align2, DragValue, Rect, Response, Role, Ui, WidgetInfo, vec2};

/// Height of a number with its name.
pub(crate) const HEIGHT: f32 = 36.0;

/// A number that can be changed.
pub(crate) struct Number<'a> {
    pub(crate) title: &'a str,
    pub(crate) help: &'a str,
    pub(crate) value: f64,
    pub(crate) range: [f64; 2],
    /// The change for each pixel that the mouse is dragged.
    pub(crate) speed: f64,
    pub(crate) is_whole: bool,
    /// A value as text, and the value of a text.
    pub(crate) written: &'a dyn Fn(f64) -> String,
    pub(crate) read: &'a dyn Fn(&str) -> Option<f64>,
}

impl Number<'_> {
    /// Shows the number. Returns its new value.
    pub(crate) fn show(&self, ui: &mut Ui, cell: Rect, controls: &mut Controls) -> (Response, f64) {
        let name = Rect::from_min_size(cell.min, vec2(cell.width() - 4.0, 13.0));
        let field = Rect::from_min_size(cell.min + vec2(0.0, 14.0), vec2(cell.width() - 6.0, 18.0));
        line(ui.painter(), name, Align2::LEFT_CENTER, self.title, SMALL, controls.palette.muted);
        let (written, read, [min, max]) = (self.written, self.read, self.range);
        let mut value = self.value;
        // Without the mouse, a key or a screen reader asks for the next number.
        let is_step = self.is_whole && !ui.input(|input| input.pointer.any_down());
        let widget = DragValue::new(&mut value)
            .range(min..=max)
            .clamp_existing_to_range(false)
            .speed(if is_step { 1.0 } else { self.speed })
            .update_while_editing(false)
            .custom_formatter(move |value, _| written(value))
            .custom_parser(read);
        let response = ui.put(field, widget);
        if self.is_whole {
            value = value.round();
        }
        response.widget_info(|| {
            let mut about = WidgetInfo::labeled(Role::SpinButton, true, self.title);
            about.current_text_value = Some(written(value));
            about
        });
        if response.hovered() || response.has_focus() {
            *controls.hint = Hint::new(format!("{} {}", self.title, written(value)), self.help);
        }
        (response, value)
    }
}
