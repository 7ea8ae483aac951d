//! A parameter that is one of several names: a field that opens a list.

use super::controls::{Controls, Hint};
use super::knob::{self, keys, wheel};
use super::text::line;
use super::theme::{KNOB, SMALL};
use egui::{Align2, Popup, Rect, Sense, Shape, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};
use sprung::params::ParamInfo;

/// Shows a choice in a cell of the size of a knob's, called `name`.
pub(super) fn show(ui: &mut Ui, cell: Rect, info: &'static ParamInfo, name: &str, controls: &mut Controls) {
    let centre = pos2(cell.center().x, cell.top() + KNOB / 2.0 + 1.0);
    let field = Rect::from_center_size(centre, vec2(cell.width() - 4.0, 22.0));
    let response = ui.interact(field, knob::id(info), Sense::click());
    wheel(ui, &response, info, controls);
    keys(ui, &response, info, controls);
    let value = controls.text(info);
    response.widget_info(|| {
        let mut about = WidgetInfo::labeled(egui::Role::ComboBox, true, info.name);
        about.current_text_value = Some(value.clone());
        about
    });
    // The menu of a right click has the usual id.
    Popup::menu(&response).id(response.id.with("list")).show(|ui| {
        ui.set_min_width(110.0);
        ui.label(info.name);
        let now = controls.value(info) as usize;
        for (place, choice) in info.choices.iter().enumerate() {
            if ui.selectable_label(place == now, *choice).clicked() {
                controls.set(info, place as f32);
                ui.close();
            }
        }
    });
    response.context_menu(|ui| knob::menu(ui, info, controls));
    if response.hovered() {
        *controls.hint = Hint::new(format!("{} {value}", info.name), info.help);
    }
    let palette = controls.palette;
    let outline = if response.hovered() || response.has_focus() { palette.muted } else { palette.line };
    ui.painter().rect(field, 4.0, palette.raised, Stroke::new(1.0, outline), StrokeKind::Inside);
    let mark = pos2(field.right() - 7.0, field.center().y);
    let points = vec![mark + vec2(-3.0, -1.5), mark + vec2(3.0, -1.5), mark + vec2(0.0, 2.5)];
    ui.painter().add(Shape::convex_polygon(points, palette.muted, Stroke::NONE));
    let inside = Rect::from_min_max(field.min + vec2(5.0, 0.0), field.max - vec2(12.0, 0.0));
    let is_default = controls.value(info) == info.default;
    let colour = if is_default { palette.text } else { palette.accent_text };
    line(ui.painter(), inside, Align2::LEFT_CENTER, &value, SMALL, colour);
    line(ui.painter(), knob::name_rect(cell), Align2::CENTER_CENTER, name, SMALL, palette.text);
}
