//! A number under its name, which can be dragged or typed, or with a knob above it.

use super::knob::face::{self, Face};
use super::knob::{FINE, TRAVEL, take_wheel};
use super::text::line;
use crate::editor::controls::{Controls, Hint};
use crate::editor::routes::Ring;
use crate::editor::theme::{KNOB, SMALL};
use egui::{
    Align2, Color32, CursorIcon, DragValue, EventFilter, Id, Key, Rect, Response, Role, Sense, Stroke, Ui, UiBuilder,
    WidgetInfo, pos2, vec2,
};

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
        self.field(ui, field, controls)
    }

    fn field(&self, ui: &mut Ui, field: Rect, controls: &mut Controls) -> (Response, f64) {
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

    /// Shows the number as a knob that is turned in these steps, the arc from this value on, above its name and a field. Returns
    /// whether it is held, and its new value.
    pub(crate) fn show_knob(
        &self,
        ui: &mut Ui,
        cell: Rect,
        [step, origin]: [f64; 2],
        controls: &mut Controls,
    ) -> (bool, f64) {
        let (palette, [min, max]) = (controls.palette, self.range);
        let turned = cell.with_max_y(cell.top() + KNOB + 13.0);
        let response = ui.interact(turned, Id::unique(("number", self.title)), Sense::click_and_drag());
        response.widget_info(|| {
            let mut about = WidgetInfo::slider(true, self.value, self.title);
            about.current_text_value = Some((self.written)(self.value));
            about
        });
        let fine = if ui.input(|input| input.modifiers.shift) { FINE } else { 1.0 };
        let (mut value, step) = (self.value, step * fine);
        if response.drag_started() {
            ui.data_mut(|data| data.insert_temp(response.id, value));
        }
        if response.dragged() {
            let moved = response.drag_delta();
            let exact = ui.data(|data| data.get_temp(response.id)).unwrap_or(value);
            let exact = exact + f64::from((moved.x - moved.y) / TRAVEL) * (max - min) * fine;
            ui.data_mut(|data| data.insert_temp(response.id, exact.clamp(min, max)));
            if moved != egui::Vec2::ZERO {
                value = ((exact / step).round() * step).clamp(min, max);
            }
            ui.ctx().set_cursor_icon(CursorIcon::ResizeVertical);
        }
        let mut steps = if response.hovered() { take_wheel(ui).0 } else { 0.0 };
        if response.has_focus() {
            let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
            let pressed = |key| ui.input(|input| input.num_presses(key)) as f64;
            steps += pressed(Key::ArrowUp) - pressed(Key::ArrowDown);
            steps += 10.0 * (pressed(Key::PageUp) - pressed(Key::PageDown));
            if pressed(Key::Delete) + pressed(Key::Backspace) > 0.0 {
                value = origin;
            }
        }
        if steps != 0.0 {
            value = (((value / step).round() + steps) * step).clamp(min, max);
        }
        if response.double_clicked() {
            value = origin;
        }
        let share = |value: f64| ((value - min) / (max - min)) as f32;
        let circle = Rect::from_center_size(pos2(cell.center().x, cell.top() + KNOB / 2.0 + 1.0), vec2(KNOB, KNOB));
        let face = Face {
            position: share(value),
            origin: share(origin),
            offset: 0.0,
            ring: &Ring::default(),
            is_hovered: response.hovered() || response.dragged(),
            is_focused: response.has_focus(),
        };
        face::paint(ui.painter(), circle, palette, &face);
        let name = turned.with_min_y(turned.bottom() - 13.0);
        line(ui.painter(), name, Align2::CENTER_CENTER, self.title, SMALL, palette.text);
        // Below a knob, a value has no face of its own.
        let below = Rect::from_min_max(turned.left_bottom(), pos2(cell.right(), turned.bottom() + 18.0));
        let mut fields = ui.new_child(UiBuilder::new().id_salt(self.title).max_rect(below));
        let plain = &mut fields.visuals_mut().widgets.inactive;
        (plain.weak_bg_fill, plain.bg_stroke) = (Color32::TRANSPARENT, Stroke::NONE);
        let now = Number { value, ..*self };
        let (field, typed) = now.field(&mut fields, below.shrink2(vec2(6.0, 0.0)), controls);
        if response.has_focus() && ui.input(|input| input.key_pressed(Key::Enter)) {
            field.request_focus();
        }
        if response.hovered() || response.has_focus() {
            *controls.hint = Hint::new(format!("{} {}", self.title, (self.written)(typed)), self.help);
        }
        let value = if field.changed() { typed } else { value };
        // Arrow keys nudge, as the wheel does.
        let is_held = response.dragged() || field.dragged() || field.has_focus();
        (is_held, value)
    }
}
